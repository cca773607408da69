"""Closed, full and broken streams, poor encodings: the exit code is that of the work, and no traceback comes."""

from __future__ import annotations

import contextlib
import os
from dataclasses import replace
from pathlib import Path

import pytest
from support.process import finish, python

from atomsim.compiler import compile_scene
from atomsim.core.simulate import simulate
from atomsim.scene import load
from atomsim.trajectory import End, Header, Recorder

SCENE = Path(__file__).parents[2] / "scenes" / "rods.yaml"
RUN = ("run", SCENE, "--rounds", "20", "--backend", "numpy", "--force")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with two trajectories and a broken scene in it."""
    folder = tmp_path_factory.mktemp("output")
    assert finish(*RUN, cwd=folder).returncode == 0
    assert finish(*RUN, "-o", "other.h5", "--set", "groups.left.velocity.0=2", cwd=folder).returncode == 0
    (folder / "broken.yaml").write_text("atomsim: 1\n")
    return folder


def closing(*numbers: int):
    """Return what a shell does for `>&-`."""

    def close():
        for number in numbers:
            os.close(number)

    return close


@pytest.mark.parametrize("closed", [(1,), (2,), (0, 1, 2)])
def test_closed_streams(folder, closed):
    """Files that are opened next must not take their numbers: HDF5 and Numba write to 2 when they feel like it."""
    whole = (folder / "out.h5").read_bytes()
    assert finish(*RUN, cwd=folder, before=closing(*closed)).returncode == 0
    assert (folder / "out.h5").read_bytes() == whole
    for arguments, code in WAYS_OUT:
        done = finish(*arguments, cwd=folder, before=closing(*closed))
        assert done.returncode == code, arguments
        assert "Traceback" not in done.stderr


NOISE = """
import contextlib, os
from atomsim.cli import main
from atomsim.core.numpy_backend.stepper import NumpyStepper
advance = NumpyStepper.advance
def noisy(stepper, n_rounds):
    advance(stepper, n_rounds)
    for number in (1, 2):
        with contextlib.suppress(OSError):
            os.write(number, b"noise")
NumpyStepper.advance = noisy
main()
"""


def test_what_libraries_print_goes_into_no_file(folder):
    """They write to streams by number, whatever has been opened under it."""
    whole = (folder / "out.h5").read_bytes()
    done = finish(*RUN, "-o", "noise.h5", program=python(NOISE), cwd=folder, before=closing(1, 2))
    assert done.returncode == 0
    assert (folder / "noise.h5").read_bytes() == whole


@contextlib.contextmanager
def full():
    """A stream that takes nothing: a full disk."""
    with Path("/dev/full").open("wb") as stream:
        yield stream


@contextlib.contextmanager
def broken():
    """A stream that nobody reads any more."""
    read, write = os.pipe()
    os.close(read)
    yield write
    os.close(write)


def typed(value):
    """Name a test by what is typed."""
    return " ".join(Path(part).name for part in value) if isinstance(value, tuple) else None


@pytest.mark.parametrize(
    "command",
    [
        ("show", "out.h5"),
        ("check", SCENE),
        ("schema",),
        ("compare", "out.h5", "out.h5"),
        ("verify", "out.h5"),
        ("scenes",),
        ("--help",),
        ("run", "--help"),
        ("--version",),
        (),
    ],
    ids=typed,
)
def test_results_that_cannot_be_written(folder, command):
    with full() as stream:
        done = finish(*command, cwd=folder, stdout=stream)
    assert (done.returncode, done.stderr) == (1, "the output: No space left on device\n")
    with broken() as stream:
        done = finish(*command, cwd=folder, stdout=stream)
    assert (done.returncode, done.stderr) == (1, "")


WAYS_OUT = [
    (("show", "out.h5"), 0),
    (("--version",), 0),
    (("show", "no.h5"), 2),
    (("check", "broken.yaml"), 2),
    (("check", SCENE, "broken.yaml"), 2),
    (("compare", "out.h5", "other.h5"), 1),
    (("run",), 2),
    (("run", "--what"), 2),
    (("run", SCENE, "--rounds", "many"), 2),
    (("rnu", "out.h5"), 2),
    (("golden",), 2),
    (("golden", "check", "no.yaml"), 2),
    (RUN, 0),
    ((*RUN, "--set", "time_step=0.1", "--rounds", "400", "-o", "blown.h5"), 3),
]
"""Commands and their exit codes, by every way that the program ends."""


@pytest.mark.parametrize(("command", "code"), WAYS_OUT, ids=typed)
def test_messages_that_cannot_be_written(folder, command, code):
    """The exit code is that of the work, whether anybody hears of it or not, and however Python buffers."""
    for stream, variables in ((full, {}), (full, {"PYTHONUNBUFFERED": "1"}), (broken, {})):
        with stream() as nobody:
            assert finish(*command, cwd=folder, stderr=nobody, **variables).returncode == code


@pytest.mark.parametrize(("command", "code"), [way for way in WAYS_OUT if way[1]], ids=typed)
def test_nothing_can_be_written(folder, command, code):
    """Where the work has failed already, results that do not arrive make it no other failure."""
    for stream in (full, broken):
        with stream() as nobody:
            assert finish(*command, cwd=folder, stdout=nobody, stderr=nobody).returncode == code


@pytest.mark.parametrize(
    "variables",
    [
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        {"LC_ALL": "POSIX", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii:strict"},
    ],
)
def test_encodings_that_lack_our_letters(folder, variables):
    """What goes into a file or a pipe is UTF-8, whatever the locale: a scene has to come back as it was."""
    for command in (("show", "out.h5"), ("show", "out.h5", "--scene")):
        done = finish(*command, cwd=folder, **variables)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout == finish(*command, cwd=folder).stdout
    assert "τ = 0.01" in finish("show", "out.h5", cwd=folder, **variables).stdout
    done = finish("check", "no.yaml", "--set", "groups.τ×—=1", cwd=folder, **variables)
    assert (done.returncode, done.stderr) == (2, "no.yaml: there is no such file\n")


def test_a_terminal_that_lacks_our_letters_gets_escapes(folder):
    """On a terminal of another encoding UTF-8 would be gibberish."""
    leader, follower = os.openpty()
    done = finish("show", "out.h5", cwd=folder, stdout=follower, PYTHONIOENCODING="ascii")
    os.close(follower)
    assert (done.returncode, done.stderr) == (0, "")
    assert rb"\u03c4 = 0.01" in os.read(leader, 65536)
    os.close(leader)


def test_titles_do_not_command_the_terminal(cli):
    """A scene file cannot hold such characters, but a trajectory made to do damage can."""
    inside = load("scenes/rods.yaml")
    model, state = compile_scene(inside)
    model = replace(model, title="\x1b[31mred\x07 alert")
    header = Header.of(
        model,
        group_color=["#000000"] * len(model.groups),
        scene_text=inside.source.text,
        scene_name="\x9b2Jrods",
        rounds=10,
        record_every=10,
    )
    with Recorder.begin("out.h5", header) as recorder:
        for frame in simulate(model, state, 10, 10):
            recorder.append(frame)
        recorder.finish(End("finished"))
    result = cli("show", "out.h5")
    assert result.code == 0
    assert result.out.startswith("out.h5: \\x1b[31mred\\x07 alert\n  scene      \\x9b2Jrods\n")
    assert cli("render", "out.h5", "--size", "64x48").code == 0


def test_too_little_memory_is_one_line(folder):
    """A limit that NumPy fits into and the scene does not."""
    script = (
        "import resource, atomsim.tasks.run; resource.setrlimit(resource.RLIMIT_AS, (1 << 29, 1 << 29)); "
        "from atomsim.cli import main; main()"
    )
    settings = ("--set", "groups.left.count=9000000", "--set", "bonds.left=null", "--set", "collisions=null")
    done = finish("check", SCENE, *settings, program=python(script), cwd=folder, OPENBLAS_NUM_THREADS="1")
    assert done.returncode in (1, 2)
    assert "memory" in done.stderr or "allocate" in done.stderr
    assert done.stderr.count("\n") == 1
