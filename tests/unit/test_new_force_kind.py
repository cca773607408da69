"""A new kind of force takes the five places that ARCHITECTURE names and no other, and mypy names those forgotten."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from support.process import finish, python

ROOT = Path(__file__).parents[2]

Place = dict[str, list[tuple[str, str]]]
"""What is written into which files: a text that stands there once, and what replaces it."""

IMPORT = (
    "from atomsim.core.model import (",
    "from atomsim.core.model import SlopeForce\nfrom atomsim.core.model import (",
)
LANGUAGE: Place = {
    "scene/language/forces.py": [
        ("\nForce = Annotated[\n    ", "\nForce = Annotated[\n    Slope | "),
        (
            "class Hold(ForceBase):",
            '''class Slope(ForceBase):
    """An impulse that grows along x."""

    kind: Literal["slope"]
    """Impulse [0, 0, rate · x] per round."""
    rate: Number
    """How much it grows."""


class Hold(ForceBase):''',
        ),
    ]
}
RECORD: Place = {
    "core/model.py": [
        ("ActingForce: TypeAlias = ", "ActingForce: TypeAlias = SlopeForce | "),
        (
            "@dataclass(frozen=True, slots=True, eq=False)\nclass HoldForce:",
            '''@dataclass(frozen=True, slots=True, eq=False)
class SlopeForce:
    """j ← j + (0, 0, rate · x)."""

    origin: Origin
    atoms: Indices
    rate: float


@dataclass(frozen=True, slots=True, eq=False)
class HoldForce:''',
        ),
    ]
}
COMPILER: Place = {
    "compiler/compile.py": [
        IMPORT,
        ("language.forces import ", "language.forces import Slope, "),
        (
            "                case Hold():",
            "                case Slope():\n                    return [SlopeForce(origin, atoms, force.rate)]\n"
            "                case Hold():",
        ),
    ]
}
LAW: Place = {
    "core/forces.py": [
        IMPORT,
        (
            "        case DampingForce():\n            return _damping(force)",
            "        case DampingForce():\n            return _damping(force)\n"
            "        case SlopeForce():\n            return _slope(force)",
        ),
        ("case TorqueForce() | TetherForce():", "case TorqueForce() | TetherForce() | SlopeForce():"),
        (
            "def _damping(",
            '''def _slope(force: SlopeForce) -> Law:
    """j ← j + (0, 0, rate · x)."""
    atoms = as_index(force.atoms)

    def apply(_: int, position: Floats, __: Floats, impulse: Floats) -> None:
        impulse[2, atoms] += force.rate * position[0, atoms]

    return apply


def _damping(''',
        ),
    ]
}
COMPILED: Place = {
    "core/plans/force_plan.py": [
        IMPORT,
        (
            "DAMPING, PUSH, TORQUE, TETHER, TOWARDS = range(5)",
            "DAMPING, PUSH, TORQUE, TETHER, TOWARDS, SLOPE = range(6)",
        ),
        (
            "        case TetherForce():\n",
            "        case SlopeForce():\n            return SLOPE, (force.rate,)\n        case TetherForce():\n",
        ),
    ],
    "core/numba_backend/force_kernels.py": [
        ("import DAMPING, PUSH, TETHER, TORQUE, TOWARDS", "import DAMPING, PUSH, SLOPE, TETHER, TORQUE, TOWARDS"),
        (
            "            elif kind == TETHER:",
            "            elif kind == SLOPE:\n                for slot in range(first, last):\n"
            "                    impulse[2, slot] += number[0] * position[0, slot]\n            elif kind == TETHER:",
        ),
    ],
}
PLACES = (LANGUAGE, RECORD, COMPILER, LAW, COMPILED)


def package_with(places: Iterable[Place], folder: Path) -> Path:
    """Copy the package and write into it what a new kind of force takes; return where it is."""
    shutil.copytree(ROOT / "atomsim", folder / "atomsim", ignore=shutil.ignore_patterns("__pycache__"))
    for place in places:
        for name, changes in place.items():
            file = folder / "atomsim" / name
            text = file.read_text(encoding="utf-8")
            for old, new in changes:
                assert text.count(old) == 1, f"{name}: {old!r}"
                text = text.replace(old, new)
            file.write_text(text, encoding="utf-8")
    return folder


SCENE = """
atomsim: 1
time_step: 0.05
rounds: 60
groups: {a: {shape: string, count: 5, step: [1.5, 0, 0.5], velocity: [1, 0, 0]}}
bonds: {b: {within: a, rule: neighbour}}
forces: {tilt: {kind: slope, acts_on: ["a[0]", "a[2:]"], rate: 0.125}, h: {kind: hold, acts_on: "a[4]"}}
"""

USE = """
import json, sys
import numpy as np
import atomsim
from atomsim.core.forces import strength
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.findings.before.diagnose import examine
from atomsim.scene.field_docs import field_docs
from atomsim.scene.schema import schema

if len(sys.argv) > 2:  # kernels that are run as the Python they are written in need no minute to compile
    import numba
    numba.njit = lambda **options: lambda function: function

loaded = atomsim.loads(sys.argv[1])
model, state = atomsim.compile(loaded)
one = NumpyStepper(model, state)
one.advance(1)
backends = ["numpy"] + ["numba"] * (len(sys.argv) > 2)
print(json.dumps({
    "impulse": (one.state().velocity - state.velocity)[:, 2].tolist(),
    "digests": sorted({[*atomsim.simulate(model, state, 60, 60, name)][-1].digest for name in backends}),
    "schema": schema()["$defs"]["Slope"]["properties"]["rate"]["description"],
    "reference": field_docs()["Slope"]["rate"].description,
    "findings": [str(found) for found in examine(loaded, model, state).findings],
}))
try:
    atomsim.loads(sys.argv[1].replace("rate", "raet"))
except atomsim.SceneError as error:
    print(error)
"""


def used(folder: Path) -> tuple[dict[str, Any], str]:
    """Use the toy in a package: from the scene to frames, in the schema, the reference, findings and messages."""
    import json
    from importlib.util import find_spec

    numba = ["and numba"] if find_spec("numba") else []
    done = finish(SCENE, *numba, program=python(USE), PYTHONPATH=str(folder), cwd=folder)
    assert done.returncode == 0, done.stderr
    first, *message = done.stdout.splitlines()
    return json.loads(first), "\n".join(message)


def test_five_places_are_enough(tmp_path: Path) -> None:
    found, message = used(package_with(PLACES, tmp_path))
    x = [1.5 * (atom - 2) for atom in range(5)]
    assert found["impulse"] == [0.125 * x[0], 0.0, 0.125 * x[2], 0.125 * x[3], 0.0]
    assert len(found["digests"]) == 1
    assert found["schema"] == found["reference"] == "How much it grows."
    assert not [text for text in found["findings"] if "slope" in text]
    assert message.splitlines()[0] == "<scene>:7:58: forces.tilt.raet: unknown key `raet`; did you mean `rate`?"


def test_these_are_the_places_that_the_page_names() -> None:
    page = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    listed = page[page.index("To add a kind of force, touch five places") :].split("\n\n")[1]
    lines = re.findall(r"^\d\. .*", listed, re.MULTILINE)
    named = [sorted(re.findall(r"`atomsim/([\w/]+\.py)`", line)) for line in lines]
    assert named == [sorted(place) for place in PLACES]


@pytest.mark.slow
def test_mypy_names_the_places_that_were_forgotten(tmp_path: Path) -> None:
    folder = package_with((LANGUAGE, RECORD), tmp_path)
    shutil.copy(ROOT / "pyproject.toml", folder)
    mypy = python("from mypy.main import main; main()")
    done = finish("--cache-dir", str(tmp_path / "cache"), program=mypy, cwd=folder)
    wrong = {line.partition(":")[0] for line in done.stdout.splitlines() if "assert_never" in line}
    assert wrong == {"atomsim/compiler/compile.py", "atomsim/core/forces.py", "atomsim/core/plans/force_plan.py"}
