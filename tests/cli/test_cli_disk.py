"""Full disks, small limits, folders that are read-only or vanish, two runs into one file: one line, nothing lost."""

from __future__ import annotations

import os
import re
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.process import finish, start

from atomsim.errors import InputError
from atomsim.trajectory import Trajectory, journal_path

SCENE = Path(__file__).parents[2] / "scenes" / "rods.yaml"
RUN = ("run", SCENE, "--backend", "numpy", "-q")


def whole(folder: Path, *more: str) -> bytes:
    """Return the bytes of an undisturbed run."""
    assert finish(*RUN, "-o", "whole.h5", *more, cwd=folder).returncode == 0
    return (folder / "whole.h5").read_bytes()


def one_line(message: str) -> str:
    """Check that a message is one line and no traceback; return it."""
    assert message.count("\n") == 1, message
    assert "Traceback" not in message
    return message.rstrip("\n")


@pytest.mark.parametrize("limit", [20_000, 100_000, 400_000, 660_000])
def test_a_file_that_may_not_grow(tmp_path, limit):
    """The system refuses to write beyond a size: in the header, in the frames, or while the file is built."""
    done = finish(
        *RUN,
        *("--rounds", "900"),
        cwd=tmp_path,
        before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY)),
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert "File too large" in one_line(done.stderr)
    if journal_path(tmp_path / "out.h5").exists():
        with Trajectory(tmp_path / "out.h5") as trajectory:
            assert trajectory.rounds.tolist() == list(range(0, 10 * len(trajectory), 10))
            trajectory.verify()
        again = finish("run", "--resume", "out.h5", "-q", cwd=tmp_path)
        assert (again.returncode, again.stderr) == (0, "")
        assert (tmp_path / "out.h5").read_bytes() == whole(tmp_path, "--rounds", "900")
    else:
        assert list(tmp_path.iterdir()) == []


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A real file system of 4 MB, where the system lets us mount one."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=4m", "none", folder], capture_output=True, check=False
    )
    if mounted.returncode != 0:
        pytest.skip("may not mount a small disk here")
    yield folder
    subprocess.run(["umount", "--lazy", folder], check=True)


def has_frames(path: Path) -> bool:
    """Tell whether a run that is going on has recorded its first frame."""
    try:
        with Trajectory(path):
            return True
    except InputError:
        return False


def fill(folder: Path) -> None:
    """Write until nothing more fits."""
    with (folder / "filler").open("wb", buffering=0) as filler:
        try:
            while filler.write(bytes(4096)):
                pass
        except OSError:
            pass


def test_a_run_that_cannot_fit_is_refused_at_once(small_disk):
    done = finish(*RUN, "--rounds", "100000", cwd=small_disk)
    assert done.returncode == 1
    assert one_line(done.stderr) == (
        "out.h5: needs 140 MB of disk while it is written, and 4.2 MB are free; "
        "record fewer frames with a larger record_every"
    )
    assert list(small_disk.iterdir()) == []


def test_a_disk_that_fills_up_while_a_run_goes_on(small_disk, tmp_path):
    """What was recorded stays; after making room the run goes on to the bytes of an undisturbed one."""
    process = start(*RUN, "--rounds", "2500", cwd=small_disk)
    while not has_frames(small_disk / "out.h5"):
        time.sleep(0.005)
        assert process.poll() is None
    fill(small_disk)
    out, err = process.communicate()
    assert (process.returncode, out) == (1, "")
    assert re.fullmatch(
        r"out\.h5\.part: No space left on device; what was recorded before is intact in it: "
        r"make room first; to go on: atomsim run --resume out\.h5",
        one_line(err),
    )
    assert finish("show", "out.h5", cwd=small_disk).returncode == 0
    again = finish("run", "--resume", "out.h5", cwd=small_disk)
    assert again.returncode == 1
    (small_disk / "filler").unlink()
    assert finish("run", "--resume", "out.h5", "-q", cwd=small_disk).returncode == 0
    assert (small_disk / "out.h5").read_bytes() == whole(tmp_path, "--rounds", "2500")


def test_a_picture_on_a_full_disk(small_disk):
    assert finish(*RUN, "--rounds", "20", cwd=small_disk).returncode == 0
    assert finish("render", "out.h5", "--size", "64x48", cwd=small_disk).returncode == 0
    before = (small_disk / "out.png").read_bytes()
    fill(small_disk)
    done = finish("render", "out.h5", cwd=small_disk)
    assert done.returncode == 1
    assert "No space left on device" in one_line(done.stderr)
    assert (small_disk / "out.png").read_bytes() == before


@pytest.fixture
def read_only(small_disk: Path) -> Path:
    """A folder with a trajectory in it that not even root can write to."""
    assert finish(*RUN, "--rounds", "20", cwd=small_disk).returncode == 0
    subprocess.run(["mount", "-o", "remount,ro", small_disk], check=True)
    return small_disk


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((*RUN, "--rounds", "20", "-o", "new.h5"), "new.h5.part: cannot be written: Read-only file system"),
        (("run", "--resume", "out.h5", "--rounds", "40"), "out.h5.part: cannot be written: Read-only file system"),
        (("render", "out.h5", "--size", "64x48"), "out.png: cannot be written: Read-only file system"),
    ],
)
def test_a_folder_that_cannot_be_written_to(read_only, arguments, message):
    done = finish(*arguments, cwd=read_only)
    assert (done.returncode, done.stdout, one_line(done.stderr)) == (1, "", message)
    assert finish("show", "out.h5", cwd=read_only).returncode == 0
    assert [path.name for path in read_only.iterdir()] == ["out.h5"]


def running(folder: Path, output: str = "out.h5") -> subprocess.Popen[str]:
    """Start a run of minutes; return when it records."""
    process = start(*RUN, "--rounds", "1000000", "--set", "record_every=100000", "-o", output, cwd=folder)
    while not has_frames(folder / output):
        time.sleep(0.01)
        assert process.poll() is None
    return process


def test_a_folder_that_vanishes(tmp_path):
    (tmp_path / "away").mkdir()
    process = running(tmp_path, "away/out.h5")
    shutil.rmtree(tmp_path / "away")
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate()
    assert process.returncode == 1
    assert one_line(err) == (
        "away/out.h5: cannot be written: No such file or directory; "
        "its folder or its journal is gone, and the frames with it"
    )


def test_a_current_folder_that_is_gone(tmp_path):
    gone = tmp_path / "gone"
    gone.mkdir()
    done = finish("run", SCENE, "-q", cwd=gone, before=gone.rmdir)
    assert (done.returncode, done.stdout) == (1, "")
    assert one_line(done.stderr) == "the current folder: No such file or directory"


def test_a_second_run_into_the_same_file_is_refused(tmp_path):
    process = running(tmp_path)
    in_use = "out.h5.part: another atomsim is writing it; wait for that to end; choose another name with -o"
    exists = "out.h5.part exists; add --force to replace it; to go on: atomsim run --resume out.h5"
    for arguments, code, message in (
        (RUN, 2, exists),
        ((*RUN, "--force"), 1, in_use),
        (("run", "--resume", "out.h5"), 1, in_use),
        (("recover", "out.h5"), 1, in_use),
    ):
        done = finish(*arguments, cwd=tmp_path)
        assert (done.returncode, done.stdout, one_line(done.stderr)) == (code, "", message)
    assert finish("show", "out.h5", cwd=tmp_path).returncode == 0
    process.send_signal(signal.SIGTERM)
    process.communicate()
    assert process.returncode == 143
    assert finish("verify", "out.h5", cwd=tmp_path).returncode == 0
    assert [path.name for path in tmp_path.iterdir()] == ["out.h5"]


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("", ".: is a folder; name a file in it"),
        ("/dev/full", "/dev/full: is not a regular file"),
        ("pipe", "pipe: is not a regular file"),
        ("scene.yaml", "scene.yaml exists and is no trajectory; choose another name with -o"),
        ("a/b/c.h5", "a/b/c.h5: there is no folder a/b"),
        ("scene.yaml/c.h5", "scene.yaml/c.h5: there is no folder scene.yaml"),
        ("out.h5.part", "out.h5.part: this is the name of a journal; name its trajectory, out.h5"),
        ("x" * 300, f"{'x' * 300}: File name too long"),
    ],
)
def test_names_that_cannot_be_written_to(cli, output, message):
    os.mkfifo("pipe")
    shutil.copy("scenes/rods.yaml", "scene.yaml")
    result = cli("run", "scene.yaml", "-q", "--force", "-o", output)
    assert (result.code, result.out, one_line(result.err)) == (2, "", message)
    assert Path("scene.yaml").read_bytes() == SCENE.read_bytes()
    assert sorted(path.name for path in Path().iterdir()) == ["pipe", "scene.yaml", "scenes"]


@pytest.mark.parametrize("name", ["my run.h5", "new\nline.h5", "by\udcffte.h5", "esc\x1b[31m.h5", "τ×.h5", "-dash.h5"])
def test_names_that_are_only_odd(cli, name):
    output = f"./{name}"
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-o", output, "--backend", "numpy").code == 0
    assert cli("run", "--resume", output, "--rounds", "30", "-q").code == 0
    for command in ("show", "verify", "render"):
        result = cli(command, output, *(("--size", "64x48") if command == "render" else ()))
        assert result.code == 0
        assert "\x1b" not in result.out + result.err
    assert cli("compare", output, output).code == 0
    result = cli("run", "scenes/rods.yaml", "-o", output)
    assert result.code == 2
    assert "\x1b" not in result.err
