"""Recording and resuming: whatever happens on the way, the finished file has the same bytes."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sample_run import digest_of, frame, go_on, header, holds, is_same_state, killed, record, resume
from support.process import finish, python

from atomsim.errors import InputError, Remedy, RunError
from atomsim.trajectory import End, Recorder, StoppedRun, Trajectory, journal_path, recorder, recover
from atomsim.trajectory.journal.form import FRAMES, PREFIX


@pytest.fixture
def uninterrupted(tmp_path: Path) -> Path:
    return record(tmp_path / "whole.h5", header(40))


def test_a_finished_run_leaves_one_file_that_holds_every_frame(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(40))
    assert list(tmp_path.iterdir()) == [path]
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30, 40])
        assert trajectory.end == End("finished")


def test_two_runs_give_the_same_bytes(tmp_path: Path, uninterrupted: Path) -> None:
    assert digest_of(record(tmp_path / "again.h5", header(40))) == digest_of(uninterrupted)


@pytest.mark.parametrize(("seconds", "n_bytes"), [(0.0, 1 << 20), (60.0, 1), (60.0, 1 << 20)])
def test_bytes_do_not_depend_on_blocks(
    tmp_path: Path, uninterrupted: Path, monkeypatch: pytest.MonkeyPatch, seconds: float, n_bytes: int
) -> None:
    monkeypatch.setattr(recorder, "BLOCK_SECONDS", seconds)
    monkeypatch.setattr(recorder, "BLOCK_BYTES", n_bytes)
    assert digest_of(record(tmp_path / "out.h5", header(40))) == digest_of(uninterrupted)


def test_compression_changes_the_file_and_no_number(tmp_path: Path, uninterrupted: Path) -> None:
    path = record(tmp_path / "out.h5", header(40, compress=True))
    assert digest_of(path) != digest_of(uninterrupted)
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30, 40])


@pytest.mark.parametrize("compress", [False, True])
def test_many_chunks_of_a_large_scene(tmp_path: Path, compress: bool) -> None:
    path = record(tmp_path / "out.h5", header(11, n_atoms=20_000, record_every=1, compress=compress))
    with Trajectory(path) as trajectory:
        assert holds(trajectory, list(range(12)))


def test_frames_may_change_after_they_are_recorded(tmp_path: Path) -> None:
    one = frame(0)
    with Recorder.begin(tmp_path / "out.h5", header(0)) as recording:
        recording.append(one)
        one.position[:] = np.nan
        recording.finish(End("finished"))
    with Trajectory(tmp_path / "out.h5") as trajectory:
        assert holds(trajectory, [0])


def test_a_recorder_refuses_rounds_that_go_back_and_other_numbers_of_atoms(tmp_path: Path) -> None:
    with Recorder.begin(tmp_path / "out.h5", header()) as recording:
        recording.append(frame(10))
        with pytest.raises(ValueError, match="round 10 recorded after round 10"):
            recording.append(frame(10))
        with pytest.raises(ValueError, match=r"shape \(5, 3\) in a trajectory of \(7, 3\)"):
            recording.append(frame(20, n_atoms=5))


def test_an_exception_leaves_everything_recorded_in_the_journal(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"

    def interrupted_run() -> None:
        with Recorder.begin(path, header()) as recording:
            go_on(recording, stop_after=30, finish=False)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted_run()
    assert list(tmp_path.iterdir()) == [journal_path(path)]
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30])
        assert trajectory.end == End("killed")


# --- What is in the way ---


@pytest.mark.parametrize("suffix", ["", ".part"])
def test_what_exists_is_not_touched_without_replace(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / "out.h5"
    taken = killed(path, header(), stop_after=20) if suffix else record(path, header())
    before = digest_of(taken)
    with pytest.raises(InputError) as caught:
        Recorder.begin(path, header())
    assert str(caught.value) == f"{taken} exists"
    assert caught.value.remedies == (Remedy("replace"), Remedy("go on", path))
    assert digest_of(taken) == before
    assert list(tmp_path.iterdir()) == [taken]


@pytest.mark.parametrize("suffix", ["", ".part"])
@pytest.mark.parametrize("replace", [True, False])
def test_what_is_no_trajectory_is_never_replaced(tmp_path: Path, suffix: str, replace: bool) -> None:
    """A slip such as `-o scene.yaml --force` must not cost the scene."""
    taken = tmp_path / f"out.h5{suffix}"
    taken.write_text("precious")
    with pytest.raises(InputError) as caught:
        Recorder.begin(tmp_path / "out.h5", header(), replace=replace)
    assert str(caught.value) == f"{taken} exists and is no trajectory"
    assert caught.value.remedies == (Remedy("rename"),)
    assert taken.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [taken]


def test_replace_keeps_the_old_file_until_the_new_one_is_finished(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(40))
    old = digest_of(path)
    with Recorder.begin(path, header(20), replace=True) as recording:
        go_on(recording, finish=False)
        assert digest_of(path) == old
        with Trajectory(path) as trajectory:
            assert len(trajectory) == 5
            assert trajectory.has_journal
            assert not trajectory.from_journal
        recording.finish(End("finished"))
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20])
        assert not trajectory.has_journal


def test_replace_takes_the_place_of_a_journal_too(tmp_path: Path, uninterrupted: Path) -> None:
    killed(tmp_path / "out.h5", header(100), stop_after=50)
    assert digest_of(record(tmp_path / "out.h5", header(40), replace=True)) == digest_of(uninterrupted)


def test_places_where_no_trajectory_can_be(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path, message in {
        tmp_path / "missing" / "out.h5": f"there is no folder {tmp_path / 'missing'}",
        tmp_path: "is a folder; name a file in it",
        pipe: "is not a regular file",
        tmp_path / "out.part": f"this is the name of a journal; name its trajectory, {tmp_path / 'out'}",
    }.items():
        with pytest.raises(InputError) as caught:
            Recorder.begin(path, header(), replace=True)
        assert str(caught.value) == f"{path}: {message}"


def test_a_name_that_is_too_long_fails_before_the_run(tmp_path: Path) -> None:
    path = tmp_path / ("x" * 250)
    with pytest.raises(RunError) as caught:
        Recorder.begin(path, header())
    assert str(caught.value) == f"{journal_path(path)}: cannot be written: File name too long"
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("act", ["begin", "replace", "resume", "recover"])
def test_a_second_writer_is_kept_out(tmp_path: Path, act: str) -> None:
    path = tmp_path / "out.h5"
    acts = {
        "begin": lambda: Recorder.begin(path, header()),
        "replace": lambda: Recorder.begin(path, header(), replace=True),
        "resume": lambda: resume(path),
        "recover": lambda: recover(path),
    }
    with Recorder.begin(path, header()) as recording:
        go_on(recording, stop_after=20, finish=False)
        with pytest.raises((RunError, InputError)) as caught:
            acts[act]()
        go_on_from = frame(30)
        recording.append(go_on_from)
    if act != "begin":
        assert str(caught.value) == f"{journal_path(path)}: another atomsim is writing it; wait for that to end"
        assert caught.value.remedies == (Remedy("rename"),)
    assert list(tmp_path.iterdir()) == [journal_path(path)]
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30])


def test_a_writer_that_begins_at_the_same_moment_loses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between looking whether the name is free and taking it, someone else takes it."""
    path = tmp_path / "out.h5"
    monkeypatch.setattr(recorder, "_check_free", lambda _path, *, replace: None)
    with Recorder.begin(path, header()) as recording:
        recording.append(frame(0))
        with pytest.raises(RunError, match="another atomsim has just begun to write it"):
            Recorder.begin(path, header())
    assert list(tmp_path.iterdir()) == [journal_path(path)]


# --- Going on ---


@pytest.mark.parametrize("stops", [[0], [5], [20], [39], [40], [10, 10, 25]])
def test_resuming_a_killed_run_gives_the_same_bytes(tmp_path: Path, uninterrupted: Path, stops: list[int]) -> None:
    path = tmp_path / "out.h5"
    killed(path, header(40), stop_after=stops[0])
    for stop in [*stops[1:], None]:
        with resume(path) as recording:
            assert is_same_state(recording.state, frame(recording.state.round_index if recording.state else -1))
            go_on(recording, stop_after=stop, finish=stop is None)
    assert digest_of(path) == digest_of(uninterrupted)
    assert not journal_path(path).exists()


@pytest.mark.parametrize("rounds", [10, 15, 39])
def test_extending_a_finished_run_gives_the_same_bytes(tmp_path: Path, uninterrupted: Path, rounds: int) -> None:
    path = record(tmp_path / "out.h5", header(rounds))
    with resume(path, rounds=40) as recording:
        assert is_same_state(recording.state, frame(rounds))
        go_on(recording)
    assert digest_of(path) == digest_of(uninterrupted)


def test_extending_keeps_the_finished_file_until_the_longer_one_is_there(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(15))
    old = digest_of(path)
    with resume(path, rounds=40) as recording:
        go_on(recording, stop_after=30, finish=False)
    assert digest_of(path) == old
    with resume(path) as recording:
        assert is_same_state(recording.state, frame(30))
        assert recording.header.rounds == 40


@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True, deadline=None)
@given(stops=st.dictionaries(st.integers(1, 39), st.booleans(), max_size=4))
def test_any_number_of_stops_and_extensions_gives_the_same_bytes(
    tmp_path_factory: pytest.TempPathFactory, uninterrupted: Path, stops: dict[int, bool]
) -> None:
    """Each stop is a total of rounds, and whether the run was finished there or killed."""
    path = tmp_path_factory.mktemp("stops") / "out.h5"
    is_begun = False
    for rounds, is_ended in [*sorted(stops.items()), (40, True)]:
        with resume(path, rounds=rounds) if is_begun else Recorder.begin(path, header(rounds)) as recording:
            go_on(recording, finish=is_ended)
        is_begun = True
    assert digest_of(path) == digest_of(uninterrupted)


def test_a_frame_between_the_recorded_rounds_is_dropped_only_when_the_run_goes_on(
    tmp_path: Path, uninterrupted: Path
) -> None:
    path = tmp_path / "out.h5"
    with Recorder.begin(path, header(40)) as recording:
        go_on(recording, stop_after=10, finish=False)
        recording.append(frame(13))
        recording.finish(End("interrupted", "Ctrl-C"))
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 13])
        assert trajectory.end == End("interrupted", "Ctrl-C")
    with resume(path) as recording:
        assert is_same_state(recording.state, frame(13))
        go_on(recording)
    assert digest_of(path) == digest_of(uninterrupted)


def test_a_journal_without_a_frame_goes_on_from_the_beginning(tmp_path: Path, uninterrupted: Path) -> None:
    path = tmp_path / "out.h5"
    with Recorder.begin(path, header(40)):
        pass
    with pytest.raises(RunError) as caught:
        recover(path)
    assert str(caught.value) == f"{path}: nothing to build: its journal out.h5.part holds no frame yet"
    assert caught.value.remedies == (Remedy("begin", path),)
    with resume(path) as recording:
        assert recording.state is None
        go_on(recording)
    assert digest_of(path) == digest_of(uninterrupted)


@pytest.mark.parametrize("garbage", [b"\0" * 100, b"atom.fra", PREFIX.pack(FRAMES, 1 << 40, 0), b"?"])
def test_a_torn_tail_is_cut_when_the_run_goes_on(tmp_path: Path, uninterrupted: Path, garbage: bytes) -> None:
    path = tmp_path / "out.h5"
    journal = killed(path, header(40), stop_after=20)
    with journal.open("ab") as file:
        file.write(garbage)
    with Trajectory(path) as trajectory:
        assert trajectory.lost_bytes == len(garbage)
        assert holds(trajectory, [0, 10, 20])
    with resume(path) as recording:
        go_on(recording)
    assert digest_of(path) == digest_of(uninterrupted)


@pytest.mark.parametrize("rounds", [None, 40, 30])
def test_a_finished_run_has_nothing_to_go_on_to(tmp_path: Path, uninterrupted: Path, rounds: int | None) -> None:
    with StoppedRun(uninterrupted, rounds) as stopped:
        assert stopped.is_complete
    assert list(tmp_path.iterdir()) == [uninterrupted]


def test_a_killed_run_cannot_be_made_shorter_than_it_is(tmp_path: Path) -> None:
    journal = killed(tmp_path / "out.h5", header(40), stop_after=20)
    before = digest_of(journal)
    with pytest.raises(InputError, match="has done 20 rounds already"):
        resume(tmp_path / "out.h5", rounds=10)
    assert digest_of(journal) == before


def test_resuming_what_does_not_exist(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    with pytest.raises(InputError) as caught:
        resume(path)
    assert str(caught.value) == f"{path}: no such file"


# --- Recovering ---


def test_recovering_a_killed_run_keeps_its_frames_and_says_so(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    killed(path, header(40), stop_after=20)
    recover(path)
    assert list(tmp_path.iterdir()) == [path]
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20])
        assert trajectory.end == End("killed")


def test_a_recovered_run_can_be_resumed(tmp_path: Path, uninterrupted: Path) -> None:
    path = tmp_path / "out.h5"
    killed(path, header(40), stop_after=20)
    recover(path)
    with resume(path) as recording:
        go_on(recording)
    assert digest_of(path) == digest_of(uninterrupted)


def test_recovering_needs_a_journal(uninterrupted: Path) -> None:
    with pytest.raises(InputError) as caught:
        recover(uninterrupted)
    assert str(caught.value) == f"{uninterrupted}: there is no journal {uninterrupted}.part to recover it from"


def test_a_run_imports_hdf5_only_at_its_end() -> None:
    code = "import sys, atomsim.trajectory; sys.exit('h5py' in sys.modules)"
    assert finish(program=python(code)).returncode == 0


@pytest.mark.parametrize("is_finished", [False, True])
def test_a_stopped_run_is_looked_at_before_anything_changes(tmp_path: Path, is_finished: bool) -> None:
    path = tmp_path / "out.h5"
    left = record(path, header(20)) if is_finished else killed(path, header(20), 20)
    before = digest_of(left)
    with StoppedRun(path, 40) as stopped:
        assert (stopped.header.rounds, stopped.header.title) == (40, "Two rods · τ")
        assert is_same_state(stopped.state, frame(20))
        assert (digest_of(left), list(tmp_path.iterdir())) == (before, [left])
    assert (digest_of(left), list(tmp_path.iterdir())) == (before, [left])
    with resume(path, rounds=40) as recording:  # the lock is free
        go_on(recording)
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30, 40])
