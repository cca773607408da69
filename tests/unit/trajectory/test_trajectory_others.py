"""Other programs change the files of a run while it goes on: nothing of theirs is replaced, nothing of ours lost."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from sample_run import digest_of, frame, go_on, header, holds, killed, record, resume

from atomsim.errors import InputError, Remedy, RunError
from atomsim.trajectory import End, Recorder, Trajectory, building, journal_path, recorder, recover
from atomsim.trajectory.journal.form import HEAD, PREFIX, checksum_start
from atomsim.trajectory.rows import row_dtype

FRAME = PREFIX.size + row_dtype(7).itemsize
"""Bytes of a frame in a journal with one frame in each block."""


@pytest.fixture
def whole(tmp_path_factory: pytest.TempPathFactory) -> str:
    return digest_of(record(tmp_path_factory.mktemp("whole") / "out.h5", header(40)))


@pytest.fixture
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(recorder, "BLOCK_SECONDS", 0.0)  # every frame is a block
    return tmp_path / "out.h5"


def refusal(path: Path) -> str:
    return (
        f"{path}: another program wrote it after the run began; all frames of the run are safe in {path}.part: "
        f"move {path} away first"
    )


# --- A file under the name of the finished one ---


def write_text(path: Path) -> None:
    path.write_text("precious")


def write_trajectory(path: Path) -> None:
    """Write what looks like a run of ours, but is another's; it was made elsewhere and moved here."""
    other = path.parent / "other"
    other.mkdir()
    record(other / "out.h5", header(20)).rename(path)
    other.rmdir()


@pytest.mark.parametrize("write", [write_text, write_trajectory])
@pytest.mark.parametrize("replace", [False, True])
def test_what_another_program_wrote_meanwhile_stays(
    path: Path, whole: str, write: Callable[[Path], None], replace: bool
) -> None:
    """`--force` is about what was there when it was said."""
    if replace:
        record(path, header(10))
    with Recorder.begin(path, header(40), replace=replace) as recording:
        go_on(recording, finish=False)
        write(path)
        theirs = digest_of(path)
        with pytest.raises(RunError) as caught:
            recording.finish(End("finished"))
    assert str(caught.value) == refusal(path)
    assert digest_of(path) == theirs
    for go_on_with in (recover, resume):
        with pytest.raises(RunError) as caught:
            go_on_with(path)
        assert str(caught.value) == refusal(path)
        assert caught.value.remedies == (Remedy("recover", path),)
    assert set(path.parent.iterdir()) == {path, journal_path(path)}
    path.rename(path.with_name("theirs"))
    recover(path)
    assert digest_of(path) == whole


def test_what_comes_in_the_last_moment_stays_too(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between looking whether the name is free and taking it."""
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, finish=False)
        monkeypatch.setattr(building, "require_own", lambda path, _: path.write_text("precious"))
        monkeypatch.setattr(Path, "exists", lambda _: False)
        with pytest.raises(RunError, match="another program wrote it after the run began"):
            recording.finish(End("finished"))
    assert path.read_text() == "precious"
    assert set(path.parent.iterdir()) == {path, journal_path(path)}


def test_what_was_changed_while_its_run_goes_on_stays(path: Path) -> None:
    record(path, header(20))
    with resume(path, rounds=40) as recording:
        go_on(recording, finish=False)
        os.utime(path, ns=(0, 0))
        with pytest.raises(RunError) as caught:
            recording.finish(End("finished"))
    assert str(caught.value) == refusal(path)


def test_the_right_to_replace_a_file_outlives_a_kill(path: Path, whole: str) -> None:
    record(path, header(10))
    with Recorder.begin(path, header(40), replace=True) as recording:
        go_on(recording, stop_after=20, finish=False)
    with resume(path) as recording:
        go_on(recording, stop_after=30, finish=False)
    with resume(path) as recording:
        go_on(recording)
    assert digest_of(path) == whole


def test_a_kill_between_naming_the_file_and_removing_the_journal(path: Path, whole: str) -> None:
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, finish=False)
        journal = journal_path(path)
        saved = journal.with_name("saved")
        os.link(journal, saved)
        recording.finish(End("finished"))
    saved.rename(journal)
    recover(path)
    assert digest_of(path) == whole
    assert list(path.parent.iterdir()) == [path]


def test_a_kill_while_a_file_has_two_names_costs_neither(path: Path, whole: str) -> None:
    """Between getting its own name and losing the temporary one; the next to use that one must not empty the file."""
    record(path, header(40))
    os.link(path, path.with_name("out.h5.part.built"))
    killed(path.with_name("next.h5"), header(40), 20).rename(journal_path(path))
    with pytest.raises(RunError):
        recover(path)
    assert digest_of(path) == whole
    path.unlink()
    journal = journal_path(path)
    before = digest_of(journal)
    os.link(journal, journal.with_name("out.h5.part.tmp"))
    second = path.with_name("second.part")
    os.link(journal, second)
    with Recorder.begin(path, header(40), replace=True):
        pass
    assert digest_of(second) == before


# --- Damage to the journal ---


def test_a_journal_that_is_removed_is_put_back(path: Path, whole: str) -> None:
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, stop_after=20, finish=False)
        journal_path(path).unlink()
        recording.append(frame(30))
        with Trajectory(path) as seen:
            assert holds(seen, [0, 10, 20, 30])
        with pytest.raises(RunError, match="another atomsim is writing it"):
            resume(path)
        recording.append(frame(40))
        recording.finish(End("finished"))
    assert digest_of(path) == whole
    assert list(path.parent.iterdir()) == [path]


def test_a_journal_that_was_moved_is_written_where_it_is(path: Path, whole: str) -> None:
    moved = path.with_name("moved.h5.part")
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, stop_after=20, finish=False)
        journal_path(path).rename(moved)
        recording.append(frame(30))
    with resume(path.with_name("moved.h5")) as recording:
        go_on(recording)
    assert digest_of(path.with_name("moved.h5")) == whole


def test_a_journal_whose_name_was_taken_gets_another(path: Path, whole: str) -> None:
    journal = journal_path(path)
    record(path.with_name("out-2.h5"), header(10))
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, stop_after=20, finish=False)
        journal.unlink()
        journal.write_text("precious")
        with pytest.raises(RunError) as caught:
            recording.append(frame(30))
    other = path.with_name("out-3.h5")
    assert str(caught.value) == (
        f"{journal}: another program wrote a file of that name; all frames of the run are in {other}.part"
    )
    assert caught.value.remedies == (Remedy("go on", other),)
    assert journal.read_text() == "precious"
    with resume(other) as recording:
        go_on(recording)
    assert digest_of(other) == whole


def test_a_file_that_took_the_name_of_a_journal_is_not_removed_with_it(path: Path, whole: str) -> None:
    journal = journal_path(path)
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, finish=False)
        journal.rename(path.with_name("moved"))
        journal.write_text("precious")
        recording.finish(End("finished"))
    assert journal.read_text() == "precious"
    assert digest_of(path) == whole


@pytest.mark.parametrize(
    ("lost", "kept"), [(1, [0, 10]), (FRAME + 1, [0]), (3 * FRAME, []), (3 * FRAME + 1, []), (None, [])]
)
def test_a_journal_that_is_shortened_keeps_what_is_left_and_the_newest_frames(
    path: Path, lost: int | None, kept: list[int]
) -> None:
    journal = journal_path(path)
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, stop_after=20, finish=False)
        os.truncate(journal, 0 if lost is None else journal.stat().st_size - lost)
        with pytest.raises(RunError) as caught:
            recording.append(frame(30))
    since = f"round {kept[-1]}" if kept else "its header"
    assert str(caught.value) == (
        f"{journal}: another program shortened it, and its frames after {since} up to round 20 are lost; what is left "
        "and the newest frames are in it"
    )
    assert caught.value.remedies == (Remedy("go on", path),)
    with resume(path) as recording:
        go_on(recording)
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [*kept, 30, 40])


def test_a_shortened_journal_still_knows_what_it_may_replace(path: Path) -> None:
    record(path, header(10))
    with Recorder.begin(path, header(40), replace=True) as recording:
        go_on(recording, stop_after=20, finish=False)
        os.truncate(journal_path(path), 0)
        with pytest.raises(RunError):
            recording.append(frame(30))
    recover(path)
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [30])


def test_a_journal_that_is_overwritten_is_not_taken_for_a_whole_one(path: Path, whole: str) -> None:
    """Nothing is built from it, nothing removed; going on computes what is lost again."""
    journal = journal_path(path)
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, finish=False)
        with journal.open("r+b") as file:
            file.seek(-2 * FRAME, os.SEEK_END)
            file.write(b"\0" * 100)
        with pytest.raises(RunError) as caught:
            recording.finish(End("finished"))
    assert str(caught.value) == (
        f"{journal}: another program changed it, and its frames after round 20 are lost; they can be computed again"
    )
    assert caught.value.remedies == (Remedy("go on", path),)
    assert list(path.parent.iterdir()) == [journal]
    with resume(path) as recording:
        go_on(recording)
    assert digest_of(path) == whole


def test_records_that_only_a_later_version_understands_are_not_cut_off(path: Path) -> None:
    journal = killed(path, header(40), 20)
    with journal.open("ab") as file:
        file.write(PREFIX.pack(b"atom.new", 0, checksum_start(b"atom.new", 0)))
    before = digest_of(journal)
    for act in (recover, resume):
        with pytest.raises(InputError) as caught:
            act(path)
        assert str(caught.value) == f"{journal}: written by a later atomsim, which is needed to go on with it"
    assert digest_of(journal) == before
    assert journal.read_bytes()[:8] == HEAD
