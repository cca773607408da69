"""Which libraries a command loads: start-up is guarded by what is imported, not by the clock."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from support.process import finish, python

ROOT = Path(__file__).parents[2]
RODS = str(ROOT / "scenes" / "rods.yaml")

LIBRARIES = {"h5py", "llvmlite", "matplotlib", "numba", "numpy", "PIL", "pydantic", "rich", "scipy", "yaml"}

PROBE = """
import json, sys
sys.argv = ["atomsim", *sys.argv[2:]]
from atomsim.cli import main
try:
    main()
except SystemExit:
    pass
open("modules.json", "w").write(json.dumps(sorted(set(module.split(".")[0] for module in sys.modules))))
"""


def loaded(folder: Path, *arguments: str) -> set[str]:
    """Run a command in a process of its own and return which of the libraries it loaded."""
    assert finish("-", *arguments, program=python(PROBE), cwd=folder).returncode == 0
    return LIBRARIES & set(json.loads((folder / "modules.json").read_text()))


@pytest.mark.parametrize(
    ("arguments", "libraries"),
    [
        (("--help",), set()),
        (("--version",), {"pydantic"}),  # typer's own
        (("run", "--help"), {"pydantic"}),
        (("check", RODS), {"numpy", "pydantic", "yaml"}),
        (("run", RODS, "--rounds", "50"), {"h5py", "numpy", "pydantic", "yaml"}),
        (("schema",), {"pydantic", "yaml"}),
    ],
    ids=lambda value: " ".join(Path(part).name for part in value) if isinstance(value, tuple) else "",
)
def test_a_command_loads_what_it_needs(tmp_path, arguments, libraries):
    assert loaded(tmp_path, *arguments) <= libraries


def test_plugins_of_others_do_not_read_scenes(tmp_path):
    """A package that is installed by chance could change what pydantic reads."""
    about = tmp_path / "site" / "meddler-1.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: meddler\nVersion: 1\n")
    (about / "entry_points.txt").write_text("[pydantic]\nmeddler = meddler:plugin\n")
    (about.parent / "meddler.py").write_text("raise SystemExit('a plugin was loaded')\n")
    done = finish("check", RODS, cwd=tmp_path, PYTHONPATH=str(about.parent))
    assert (done.returncode, done.stderr) == (0, "")
    wanted = {"PYDANTIC_DISABLE_PLUGINS": ""}  # whoever wants them, has them
    done = finish("check", RODS, cwd=tmp_path, PYTHONPATH=str(about.parent), **wanted)
    assert "a plugin was loaded" in done.stderr


def test_only_pictures_load_matplotlib(tmp_path):
    assert "matplotlib" not in loaded(tmp_path, "run", RODS, "--rounds", "50")
    assert "matplotlib" not in loaded(tmp_path, "show", "out.h5")
    assert "matplotlib" not in loaded(tmp_path, "measure", "out.h5", "energy")
    assert "matplotlib" in loaded(tmp_path, "render", "out.h5", "--size", "64x48")


def test_importing_the_package_loads_nothing():
    code = f"import sys, atomsim; print(sorted({LIBRARIES!r} & set(sys.modules)))"
    assert finish(program=python(code)).stdout == "[]\n"
