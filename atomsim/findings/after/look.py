"""A look at one recorded frame, and what the watches that diagnose a run have in common."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol, TypeAlias

import numpy as np

from atomsim.core.model import Floats, Frame, Indices
from atomsim.core.pairs.near import near_pairs, pair_squares
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Mask, Subject
from atomsim.trajectory.header import End

NEAR = 1.5
"""Pairs nearer than this are looked at [length]: a quarter of the contact distance inside, so that grazes are not."""


class Near(NamedTuple):
    """Pairs of atoms that are near each other, with their distances.

    Attributes:
        first: lower atom of each pair, (n_pairs,) int64.
        second: higher atom, (n_pairs,) int64.
        distance: [length], (n_pairs,) float64.
    """

    first: Indices
    second: Indices
    distance: Floats

    def only(self, chosen: Mask) -> Near:
        """Return some of the pairs."""
        return Near(self.first[chosen], self.second[chosen], self.distance[chosen])


@dataclass(frozen=True)
class Look:
    """A frame, and the one before it.

    Attributes:
        subject: the scene that was run.
        frame: the frame.
        before: the frame before it; None for the first.
    """

    subject: Subject
    frame: Frame
    before: Frame | None

    @cached_property
    def position(self) -> Floats:
        """Atom centres [length], (3, n_atoms)."""
        return np.ascontiguousarray(self.frame.position.T)

    @cached_property
    def near(self) -> Near:
        """All pairs nearer than `NEAR`."""
        first, second = near_pairs(self.position, None, NEAR)
        return Near(first, second, np.sqrt(pair_squares(self.position, first, second)))

    @cached_property
    def way(self) -> Floats:
        """How far each atom is from where it started [length], (n_atoms,)."""
        return np.asarray(np.sqrt(np.square(self.frame.position - self.subject.state.position).sum(axis=1)))


@dataclass(frozen=True, slots=True)
class Run:
    """What is known of a run besides its frames.

    Attributes:
        rounds: the round that was to be reached.
        record_every: rounds between two frames.
        last_round: the round of its last frame.
        end: how it ended.
    """

    rounds: int
    record_every: int
    last_round: int
    end: End


class Watch(Protocol):
    """What looks for one kind of finding, or several: it sees every frame in order, then says what it saw."""

    def see(self, look: Look) -> None:
        """Look at a frame."""

    def diagnoses(self) -> Mapping[str, Callable[[], Iterator[Symptom]]]:
        """Return what yields, after the last frame, what was seen of each kind."""


MakeWatch: TypeAlias = Callable[[Subject, Run], Watch]
