"""When the disk says no: one message that says what is left, and nothing recorded is lost."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from sample_run import digest_of, frame, go_on, header, holds, killed, record, resume
from support.process import finish, python

from atomsim.errors import AtomsimError, InputError, Remedy, RunError
from atomsim.trajectory import End, Recorder, Trajectory, journal_path, recorder, recover

CALLS = ("open", "pwrite", "fsync", "ftruncate", "link", "replace")
"""All by which the package changes the disk, as attributes of `os`."""


STRIDE = 1 if os.environ.get("ATOMSIM_LONG") else 11


class Trouble:
    """Lets some calls of the operating system pass and fails from there on: for good, or once."""

    def __init__(self, patch: pytest.MonkeyPatch, passing: int, *, for_good: bool) -> None:
        self.left = passing
        self.for_good = for_good
        self.n_failed = 0
        for name in CALLS:
            patch.setattr(os, name, self._failing(getattr(os, name)))

    def _failing(self, call: Callable[..., Any]) -> Callable[..., Any]:
        def failing(*args: Any, **options: Any) -> Any:
            self.left -= 1
            if self.left >= 0 or (self.n_failed > 0 and not self.for_good):
                return call(*args, **options)
            self.n_failed += 1
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        return failing


def run_in_trouble(path: Path, passing: int, *, for_good: bool) -> tuple[int, list[int], AtomsimError | None]:
    """Record a run; return how many calls failed, the rounds handed over, and the error that the user sees."""
    appended: list[int] = []
    error: AtomsimError | None = None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(recorder, "BLOCK_SECONDS", 0.0)
        trouble = Trouble(patch, passing, for_good=for_good)
        try:
            with Recorder.begin(path, header(40)) as recording:
                for round_index in range(0, 41, 10):
                    recording.append(frame(round_index))
                    appended.append(round_index)
                recording.finish(End("finished"))
        except AtomsimError as caught:
            error = caught
    return trouble.n_failed, appended, error


@pytest.mark.parametrize("for_good", [True, False])
def test_an_error_at_any_call_loses_nothing(tmp_path: Path, for_good: bool) -> None:
    """Fail at the first call, or a later one and so on, until a run needs no more calls."""
    whole = digest_of(record(tmp_path / "whole.h5", header(40)))
    n_errors = 0
    for passing in range(0, 10_000, STRIDE):
        folder = tmp_path / str(passing)
        folder.mkdir()
        path = folder / "out.h5"
        n_failed, appended, error = run_in_trouble(path, passing, for_good=for_good)
        if n_failed == 0:
            break
        if error is not None:
            n_errors += 1
            _check_what_is_left(path, appended, error)
        assert {left.name for left in folder.iterdir()} <= {"out.h5", "out.h5.part"}
        with (
            resume(path)
            if list(folder.iterdir()) and error
            else Recorder.begin(path, header(40), replace=True) as recording
        ):
            go_on(recording)
        assert digest_of(path) == whole
    assert n_errors > 100 // STRIDE


def _check_what_is_left(path: Path, appended: list[int], error: AtomsimError) -> None:
    assert isinstance(error, RunError)
    assert "No space left on device" in str(error)
    assert "\n" not in str(error)
    if not appended:
        return
    with Trajectory(path) as trajectory:
        assert holds(trajectory, trajectory.rounds.tolist())
        assert set(appended) <= set(trajectory.rounds.tolist())


def test_the_message_of_a_full_disk_while_running(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    with pytest.MonkeyPatch.context() as patch, Recorder.begin(path, header(40)) as recording:
        recording.append(frame(0))
        recording.append(frame(10))
        Trouble(patch, 0, for_good=True)
        with pytest.raises(RunError) as caught:
            recording.finish(End("finished"))
        patch.undo()
    assert str(caught.value) == (
        f"{path}.part: No space left on device; what was recorded before is intact in it: make room first"
    )
    assert caught.value.remedies == (Remedy("go on", path),)
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10])


def test_the_message_of_a_full_disk_while_building(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    with pytest.MonkeyPatch.context() as patch, Recorder.begin(path, header(40)) as recording:
        go_on(recording, finish=False)
        calls_until_built = 4  # the last block (prefix and rows) and the end (prefix and text)
        Trouble(patch, calls_until_built + 10, for_good=True)
        with pytest.raises(RunError) as caught:
            recording.finish(End("finished"))
    assert str(caught.value) == (
        f"{path}: cannot be written: No space left on device; all frames are safe in {path}.part: make room first"
    )
    assert caught.value.remedies == (Remedy("recover", path),)
    recover(path)
    assert digest_of(path) == digest_of(record(tmp_path / "whole.h5", header(40)))


def test_a_folder_that_vanishes(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    with Recorder.begin(folder / "out.h5", header(40)) as recording:
        go_on(recording, stop_after=20, finish=False)
        shutil.rmtree(folder)
        with pytest.raises(RunError) as caught:
            recording.finish(End("finished"))
    assert str(caught.value) == (
        f"{folder / 'out.h5.part'}: removed by another program, and so are its frames: No such file or directory"
    )


def test_a_journal_that_someone_removed_is_built_all_the_same(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, finish=False)
        journal_path(path).unlink()
        recording.finish(End("finished"))
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30, 40])


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written_to(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir(mode=0o500)
    with pytest.raises(RunError) as caught:
        Recorder.begin(folder / "out.h5", header())
    assert str(caught.value) == f"{folder / 'out.h5.part'}: cannot be written: Permission denied"


def test_a_folder_that_may_not_be_looked_into(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "out.h5"

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(Path, "stat", refuse)
    for act in (Trajectory, resume, recover, lambda name: Recorder.begin(name, header())):
        with pytest.raises(InputError) as caught:
            act(path)
        assert str(caught.value) == f"{path}: Permission denied"


@pytest.mark.parametrize("missing", ["fcntl.flock", "os.link"])
def test_a_file_system_without_locks_or_hard_links_will_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, missing: str
) -> None:
    n_refused = 0

    def refuse(*_: object, **__: object) -> None:
        nonlocal n_refused
        n_refused += 1
        raise OSError(errno.EOPNOTSUPP, os.strerror(errno.EOPNOTSUPP))

    monkeypatch.setattr(missing, refuse)
    path = record(tmp_path / "out.h5", header(40))
    assert n_refused > 0
    assert list(tmp_path.iterdir()) == [path]
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30, 40])


LIMITED = """
import resource, sys
sys.dont_write_bytecode = True  # cut short by the limit, it would be found by the next process
from pathlib import Path
from sample_run import header, record
from atomsim.errors import RunError
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
try:
    record(Path(sys.argv[1]), header(400))
except RunError as error:
    sys.exit(str(error))
"""


@pytest.mark.parametrize("successor", [None, b"the journal of the next run"])
def test_a_journal_that_goes_away_before_it_is_locked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, successor: bytes | None
) -> None:
    """Its writer has just finished, and perhaps the next one begun: what was opened is not what has the name now."""
    path = tmp_path / "out.h5"
    journal = killed(path, header(40), 20)
    lock = fcntl.flock

    def lock_late(fd: int, operation: int) -> None:
        journal.rename(tmp_path / "moved")
        if successor is not None:
            journal.write_bytes(successor)
        lock(fd, operation)

    monkeypatch.setattr(fcntl, "flock", lock_late)
    with pytest.raises(RunError) as caught:
        resume(path)
    assert str(caught.value) == f"{journal}: another atomsim is writing it; wait for that to end"
    assert (journal.read_bytes() if journal.exists() else None) == successor


@pytest.mark.parametrize("limit", [1_000, 10_000, 25_000, 45_000])
def test_a_real_limit_on_the_size_of_files(tmp_path: Path, limit: int) -> None:
    """HDF5 survives what the operating system really does when a file may not grow."""
    path = tmp_path / "out.h5"
    done = finish(path, str(limit), program=python(LIMITED), PYTHONPATH=str(Path(__file__).parent))
    assert done.returncode == 1
    assert "File too large" in done.stderr
    assert done.stderr.count("\n") == 1
    if journal_path(path).exists():
        with resume(path) as recording:
            go_on(recording)
    else:
        record(path, header(400))
    assert digest_of(path) == digest_of(record(tmp_path / "whole.h5", header(400)))
