"""A run made by hand: its header, its frames and how it is recorded; simulates nothing."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from atomsim.core.digest import state_digest
from atomsim.core.model import BondTable, Frame, GroupSpan, Model, Observables, Origin, State
from atomsim.trajectory import End, Header, Recorder, StoppedRun, Trajectory, journal_path

TIME_STEP = 0.1
SCENE = "atomsim: 1\ntitle: Two rods · τ\n\n"


def model(n_atoms: int = 7) -> Model:
    """Return two groups and one bond in each."""
    half = n_atoms // 2 + 1
    left = GroupSpan("left", 0, half, Origin("groups", "left", "rods.yaml", 5))
    right = GroupSpan("right", half, n_atoms, Origin("groups", "right", "rods.yaml", 9))
    bonds = tuple(
        BondTable(Origin("bonds", name, "rods.yaml", line), np.array([i]), np.array([i + 1]), np.array([1.0]))
        for name, line, i in (("left", 13, 0), ("right", 17, half))
    )
    return Model("Two rods · τ", TIME_STEP, n_atoms, (left, right), bonds, (), ())


def header(rounds: int = 40, *, n_atoms: int = 7, record_every: int = 10, compress: bool = False) -> Header:
    """Return the header of a run of `model`."""
    return Header.of(
        model(n_atoms),
        group_color=("#4682b4", "#b22222"),
        scene_text=SCENE,
        scene_name="rods.yaml",
        overrides=("rounds=40",),
        rounds=rounds,
        record_every=record_every,
        compress=compress,
    )


def frame(round_index: int, n_atoms: int = 7) -> Frame:
    """Return the frame of a round: numbers at random, but always the same."""
    random = np.random.default_rng(round_index)
    position, velocity = random.normal(size=(2, n_atoms, 3))
    observables = Observables(*random.normal(size=3).tolist(), *random.normal(size=(2, 3)), round_index % 5)
    digest = state_digest(position, velocity)
    return Frame(State(round_index, position, velocity), round_index * TIME_STEP, digest, observables)


def go_on(recorder: Recorder, *, stop_after: int | None = None, finish: bool = True) -> None:
    """Do what a run does with a recorder, from where it stands up to the rounds planned or `stop_after`."""
    first = 0 if recorder.state is None else recorder.state.round_index + 1
    last = recorder.header.rounds if stop_after is None else stop_after
    for round_index in range(first, last + 1):
        if recorder.header.records(round_index):
            recorder.append(frame(round_index, recorder.header.n_atoms))
    if finish:
        recorder.finish(End("finished"))


def resume(path: Path, *, rounds: int | None = None) -> Recorder:
    """Go on with a run that was stopped, without a look at it before."""
    with StoppedRun(path, rounds) as stopped:
        return stopped.go_on()


def record(path: Path, run: Header, *, replace: bool = False) -> Path:
    """Record a whole run."""
    with Recorder.begin(path, run, replace=replace) as recorder:
        go_on(recorder)
    return path


def killed(path: Path, run: Header, stop_after: int) -> Path:
    """Leave the journal of a run that was stopped."""
    with Recorder.begin(path, run) as recorder:
        go_on(recorder, stop_after=stop_after, finish=False)
    return journal_path(path)


def digest_of(path: Path) -> str:
    """Return the digest of a file's bytes."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def is_same_frame(one: Frame, other: Frame) -> bool:
    """Compare two frames to the last bit."""
    return _bits(one) == _bits(other)


def is_same_state(one: State | None, other: Frame) -> bool:
    """Compare a state with that of a frame, to the last bit."""
    return one is not None and one.round_index == other.round_index and _atoms(one) == _atoms(other)


def holds(trajectory: Trajectory, rounds: list[int]) -> bool:
    """Tell whether a trajectory has exactly the frames of these rounds."""
    n_atoms = trajectory.header.n_atoms
    return trajectory.rounds.tolist() == rounds and all(
        is_same_frame(found, frame(i, n_atoms)) for found, i in zip(trajectory, rounds, strict=True)
    )


def _atoms(state: State | Frame) -> bytes:
    return state.position.tobytes() + state.velocity.tobytes()


def _bits(one: Frame) -> tuple[object, ...]:
    seen = one.observables
    return (
        one.round_index,
        one.time,
        one.digest,
        _atoms(one),
        seen.kinetic_energy,
        seen.potential_energy_bonds,
        seen.potential_energy_collisions,
        seen.momentum.tobytes(),
        seen.angular_momentum.tobytes(),
        seen.contacts,
    )
