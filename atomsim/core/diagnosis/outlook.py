"""The outlook of a scene: what each body that moves freely may touch, and what it will touch first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from atomsim.core.diagnosis.flight import Flight, Mover, Path
from atomsim.core.diagnosis.meeting import Meeting, first_meeting
from atomsim.core.diagnosis.numbering import numbered
from atomsim.core.model import Between, CollisionTable, Floats, Indices, Model, State
from atomsim.core.pairs.near import distinct

Mask = NDArray[np.bool_]

CONTACT = 2.0
"""Two unit balls touch at this distance of their centres."""

FARTHEST_ROUND = 1e9
"""No outlook reaches farther than this."""


@dataclass(frozen=True, slots=True, eq=False)
class Outlook:
    """What lies ahead of a body that moves freely.

    Attributes:
        mover: the body.
        partners: the atoms that it may touch, ascending.
        meetings: the first meeting with each kind of partner (what rests, what is moved, another body), the earliest
            first, however late; atoms are those of the model. A body that turns may only seem to meet: it is taken for
            the ball that it fits into.
        horizon: the round up to which was looked.
    """

    mover: Mover
    partners: Indices
    meetings: tuple[Meeting, ...]
    horizon: float

    @property
    def first(self) -> Meeting | None:
        """The earliest meeting."""
        return self.meetings[0] if self.meetings else None


class Surroundings:
    """All that a body can meet, sorted by how it moves.

    Args:
        model: the compiled scene.
        state: where its run begins.
        movers: what moves freely.
        is_held: whether each atom is held, (n_atoms,).
    """

    def __init__(self, model: Model, state: State, movers: Sequence[Mover], is_held: Mask) -> None:
        self._time_step = model.time_step
        self._state = state
        self._movers = movers
        self._is_held = is_held
        self._mover = np.full(model.n_atoms, -1)
        for number, mover in enumerate(movers):
            self._mover[mover.atoms] = number
        self.position = np.ascontiguousarray(state.position.T)
        self._stops: dict[int, float] = {}

    def mover_of(self, atom: int) -> Mover | None:
        """Return the mover that an atom is of, if it is of any."""
        number = int(self._mover[atom])
        return self._movers[number] if number >= 0 else None

    def resting(self, atoms: Indices) -> Indices:
        """Return those of some atoms that are of no mover, or of one that nothing moves."""
        is_still = np.array([not mover.flight.drives and not mover.flight.velocity.any() for mover in self._movers])
        is_resting = np.append(is_still, True)[self._mover[atoms]]  # the last one is for what is of no mover
        return np.asarray(atoms[is_resting])

    def stop(self, mover: Mover, round_index: float) -> None:
        """Let a mover be at rest from a round on, for all that meet it later."""
        self._stops[int(mover.atoms[0])] = round_index

    def meetings(self, mover: Mover, partners: Indices, near: float, last: float) -> list[Meeting]:
        """Return the first meeting of a mover with each kind of partner, the earliest first."""
        found = (self._meeting(mover, atoms, path, near, last) for atoms, path in self._kinds(mover, partners))
        return sorted((meeting for meeting in found if meeting is not None), key=lambda each: each.round_index)

    def meets(self, mover: Mover, flight: Flight, partners: Indices) -> bool:
        """Return whether a mover would ever touch some atoms on another flight."""
        other = replace(mover, flight=flight)
        return bool(self.meetings(other, partners, CONTACT, _horizon(self.position, other, partners, 1)))

    def alike(self, partners: Indices, atom: int) -> Indices:
        """Return those of some atoms that move as one of them does, when no mover of them turns."""
        velocity = self._state.velocity
        is_alike: Mask = (velocity[partners] == velocity[atom]).all(axis=1)
        is_alike &= self._mover[partners] == self._mover[atom]
        is_alike &= self._is_held[partners] == self._is_held[atom]
        return partners[is_alike]

    def _kinds(self, mover: Mover, partners: Indices) -> Iterator[tuple[Indices, Path]]:
        """Yield partners that move alike, with the path of the mover as they see it."""
        for number in distinct([self._mover[partners]]).tolist():
            atoms = partners[self._mover[partners] == number]
            if number >= 0:
                other = self._movers[number]
                if number != self._mover[mover.atoms[0]]:
                    stopped = self._stops.get(int(other.atoms[0]), math.inf)
                    yield atoms, mover.flight.minus(other.flight, stopped)
                continue
            velocity = np.where(self._is_held[atoms, None], self._state.velocity[atoms], 0.0)
            number = numbered(*velocity.T)
            for each in range(int(number.max(initial=-1)) + 1):
                alike = number == each
                drift = Flight(self._time_step, velocity[alike.argmax()], 0.0, ())
                yield atoms[alike], mover.flight.minus(drift)

    def _meeting(self, mover: Mover, atoms: Indices, path: Path, near: float, last: float) -> Meeting | None:
        """Return the first meeting with atoms that move alike; what turns is taken for a ball."""
        own, met = mover.atoms, atoms
        moving, resting = self.position[:, own], self.position[:, met]
        other = self.mover_of(int(atoms[0]))
        if mover.is_turning:
            moving, near = moving.mean(axis=1, keepdims=True), near + mover.radius
        if other is not None and other.is_turning:
            resting, near = self.position[:, other.atoms].mean(axis=1, keepdims=True), near + other.radius
        meeting = first_meeting(path, moving, resting, near, last)
        if meeting is None:
            return None
        one = int(own[0]) if mover.is_turning else int(own[meeting.one])
        partner = int(met[0]) if other is not None and other.is_turning else int(met[meeting.other])
        return replace(meeting, one=one, other=partner)


def outlooks(model: Model, surroundings: Surroundings, movers: Sequence[Mover], rounds: int) -> list[Outlook]:
    """Return what lies ahead of each mover, however far.

    What meets something that does not move freely is taken to rest there, where others may then land on it.

    Args:
        model: the compiled scene.
        surroundings: all that can be met.
        movers: the bodies.
        rounds: iteration rounds of the run; the outlook reaches farther.
    """
    partners = [may_touch(model.collisions, mover.atoms, model.n_atoms) for mover in movers]
    horizons = [
        _horizon(surroundings.position, mover, atoms, rounds) if atoms.size else float(rounds)
        for mover, atoms in zip(movers, partners, strict=True)
    ]
    for mover, atoms, horizon in zip(movers, partners, horizons, strict=True):
        landed = surroundings.meetings(mover, surroundings.resting(atoms), CONTACT, horizon)
        if landed:
            surroundings.stop(mover, landed[0].round_index)
    return [
        Outlook(mover, atoms, tuple(surroundings.meetings(mover, atoms, CONTACT, horizon)), horizon)
        for mover, atoms, horizon in zip(movers, partners, horizons, strict=True)
    ]


def may_touch(tables: Sequence[CollisionTable], atoms: Indices, n_atoms: int) -> Indices:
    """Return the atoms outside a body that some atom of it may collide with, ascending."""
    is_own, is_partner = np.zeros((2, n_atoms), dtype=bool)
    is_own[atoms] = True
    for table in tables:
        for block in table.blocks:
            sides = (block.left, block.right) if isinstance(block, Between) else (block.atoms, block.atoms)
            for side, other in (sides, sides[::-1]):
                if is_own[side].any():
                    is_partner[other] = True
    return np.flatnonzero(is_partner & ~is_own)


def _horizon(position: Floats, mover: Mover, partners: Indices, rounds: int) -> float:
    """Return a round by which a mover that falls has left all partners behind; at least that of the run's end."""
    direction = mover.flight.lasting
    length = float(np.sqrt(direction @ direction))
    if length == 0.0:
        direction = mover.flight.at(float(rounds))[1]
        length = float(np.sqrt(direction @ direction))
        if length == 0.0:
            return float(rounds)
    direction = direction / length
    goal = float((direction @ position[:, partners]).max() - (direction @ position[:, mover.atoms]).min()) + 4.0
    horizon = float(rounds)
    while horizon < FARTHEST_ROUND:
        if float(direction @ mover.flight.at(horizon)[0]) > goal + 2.0 * mover.radius:
            break
        horizon *= 2.0
    return min(horizon, FARTHEST_ROUND) if math.isfinite(goal) else float(rounds)
