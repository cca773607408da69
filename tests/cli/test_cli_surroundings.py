"""Whatever is in the environment, nobody reads the words of libraries: results, or one line of ours."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.process import COMMAND, KEPT, finish, python
from typer.main import get_command

from atomsim.cli.app import app

RODS = Path(__file__).parents[2] / "scenes" / "rods.yaml"

RUN = ("run", RODS, "--rounds", "20", "--force")
RENDER = ("render", "out.h5", "--rounds", "0", "--size", "64x48")
NUMBA = (*RUN, "--backend", "numba")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with one trajectory in it."""
    folder = tmp_path_factory.mktemp("surroundings")
    assert finish(*RUN, cwd=folder).returncode == 0
    return folder


def test_settings_of_libraries_that_make_no_sense(folder):
    nonsense = {"OMP_NUM_THREADS": "abc", "OPENBLAS_NUM_THREADS": "x", "HDF5_USE_FILE_LOCKING": "maybe"}
    for command in (RUN, ("show", "out.h5"), RENDER):
        done = finish(*command, cwd=folder, **nonsense)
        assert (done.returncode, done.stderr) == (0, "")
    done = finish(program=python("import atomsim.core.numba_backend.jit"), NUMBA_NUM_THREADS="abc", NUMBA_OPT="high")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("variables", "reason"),
    [
        (
            {"NUMBA_DISABLE_JIT": "1"},
            "its compiler is switched off by NUMBA_DISABLE_JIT (NUMBA_DISABLE_JIT in the environment); ",
        ),
        (
            {"NUMBA_NUM_THREADS": "0"},
            "Number of threads specified must be > 0. (NUMBA_NUM_THREADS in the environment); ",
        ),
    ],
    ids=lambda variables: " ".join(variables) if isinstance(variables, dict) else "",
)
def test_settings_that_leave_numba_unfit(folder, variables, reason):
    done = finish(*NUMBA, cwd=folder, **variables)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"Numba is installed but does not work here: {reason}")
    assert done.stderr.count("\n") == 1
    done = finish(*RUN, program=python(ALWAYS_WORTH_IT), cwd=folder, **variables)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"computed by numpy, 1 thread (Numba does not work here: {reason.split(' (')[0]})" in done.stdout


WARNING = """
import warnings
from atomsim.cli import main
from atomsim.core.numpy_backend.stepper import NumpyStepper
advance = NumpyStepper.advance
def noisy(stepper, n_rounds):
    advance(stepper, n_rounds)
    warnings.warn("a library is not happy", RuntimeWarning)
NumpyStepper.advance = noisy
main()
"""


def test_warnings_of_libraries_are_for_those_who_ask_for_them(folder):
    done = finish(*RUN, program=python(WARNING), cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    done = finish(*RUN, program=python(WARNING), cwd=folder, PYTHONWARNINGS="default::RuntimeWarning")
    assert "a library is not happy" in done.stderr


ALWAYS_WORTH_IT = """
from dataclasses import replace
from atomsim.core import backend
numpy, *others = backend.BACKENDS
backend.BACKENDS = (replace(numpy, cost=replace(numpy.cost, round=1e6)), *others)
from atomsim.cli import main
main()
"""


@pytest.mark.parametrize("home", [None, "/proc/nowhere"])
@pytest.mark.parametrize("command", [("check", RODS), RENDER, RUN], ids=lambda command: command[0])
def test_a_user_without_a_home(folder, command, home):
    """No folder of one's own can be written to, or there is none."""
    left_out = [part for name in KEPT if name != "PATH" for part in ("-u", name)]
    set_to = [] if home is None else [f"HOME={home}"]
    program = ["env", *left_out, *set_to, "MPLCONFIGDIR=/proc/nowhere", *COMMAND]
    done = finish(*command, program=program, cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")


def every_help():
    """Yield what asks for every page of help."""
    top = get_command(app)
    yield ("--help",)
    for name, command in top.commands.items():
        yield (name, "--help")
        for inner in getattr(command, "commands", {}):
            yield (name, inner, "--help")


HELPS = """
import sys
from atomsim.cli.app import run_typed
for line in sys.argv[1].split(";"):
    sys.argv = ["atomsim", *line.split()]
    run_typed()
"""


@pytest.mark.parametrize("level", ["1", "2"])
def test_optimised_python_explains_every_command(folder, level):
    """Docstrings are gone then."""
    lines = ";".join(" ".join(arguments) for arguments in every_help())
    plain, optimised = (finish(lines, program=python(HELPS), cwd=folder, PYTHONOPTIMIZE=n) for n in ("0", level))
    assert (optimised.returncode, optimised.stderr) == (0, "")
    assert optimised.stdout == plain.stdout
    assert "Simulate a scene and record its trajectory." in plain.stdout
    assert plain.stdout.count("Example") >= 10
