"""Frames side by side, as gauges read them, and how sums over their atoms are taken."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Protocol, TypeAlias

import numpy as np

from atomsim.core.model import Floats, Frame, Indices, Observables, State

BLOCK_BYTES = 1 << 20
"""About so much of positions is worked on at a time: what the cache of one core holds."""

MOST_FRAMES = 512
"""More frames at a time make nothing faster."""

PAIRS_AT_A_TIME = 1 << 14
"""Pairs of atoms, times frames, that are looked at together: what is known of them should stay in the cache."""

Atoms: TypeAlias = slice | Indices
"""Ascending numbers of atoms; a slice where they are consecutive, for reading a slice copies nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Some frames, or a single state: what a gauge reads.

    Frames come last, so that what is summed over atoms in order is computed for all frames at once.

    Attributes:
        position: atom centres [length], (3, n_atoms, n_frames) float64.
        velocity: [length per unit of time], (3, n_atoms, n_frames) float64.
        observables: what was measured when the frames were computed, by name, (n_frames,) or (n_frames, 3); empty for
            a state of which nothing was.
    """

    position: Floats
    velocity: Floats
    observables: Mapping[str, Floats]

    @classmethod
    def of_states(cls, states: Sequence[State], observables: Mapping[str, Floats] | None = None) -> Block:
        """Return a block of states, at least one."""
        position, velocity = (
            np.ascontiguousarray(np.stack(arrays).transpose(2, 1, 0))
            for arrays in ([state.position for state in states], [state.velocity for state in states])
        )
        return cls(position, velocity, observables or {})

    @classmethod
    def of_frame(cls, frame: Frame) -> Block:
        """Return a block of one frame."""
        observed = {field.name: getattr(frame.observables, field.name) for field in fields(Observables)}
        return cls.of_states([frame.state], {name: np.array([value], float) for name, value in observed.items()})

    @property
    def n_frames(self) -> int:
        """How many frames there are."""
        return int(self.position.shape[2])


class Gauge(Protocol):
    """A measure of a model's atoms, ready to be taken.

    What it tells of a state may depend on the states before, as turns that are counted do: that is its memory, which
    is handed in, so that a gauge itself never changes. Each value of a frame is the same to the last bit whether the
    frame is measured alone or in a block, and on every machine.
    """

    @property
    def n_columns(self) -> int:
        """How many numbers it gives of a frame."""

    def begin(self) -> Floats:
        """Return the memory before the first frame, empty for a gauge without one."""

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the values, (n_columns, n_frames) float64, and bring the memory up to the last frame."""


class Memoryless:
    """What most gauges are: a state tells all of it."""

    __slots__ = ()

    def begin(self) -> Floats:
        """Return an empty memory."""
        return np.empty(0)


def frames_at_a_time(n_atoms: int) -> int:
    """Return how many frames make a block that fits into the cache."""
    return min(max(1, BLOCK_BYTES // (24 * n_atoms)), MOST_FRAMES)


def ordered_sum(values: Floats) -> Floats:
    """Return the sum over atoms in ascending order: (…, n_atoms, n_frames) becomes (…, n_frames).

    NumPy's own sum goes pairwise where a single frame makes the atoms the last axis that is not of length one.
    """
    if values.shape[-1] == 1:
        return np.asarray(np.add.accumulate(values, axis=-2)[..., -1, :])
    return np.asarray(np.add.reduce(values, axis=-2))


def length(vectors: Floats) -> Floats:
    """Return |v| = √((x·x + y·y) + z·z) of vectors (3, …)."""
    return np.asarray(np.sqrt(dot(vectors, vectors)))


def dot(one: Floats, other: Floats) -> Floats:
    """Return (x·x' + y·y') + z·z' of vectors (3, …)."""
    return np.asarray((one[0] * other[0] + one[1] * other[1]) + one[2] * other[2])


def cross(one: Floats, other: Floats) -> Floats:
    """Return the cross product of vectors (3, …)."""
    return np.stack(
        [
            one[1] * other[2] - one[2] * other[1],
            one[2] * other[0] - one[0] * other[2],
            one[0] * other[1] - one[1] * other[0],
        ]
    )


def one_row(values: Floats) -> Floats:
    """Return one number a frame, (n_frames,), as the only column of a gauge."""
    return np.asarray(values).reshape(1, -1)
