"""Reading: a trajectory is an ordinary sequence, finished or not."""

from __future__ import annotations

import copy
import os
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import h5py
import MDAnalysis
import numpy as np
import pytest
from sample_run import TIME_STEP, frame, header, holds, is_same_frame, killed, record

from atomsim.errors import InputError
from atomsim.trajectory import End, Recorder, Trajectory
from atomsim.trajectory.header import document
from atomsim.version import __version__


@pytest.fixture(params=["finished", "compressed", "journal"])
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    out = tmp_path / "out.h5"
    if request.param == "journal":
        killed(out, header(40), stop_after=40)
        return out
    return record(out, header(40, compress=request.param == "compressed"))


def test_a_trajectory_is_a_sequence_of_frames(path: Path) -> None:
    with Trajectory(path) as trajectory:
        assert len(trajectory) == 5
        assert is_same_frame(trajectory[0], frame(0))
        assert is_same_frame(trajectory[-1], frame(40))
        assert [one.round_index for one in trajectory] == [0, 10, 20, 30, 40]
        assert [one.round_index for one in reversed(trajectory)] == [40, 30, 20, 10, 0]
        for index in (5, -6):
            with pytest.raises(IndexError):
                trajectory[index]


@pytest.mark.parametrize("mode", ["r", "r+"])
@pytest.mark.parametrize("locking", [None, False, True, "best-effort"])
def test_a_file_that_is_open_elsewhere_in_the_process(mode: str, locking: str | bool | None, tmp_path: Path) -> None:
    """It can be read there and here, and outlives being closed here."""
    path = record(tmp_path / "out.h5", header(40))
    with h5py.File(path, mode, locking=locking) as file:
        with Trajectory(path) as trajectory:
            trajectory.verify()
        assert file["particles/trajectory/position/value"].shape == (5, 7, 3)


def test_a_file_that_mdanalysis_has_open(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(40))
    universe = MDAnalysis.Universe(path, format="H5MD", topology_format="MINIMAL", n_atoms=7, to_guess=())
    with Trajectory(path) as trajectory:
        assert len(trajectory) == len(universe.trajectory) == 5
    universe.trajectory.close()


@pytest.mark.parametrize(
    "cut", [slice(None), slice(1, None, 2), slice(None, None, -1), slice(-2, None), slice(3, 1), slice(0, 99)]
)
def test_slices_are_those_of_a_list(path: Path, cut: slice) -> None:
    with Trajectory(path) as trajectory:
        some = trajectory[cut]
        assert [one.round_index for one in some] == [0, 10, 20, 30, 40][cut]
        assert len(some) == len([0, 10, 20, 30, 40][cut])
        assert [one.round_index for one in some[::-1]] == [0, 10, 20, 30, 40][cut][::-1]


def test_what_it_says_besides_its_frames(path: Path) -> None:
    with Trajectory(str(path)) as trajectory:
        assert document(trajectory.header) == document(header(40, compress=trajectory.header.compress))
        assert trajectory.header.bond.tolist() == [[0, 1], [4, 5]]
        assert trajectory.header.bond_table.tolist() == [2, 3]
        assert trajectory.header.groups == header().groups
        assert trajectory.rounds.tolist() == [0, 10, 20, 30, 40]
        assert trajectory.time.tolist() == [i * TIME_STEP for i in (0, 10, 20, 30, 40)]
        assert trajectory.digests == [frame(i).digest for i in (0, 10, 20, 30, 40)]
        assert trajectory.lost_bytes == 0
        assert trajectory.has_journal == trajectory.from_journal == (not path.exists())
        trajectory.verify()


def test_observables_are_arrays_by_name(path: Path) -> None:
    expected = [frame(i).observables for i in (0, 10, 20, 30, 40)]
    with Trajectory(path) as trajectory:
        assert list(trajectory.observables) == list(expected[0].__slots__)
        for name, values in trajectory.observables.items():
            assert np.array_equal(values, [getattr(one, name) for one in expected])


def test_frames_stay_after_the_file_is_closed_and_may_be_changed(path: Path) -> None:
    with Trajectory(path) as trajectory:
        one, again = trajectory[1], trajectory[1]
        one.position[:] = 0
        assert is_same_frame(trajectory[1], again)
    assert is_same_frame(again, frame(10))


def test_the_journal_can_be_named_itself(tmp_path: Path) -> None:
    journal = killed(tmp_path / "out.h5", header(40), stop_after=20)
    with Trajectory(journal) as trajectory:
        assert holds(trajectory, [0, 10, 20])
        assert trajectory.from_journal


def test_a_run_can_be_read_while_it_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    with Recorder.begin(path, header()) as recorder:
        recorder.append(frame(0))
        with Trajectory(path) as trajectory:
            recorder.append(frame(10))
            assert holds(trajectory, [0])


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_for_runs_that_blew_up(tmp_path: Path, value: float) -> None:
    path = tmp_path / "out.h5"
    bad = frame(10)
    bad.velocity[3, 1] = value
    bad = replace(bad, digest=_digest(bad))
    for end in (End("blew up", "atom 3 is gone"), End("finished")):
        with Recorder.begin(path, header(), replace=True) as recorder:
            recorder.append(frame(0))
            recorder.append(bad)
            recorder.finish(end)
        with Trajectory(path) as trajectory:
            assert trajectory.end == end
            if end.kind == "blew up":
                assert is_same_frame(trajectory[1], bad)
                continue
            with pytest.raises(InputError) as caught:
                trajectory.verify()
            assert str(caught.value) == f"{path}: damaged: the state at round 10 is not finite"


def _digest(one: object) -> str:
    from atomsim.core.digest import state_digest

    return state_digest(one.position, one.velocity)


def test_what_cannot_be_a_trajectory(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path, message in {
        tmp_path / "missing.h5": "no such file",
        tmp_path / ("x" * 300): "File name too long",
        tmp_path: "this is a folder, not a trajectory",
        pipe: "this is not a regular file",
    }.items():
        with pytest.raises(InputError) as caught:
            Trajectory(path)
        assert str(caught.value) == f"{path}: {message}"


# --- Closed, pickled, shared ---


def test_a_closed_trajectory_says_so_every_time(path: Path) -> None:
    """Also for the frame that was read last, and for one whose neighbours were."""
    with Trajectory(path) as trajectory:
        middle = trajectory[1:3]
        _ = middle[0], trajectory[-1]
    uses = (
        lambda: middle[0],
        lambda: middle[1],
        lambda: list(middle),
        lambda: trajectory[-1],
        lambda: list(trajectory),
        trajectory.verify,
        trajectory.__enter__,
        lambda: pickle.dumps(trajectory),
    )
    for use in uses:
        with pytest.raises(InputError) as caught:
            use()
        assert str(caught.value) == (f"{path}: this trajectory was closed; use it inside its `with`, or open it again")
    assert (len(middle), trajectory.rounds.tolist()) == (2, [0, 10, 20, 30, 40])  # what was read stays


def test_a_trajectory_may_be_pickled(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also by a relative path, to a process that is in another folder."""
    monkeypatch.chdir(path.parent)
    with Trajectory(path.name) as trajectory:
        text = pickle.dumps((trajectory, trajectory[3:]))
        frames = pickle.loads(pickle.dumps(list(trajectory)))
        twin = copy.copy(trajectory)
    with twin:
        assert holds(twin, [0, 10, 20, 30, 40])
    monkeypatch.chdir("/")
    again, last = pickle.loads(text)
    with again:
        assert holds(again, [0, 10, 20, 30, 40])
        assert is_same_frame(last[0], frame(30))
        assert is_same_frame(frames[3], frame(30))


def test_a_pickle_is_not_opened_as_another_run(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(40))
    with Trajectory(path) as trajectory:
        text = pickle.dumps(trajectory)
    record(path, header(30), replace=True)
    with pytest.raises(InputError, match=r"out\.h5: holds another run than when it was pickled$"):
        pickle.loads(text)
    path.unlink()
    with pytest.raises(InputError, match=r"out\.h5: no such file$"):
        pickle.loads(text)


@pytest.mark.parametrize("compress", [False, True])
def test_many_threads_may_read_one_trajectory(tmp_path: Path, compress: bool) -> None:
    path = record(tmp_path / "out.h5", header(2_000, compress=compress))
    expected = [frame(10 * i) for i in range(201)]
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with Trajectory(path) as trajectory, ThreadPoolExecutor(8) as pool:
            places = [(37 * i) % 201 for i in range(1_000)]
            found = list(pool.map(trajectory.__getitem__, places))
    finally:
        sys.setswitchinterval(interval)
    assert all(is_same_frame(one, expected[place]) for one, place in zip(found, places, strict=True))


def test_closing_while_another_thread_reads(path: Path) -> None:
    """The reader gets its frames or hears that the trajectory was closed, and nothing else."""
    for _ in range(20):
        trajectory = Trajectory(path)
        with ThreadPoolExecutor(2) as pool:
            reading = pool.submit(list, trajectory)
            pool.submit(trajectory.close)
        error = reading.exception()
        assert error is None or "was closed" in str(error)


# --- Other versions ---


@pytest.mark.parametrize(
    ("version", "is_later"),
    [("9.0.0", True), ("0.1.0", False), ("0.0.9", False), ("0.1.1rc1", True), ("?", False), ("9" * 10_000, True)],
)
def test_a_later_version_is_named(tmp_path: Path, version: str, is_later: bool) -> None:
    path = record(tmp_path / "out.h5", replace(header(40), program_version=version))
    with Trajectory(path) as trajectory:
        notices = [str(notice) for notice in trajectory.notices()]
    assert notices == (
        [
            f"{path}: written by atomsim {version}, this is {__version__}: what the two compute may differ, "
            "and what is new in the file is not read"
        ]
        if is_later
        else []
    )
