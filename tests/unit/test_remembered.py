"""What a run remembers goes all the way: model, stepper, frame, digest, journal, file, resume, comparison."""

from __future__ import annotations

import copy
import hashlib
import pickle
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from support.remembering import LAYOUT, RememberingStepper, remembering

from atomsim.core.digest import state_digest
from atomsim.core.memory import EMPTY, Memory, MemoryArray
from atomsim.core.model import Frame, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.simulate import simulate
from atomsim.errors import InputError
from atomsim.tasks.compare import first_difference
from atomsim.tasks.golden import check_golden, record_golden
from atomsim.trajectory import End, Header, Recorder, StoppedRun, Trajectory, journal_path
from atomsim.trajectory.rows import row_dtype

PHASE, RANDOM, BROKEN = (array.name for array in LAYOUT)
ROUNDS = 12


def frames(rounds: int = ROUNDS, state: State | None = None, record_every: int = 5) -> list[Frame]:
    """Compute the toy, from its beginning or from a state."""
    model, first = remembering()
    return list(simulate(model, state or first, rounds, record_every, RememberingStepper))


def header(rounds: int = ROUNDS, *, compress: bool = False) -> Header:
    model, _ = remembering()
    return Header.of(
        model,
        group_color=["#000000"] * len(model.groups),
        scene_text="-",
        scene_name="-",
        rounds=rounds,
        record_every=5,
        compress=compress,
    )


def recorded(path: Path, run: Header, *, stop_after: int | None = None) -> Path:
    """Record the toy; leave a journal if it stops early."""
    with Recorder.begin(path, run) as recorder:
        for frame in frames(run.rounds):
            if stop_after is None or frame.round_index <= stop_after:
                recorder.append(frame)
        if stop_after is None:
            recorder.finish(End("finished"))
    return path


def content(memory: Memory) -> dict[str, tuple[str, list[float]]]:
    return {name: (array.dtype.name, array.tolist()) for name, array in memory.items()}


def test_memories_are_copies_that_nobody_can_change() -> None:
    array = np.zeros(2)
    memory = Memory({"a": array})
    array[0] = 1.0
    assert memory["a"].tolist() == [0, 0]
    with pytest.raises(ValueError, match="read-only"):
        memory["a"][0] = 1.0
    assert memory.layout == (MemoryArray("a", "float64", (2,)),)
    assert not EMPTY
    assert EMPTY.layout == ()


def test_states_that_remember_can_be_copied_and_sent_to_other_processes() -> None:
    _, state = remembering()
    for twin in (copy.deepcopy(state), pickle.loads(pickle.dumps(state))):
        assert content(twin.memory) == content(state.memory)
        assert twin.memory.layout == LAYOUT


def test_frames_hold_what_was_remembered_at_their_round() -> None:
    at = {frame.round_index: frame.memory for frame in frames()}
    assert content(at[0]) == {PHASE: ("float64", [0, 0]), RANDOM: ("int64", 2**60), BROKEN: ("bool", [False] * 3)}
    assert at[5][RANDOM] == 2**60 + 5
    assert at[5][BROKEN].tolist() == [False, True, False]
    assert at[12][BROKEN].tolist() == [False, True, True]


def test_both_backends_carry_what_they_do_not_change() -> None:
    model, state = remembering()
    steppers = [NumpyStepper(model, state)]
    try:
        from atomsim.core.numba_backend.stepper import NumbaStepper
    except ImportError:  # the backend is an extra
        pass
    else:
        steppers.append(NumbaStepper(model, state))  # type: ignore[arg-type]
    for stepper in steppers:
        stepper.advance(3)
        assert content(stepper.state().memory) == content(state.memory)


def test_the_digest_covers_the_memory_after_the_atoms_and_knows_no_sign_of_zero() -> None:
    numbers = np.arange(6.0).reshape(2, 1, 3)
    memory = Memory({"a": np.array([-0.0, 0.5]), "b": np.array(7), "c": np.array([True])})
    data = numbers.tobytes() + np.array([0.0, 0.5]).tobytes() + (7).to_bytes(8, "little") + b"\x01"
    assert state_digest(*numbers, memory) == hashlib.sha256(data).hexdigest()
    assert state_digest(*numbers, EMPTY) == hashlib.sha256(numbers.tobytes()).hexdigest()


@pytest.mark.parametrize("compress", [False, True])
def test_a_file_gives_the_frames_back(tmp_path: Path, compress: bool) -> None:
    path = recorded(tmp_path / "out.h5", header(compress=compress))
    with Trajectory(path) as trajectory:
        assert trajectory.header.layout == LAYOUT
        assert [content(frame.memory) for frame in trajectory] == [content(frame.memory) for frame in frames()]
        assert trajectory.digests == [frame.digest for frame in frames()]


def test_other_programs_find_it_as_one_series_per_array(tmp_path: Path) -> None:
    with h5py.File(recorded(tmp_path / "out.h5", header())) as file:
        values = file["parameters/atomsim/memory_value"]
        assert values[PHASE].shape == (4, 2)
        assert values[RANDOM][:].tolist() == [2**60, 2**60 + 5, 2**60 + 10, 2**60 + 12]
        assert values[BROKEN].dtype == bool
        assert [text.decode() for text in file["parameters/atomsim/memory"]] == [
            "controllers.gait.phase float64 2",
            "controllers.gait.random int64",
            "bonds.cup.broken bool 3",
        ]


def test_a_run_that_stopped_goes_on_with_what_it_remembered_to_the_same_bytes(tmp_path: Path) -> None:
    whole = recorded(tmp_path / "whole.h5", header())
    path = recorded(tmp_path / "out.h5", header(), stop_after=5)
    assert journal_path(path).exists()
    with StoppedRun(path) as stopped, stopped.go_on() as recorder:
        assert recorder.state is not None
        assert recorder.state.memory[RANDOM] == 2**60 + 5
        for frame in frames(state=recorder.state)[1:]:
            recorder.append(frame)
        recorder.finish(End("finished"))
    assert path.read_bytes() == whole.read_bytes()


def test_a_finished_run_can_be_extended(tmp_path: Path) -> None:
    whole = recorded(tmp_path / "whole.h5", header(20))
    path = recorded(tmp_path / "out.h5", header())
    with StoppedRun(path, 20) as stopped, stopped.go_on() as recorder:
        for frame in frames(20, recorder.state)[1:]:
            recorder.append(frame)
        recorder.finish(End("finished"))
    assert path.read_bytes() == whole.read_bytes()


def test_rows_have_a_constant_length_and_without_memory_that_of_the_atoms() -> None:
    assert row_dtype(2, LAYOUT).itemsize == row_dtype(2).itemsize + 2 * 8 + 8 + 3
    assert row_dtype(2, ()) == row_dtype(2)


@pytest.mark.parametrize("memory", [EMPTY, Memory({PHASE: np.zeros(2)}), Memory({"x": np.zeros(2)})])
def test_a_frame_that_remembers_something_else_is_no_frame_of_the_trajectory(tmp_path: Path, memory: Memory) -> None:
    first = frames()[0]
    with Recorder.begin(tmp_path / "out.h5", header()) as recorder:
        with pytest.raises(ValueError, match="a frame that remembers"):
            recorder.append(replace(first, state=replace(first.state, memory=memory)))
        recorder.append(first)


def test_a_changed_memory_is_found_by_its_digest(tmp_path: Path) -> None:
    path = recorded(tmp_path / "out.h5", header())
    with h5py.File(path, "r+") as file:
        file[f"parameters/atomsim/memory_value/{BROKEN}"][1, 0] = True
    with Trajectory(path) as trajectory, pytest.raises(InputError, match="state at round 5 does not match its digest"):
        trajectory.verify()


@pytest.mark.parametrize(
    "texts",
    [
        [],
        ["a float64 2", "a int64"],
        ["a float32 2"],
        ["a float64 -2"],
        ["../a float64"],
        ["a/b float64"],
        ["a float64 9999999999 9999999999"],
        ["a float64 9999999999"],
        ["a float64 2\n"],
        [""],
    ],
)
def test_a_memory_that_makes_no_sense_is_refused(texts: list[str]) -> None:
    from atomsim.trajectory.guard import DamageError
    from atomsim.trajectory.header import document, header_from

    run = header()
    values = {**document(run), "memory": texts}
    with pytest.raises(DamageError, match="`memory` makes no sense"):
        header_from(values, run.bond, run.bond_table)


@pytest.mark.parametrize("path", ["memory", f"memory_value/{PHASE}"])
def test_a_file_without_what_it_claims_to_remember_is_refused(tmp_path: Path, path: str) -> None:
    out = recorded(tmp_path / "out.h5", header())
    with h5py.File(out, "r+") as file:
        del file[f"parameters/atomsim/{path}"]
    with pytest.raises(InputError, match=f"`parameters/atomsim/{path}` is missing"):
        Trajectory(out)


def differing(name: str, number: object) -> Frame:
    """Return the last frame of the toy with another array in its memory."""
    *_, last = frames()
    memory = Memory({**last.memory, name: np.asarray(number)})
    return replace(last, state=replace(last.state, memory=memory), digest="another")


def test_where_only_what_is_remembered_differs_it_is_named() -> None:
    *_, last = frames()
    for name, number, tolerance, said in (
        (RANDOM, 2**60 + 13, 0.0, f"`{RANDOM}`"),
        (RANDOM, 2**60 + 13, 9.0, f"`{RANDOM}`"),
        (RANDOM, float(2**60 + 12), 0.0, f"`{RANDOM}`"),
        (PHASE, last.memory[PHASE] + 1e-3, 0.0, f"`{PHASE}`"),
        (PHASE, last.memory[PHASE] + 1e-3, 0.01, None),
        (PHASE, np.zeros(3), 0.0, f"`{PHASE}`"),
        (BROKEN, [True, True, True], 1.0, f"`{BROKEN}`"),
        ("bonds.new", [True], 1.0, "`bonds.new`"),
    ):
        found = first_difference([last], [differing(name, number)], (), tolerance)
        assert (found and found.message) == (said and f"round 12: what is remembered as {said} differs")


def test_a_golden_notices_what_is_remembered() -> None:
    approved = record_golden(frames())
    assert check_golden(approved, frames(), ()) is None
    changed = [*frames()[:-1], differing(RANDOM, 0)]
    assert check_golden(approved, changed, ()) == (
        "differs from round 12 on; round 12: positions and velocities agree, what else is remembered does not"
    )
