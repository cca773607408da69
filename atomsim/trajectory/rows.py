"""A frame as one row of a fixed number of bytes, little-endian, and back."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.digest import state_digest
from atomsim.core.memory import EMPTY, Layout, Memory
from atomsim.core.model import Floats, Frame, Observables, State
from atomsim.trajectory.guard import DamageError

_COLUMNS: Mapping[str, tuple[tuple[int, ...], Callable[[Any], Any]]] = {
    "float": ((), float),
    "int": ((), int),
    "Floats": ((3,), np.copy),
}
"""The shape of an observable of each type in a file, where all are float64, and how it is read again."""

OBSERVABLES: Mapping[str, Callable[[Any], Any]] = {
    field.name: _COLUMNS[str(field.type)][1] for field in dataclasses.fields(Observables)
}
"""The observables by name, in the order of `Observables`, each with what reads it."""

SERIES = np.dtype(
    [
        ("round", "<i8"),
        ("digest", "S64"),
        *((field.name, "<f8", _COLUMNS[str(field.type)][0]) for field in dataclasses.fields(Observables)),
    ]
)
"""What is known of a frame besides its atoms."""

_FILE_BYTES_PER_FRAME = 104
"""About what a frame takes in a finished file besides its row."""

Series: TypeAlias = NDArray[np.void]
"""An array of dtype `SERIES`, (n_frames,)."""
Rows: TypeAlias = NDArray[np.void]
"""An array of dtype `row_dtype(…)`, (n_frames,)."""


def row_dtype(n_atoms: int, layout: Layout = ()) -> np.dtype[np.void]:
    """Return the layout of one frame: its series, then positions, then velocities, then what is remembered, if any."""
    parts: list[Any] = [("series", SERIES), ("position", "<f8", (n_atoms, 3)), ("velocity", "<f8", (n_atoms, 3))]
    memory = [(array.name, array.dtype, array.shape) for array in layout]
    return np.dtype([*parts, ("memory", memory)] if memory else parts)


def count_frames(rounds: int, record_every: int) -> int:
    """Return how many frames a run keeps that nothing stops: the first, those `record_every` rounds apart, the last."""
    return (rounds - 1) // record_every + 2


def trajectory_bytes(n_atoms: int, rounds: int, record_every: int, layout: Layout = ()) -> int:
    """Return about how large the trajectory of a run becomes, without compression."""
    return count_frames(rounds, record_every) * (row_dtype(n_atoms, layout).itemsize + _FILE_BYTES_PER_FRAME)


def fill(row: Any, frame: Frame) -> None:
    """Copy a frame into a row.

    Raises:
        ValueError: the frame has another number of atoms or another memory.
    """
    if not frame.position.shape == frame.velocity.shape == row["position"].shape:
        raise ValueError(f"a frame of shape {frame.position.shape} in a trajectory of {row['position'].shape}")
    row["series"] = (frame.round_index, frame.digest, *(getattr(frame.observables, name) for name in OBSERVABLES))
    row["position"] = frame.position
    row["velocity"] = frame.velocity
    if memory_of(row).layout != frame.memory.layout:
        raise ValueError(f"a frame that remembers {frame.memory.layout} in a trajectory of {row.dtype}")
    for name, array in frame.memory.items():
        row["memory"][name] = array


def memory_of(row: Any) -> Memory:
    """Return what a row remembers."""
    if "memory" not in row.dtype.names:
        return EMPTY
    memory = row["memory"]
    return Memory({name: memory[name] for name in memory.dtype.names})


def state_of(series: Any, position: Floats, velocity: Floats, memory: Memory = EMPTY) -> State:
    """Return the state of a frame, after checking that it is what was once written.

    Args:
        series: one element of an array of dtype `SERIES`.
        position: atom centres [length], (n_atoms, 3) float64; becomes the state's.
        velocity: [length per unit of time], (n_atoms, 3) float64; becomes the state's.
        memory: what else was remembered.

    Raises:
        DamageError: they do not have the digest in the series.
    """
    state = State(int(series["round"]), position, velocity, memory)
    if series["digest"] != state_digest(position, velocity, memory).encode():
        raise DamageError(f"damaged: the state at round {state.round_index} does not match its digest")
    return state


def recorded_frame(series: Any, state: State, time_step: float) -> Frame:
    """Return the frame of a state.

    Args:
        series: one element of an array of dtype `SERIES`.
        state: what `state_of` returned for it.
        time_step: τ [time].
    """
    return Frame(
        state=state,
        time=state.round_index * time_step,
        digest=series["digest"].decode(),
        observables=Observables(**{name: read(series[name]) for name, read in OBSERVABLES.items()}),
    )


def check_rounds(series: Series) -> None:
    """Refuse frames that do not follow each other in time.

    Raises:
        DamageError: a round is negative, or not later than the one before.
    """
    rounds = series["round"]
    if np.any(rounds[:1] < 0) or np.any(rounds[1:] <= rounds[:-1]):
        raise DamageError("damaged: the rounds of its frames do not increase")
