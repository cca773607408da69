"""Arguments of public functions: an `AtomsimError` names the argument, what it needs and what it got."""

from __future__ import annotations

import pickle
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.running import SCENES

import atomsim
from atomsim import arguments

WHOLE = "a whole number of 1 or more"
SCENE = "a loaded scene, as atomsim.load returns it"
FILE = "the name of a file"


@pytest.mark.parametrize("value", [3, 3.0, np.int64(3), np.float64(3), np.uint8(3)])
def test_whole_numbers(value: Any) -> None:
    number = arguments.whole("rounds", value)
    assert (number, type(number)) == (3, int)


@pytest.mark.parametrize("value", [0, -1, 1.5, "3", None, True, np.True_, float("nan"), float("inf"), [3], np.zeros(2)])
def test_what_is_no_whole_number(value: Any) -> None:
    with pytest.raises(atomsim.InputError) as caught:
        arguments.whole("rounds", value)
    assert str(caught.value) == f"rounds: needs {WHOLE} (got {' '.join(repr(value).split())})"


def test_a_value_that_cannot_be_shown() -> None:
    class Shy:
        def __repr__(self) -> str:
            raise RuntimeError

    with pytest.raises(atomsim.InputError, match=r"\(got a Shy\)$"):
        arguments.whole("rounds", Shy())
    with pytest.raises(atomsim.InputError, match=r"\(got 'x{79}…\)$"):
        arguments.whole("rounds", "x" * 1000)


class BytesPath:
    """A path that is not text."""

    def __fspath__(self) -> bytes:
        return b"scenes/rods.yaml"

    def __repr__(self) -> str:
        return "a path of bytes"


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("out") / "out.h5"
    atomsim.run(atomsim.load(SCENES / "threads.yaml"), path, rounds=20)
    return path


CALLS: dict[str, tuple[Any, str]] = {
    "Trajectory(5)": (lambda at, scene: atomsim.Trajectory(5), f"path: needs {FILE} (got 5)"),
    "Trajectory(None)": (lambda at, scene: atomsim.Trajectory(None), f"path: needs {FILE} (got None)"),
    "Trajectory('')": (lambda at, scene: atomsim.Trajectory(""), f"path: needs {FILE} (got '')"),
    "Trajectory(bytes)": (lambda at, scene: atomsim.Trajectory(b"out.h5"), f"path: needs {FILE} (got b'out.h5')"),
    "Trajectory(NUL)": (lambda at, scene: atomsim.Trajectory("a\0b"), rf"path: needs {FILE} (got 'a\x00b')"),
    "compile": (lambda at, scene: atomsim.compile("rods.yaml"), f"loaded: needs {SCENE} (got 'rods.yaml')"),
    "simulate, model": (
        lambda at, scene: atomsim.simulate(scene, None, 5),
        "model: needs a model, as atomsim.compile returns it (got LoadedScene(",
    ),
    "simulate, state": (
        lambda at, scene: atomsim.simulate(atomsim.compile(scene)[0], 0, 5),
        "state: needs a state, as atomsim.compile returns it or a frame has it (got 0)",
    ),
    "simulate, record_every": (
        lambda at, scene: atomsim.simulate(*atomsim.compile(scene), 5, record_every=0),
        f"record_every: needs {WHOLE} (got 0)",
    ),
    "simulate, rounds": (
        lambda at, scene: atomsim.simulate(*atomsim.compile(scene), -1),
        "rounds: needs a whole number of 0 or more (got -1)",
    ),
    "simulate, backend": (
        lambda at, scene: atomsim.simulate(*atomsim.compile(scene), 5, backend=3),
        "backend: needs auto, numpy or numba (got 3)",
    ),
    "step": (
        lambda at, scene: atomsim.Simulation(scene).step("2"),
        "n_rounds: needs a whole number of 0 or more (got '2')",
    ),
    "run, scene": (lambda at, scene: atomsim.run("rods.yaml", at), f"scene: needs {SCENE} (got 'rods.yaml')"),
    "load": (lambda at, scene: atomsim.load(None), f"path: needs {FILE} (got None)"),
    "load, a setting for several": (
        lambda at, scene: atomsim.load(SCENES / "rods.yaml", "rounds=5"),
        "overrides: needs texts such as [\"rounds=5\"] (got 'rounds=5')",
    ),
    "load, settings as a mapping": (
        lambda at, scene: atomsim.load(SCENES / "rods.yaml", {"rounds": 5}),
        "overrides: needs texts such as [\"rounds=5\"] (got {'rounds': 5})",
    ),
    "load, one setting that is none": (
        lambda at, scene: atomsim.load(SCENES / "rods.yaml", ["rounds=5", None]),
        "overrides: needs texts such as [\"rounds=5\"] (got ['rounds=5', None])",
    ),
    "load, no name": (lambda at, scene: atomsim.load(""), f"path: needs {FILE} (got '')"),
    "load, a path of bytes": (lambda at, scene: atomsim.load(BytesPath()), f"path: needs {FILE} (got a path of bytes)"),
    "load, an open file": (lambda at, scene: atomsim.load(StringIO("")), f"path: needs {FILE} (got <_io.StringIO"),
    "loads, the name of a file": (
        lambda at, scene: atomsim.loads("scenes/rods.yaml"),
        "text: needs a scene as text, while atomsim.load takes the name of a file (got 'scenes/rods.yaml')",
    ),
    "loads, bytes": (lambda at, scene: atomsim.loads(b"atomsim: 1"), "text: needs a scene as text (got b'atomsim: 1')"),
    "loads, a setting for a name": (
        lambda at, scene: atomsim.loads("atomsim: 1", ["rounds=5"]),
        "name: needs a text (got ['rounds=5'])",
    ),
    "LoadedScene": (lambda at, scene: atomsim.LoadedScene({}), "scene: needs a Scene, as atomsim.load puts it here"),
    "LoadedScene, source": (
        lambda at, scene: atomsim.LoadedScene(scene.scene, "rods.yaml"),
        "source: needs a Source, as atomsim.load puts it here (got 'rods.yaml')",
    ),
    "compile, a scene alone": (lambda at, scene: atomsim.compile(scene.scene), f"loaded: needs {SCENE} (got Scene("),
    "loads": (lambda at, scene: atomsim.loads(5), "text: needs a scene as text (got 5)"),
    "loads, name": (lambda at, scene: atomsim.loads("", 5), "name: needs a text (got 5)"),
    "simulate, report": (
        lambda at, scene: atomsim.simulate(*atomsim.compile(scene), 5, report=5),
        "report: needs a function (got 5)",
    ),
    "simulate, first": (
        lambda at, scene: atomsim.simulate(*atomsim.compile(scene), 5, first=5),
        "first: needs a state, as atomsim.compile returns it or a frame has it (got 5)",
    ),
    "run, report": (lambda at, scene: atomsim.run(scene, at, report=5), "report: needs a function (got 5)"),
    "run, warn": (lambda at, scene: atomsim.run(scene, at, warn="yes"), "warn: needs a function (got 'yes')"),
    "run, replace": (lambda at, scene: atomsim.run(scene, at, replace="no"), "replace: needs True or False (got 'no')"),
    "run, compress": (lambda at, scene: atomsim.run(scene, at, compress=1), "compress: needs True or False (got 1)"),
    "resume, replace": (
        lambda at, scene: atomsim.resume(at, rounds=30, replace="no"),
        "replace: needs True or False (got 'no')",
    ),
    "run, path": (lambda at, scene: atomsim.run(scene, 5), f"path: needs {FILE} (got 5)"),
    "run, rounds": (lambda at, scene: atomsim.run(scene, at, rounds=-1), f"rounds: needs {WHOLE} (got -1)"),
    "run, text": (lambda at, scene: atomsim.run(scene, at, rounds="5"), f"rounds: needs {WHOLE} (got '5')"),
    "run, backend": (
        lambda at, scene: atomsim.run(scene, at, backend=None),
        "backend: needs auto, numpy or numba (got None)",
    ),
    "run, threads": (
        lambda at, scene: atomsim.run(scene, at, threads=1.5),
        "threads: needs a whole number from 1 to 256 (got 1.5)",
    ),
    "resume, path": (lambda at, scene: atomsim.resume(None), f"path: needs {FILE} (got None)"),
    "resume, rounds": (lambda at, scene: atomsim.resume(at, rounds=0), f"rounds: needs {WHOLE} (got 0)"),
    "resume, scene": (
        lambda at, scene: atomsim.resume(at, scene="rods.yaml"),
        f"scene: needs {SCENE} (got 'rods.yaml')",
    ),
    "resume, backend": (
        lambda at, scene: atomsim.resume(at, rounds=30, backend=[]),
        "backend: needs auto, numpy or numba (got [])",
    ),
}


@pytest.mark.parametrize("call", CALLS)
def test_the_argument_is_named(out: Path, call: str) -> None:
    act, message = CALLS[call]
    before = out.read_bytes()
    new = out.with_name("new.h5")
    with pytest.raises(atomsim.InputError) as caught:
        act(new if call.startswith("run") else out, atomsim.load(SCENES / "threads.yaml"))
    assert str(caught.value).startswith(message)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    assert list(out.parent.iterdir()) == [out]
    assert out.read_bytes() == before
