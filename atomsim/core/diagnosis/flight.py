"""Flights: how bodies that nothing holds move until they touch something, in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from atomsim.core.diagnosis.numbering import numbered
from atomsim.core.model import (
    DampingForce,
    ExternalForce,
    Floats,
    Indices,
    Model,
    OscillateForce,
    PushForce,
    State,
    TorqueForce,
    TowardsForce,
)

MOST_MOVERS = 200
"""So many bodies, or swarms of loose atoms that move alike, are followed; in scenes with more, none is."""


@dataclass(frozen=True, slots=True, eq=False)
class Drive:
    """A constant impulse while from_round ≤ round < until_round (infinite: for ever).

    Attributes:
        force: the force that it is of.
        impulse: of the centroid, per round [velocity], (3,).
        from_round: the first round of it.
        until_round: the first round without it.
    """

    force: PushForce
    impulse: Floats
    from_round: float
    until_round: float


@dataclass(frozen=True, slots=True, eq=False)
class Flight:
    """The way of a centroid under v ← (1 − m)·v + g, c ← c + τ·v, with g constant between the ends of pushes.

    Attributes:
        time_step: τ [time].
        velocity: of the centroid at the start [length per unit of time], (3,).
        damping: m, the mean of what acts on the atoms.
        drives: what pushes.
    """

    time_step: float
    velocity: Floats
    damping: float
    drives: tuple[Drive, ...]

    @property
    def bends(self) -> tuple[float, ...]:
        """The rounds in which a push begins or ends, ascending, 0 first."""
        ends = {0.0, *(drive.from_round for drive in self.drives), *(drive.until_round for drive in self.drives)}
        return tuple(sorted(end for end in ends if math.isfinite(end)))

    @property
    def lasting(self) -> Floats:
        """The impulse per round of all pushes that never end, (3,)."""
        lasting = [drive.impulse for drive in self.drives if math.isinf(drive.until_round)]
        return np.sum(lasting, axis=0) if lasting else np.zeros(3)

    def impulse(self, round_index: float) -> Floats:
        """Return g at a round, (3,)."""
        total = np.zeros(3)
        for drive in self.drives:
            if drive.from_round <= round_index < drive.until_round:
                total += drive.impulse
        return total

    def at(self, round_index: float) -> tuple[Floats, Floats]:
        """Return the way of the centroid from the start [length] and its velocity at a round, (3,) each.

        With a = 1 − m, after k rounds of constant g: v = aᵏ·v₀ + g·(1 − aᵏ)/m, and the way is τ times the sum of these.
        """
        way, velocity = np.zeros(3), self.velocity
        bends = self.bends
        for begin, end in zip(bends, (*bends[1:], math.inf), strict=True):
            if round_index <= begin:
                break
            n_rounds = min(round_index, end) - begin
            step, velocity = self._glide(velocity, self.impulse(begin), n_rounds)
            way = way + step
        return way, velocity

    def _glide(self, velocity: Floats, impulse: Floats, n_rounds: float) -> tuple[Floats, Floats]:
        """Return the way and the velocity after some rounds of constant g."""
        m = self.damping
        if m * n_rounds < 1e-6:  # nothing is lost yet, and the other form would cancel
            way = n_rounds * velocity + 0.5 * n_rounds * (n_rounds + 1.0) * impulse
            return self.time_step * way, velocity + n_rounds * impulse
        lost = 1.0 if m >= 1.0 else -math.expm1(n_rounds * math.log1p(-m))
        slide = (1.0 - m) * lost / m
        way = slide * velocity + (n_rounds - slide) / m * impulse
        return self.time_step * way, (1.0 - lost) * velocity + lost / m * impulse

    def minus(self, other: Flight, stopped: float = math.inf) -> _Relative:
        """Return this flight as another body sees it, which comes to rest in the round `stopped`."""
        return _Relative(self, other, stopped)

    def without_damping(self) -> Flight:
        """Return the same flight in a world without resistance."""
        return replace(self, damping=0.0)

    def with_drives(self, drives: Sequence[Drive]) -> Flight:
        """Return the flight that other pushes would give."""
        return replace(self, drives=tuple(drives))


@dataclass(frozen=True, slots=True, eq=False)
class _Relative:
    """The flight of one body as another one sees it."""

    own: Flight
    other: Flight
    stopped: float

    @property
    def time_step(self) -> float:
        """τ [time]."""
        return self.own.time_step

    @property
    def bends(self) -> tuple[float, ...]:
        """The rounds in which a push of either begins or ends, or the other one comes to rest."""
        rest = {self.stopped} if math.isfinite(self.stopped) else set()
        return tuple(sorted({*self.own.bends, *self.other.bends, *rest}))

    def at(self, round_index: float) -> tuple[Floats, Floats]:
        """Return the relative way and velocity at a round."""
        way, velocity = self.own.at(round_index)
        other_way, other_velocity = self.other.at(min(round_index, self.stopped))
        return way - other_way, velocity - (other_velocity if round_index < self.stopped else 0.0)


Path = Flight | _Relative


@dataclass(frozen=True, slots=True, eq=False)
class Mover:
    """Atoms that move alike until they touch something: a free body, or loose atoms of one group.

    Attributes:
        atoms: ascending.
        flight: of their centroid.
        is_turning: whether they may turn or change shape on the way, so that only their extent counts.
        is_loose: whether they are not bound to each other.
        radius: the largest distance of an atom from the centroid at the start [length].
    """

    atoms: Indices
    flight: Flight
    is_turning: bool
    is_loose: bool
    radius: float


class TooManyMoversError(Exception):
    """More bodies move on their own than are followed."""


def movers(model: Model, state: State, body: Indices, group: Indices) -> list[Mover]:
    """Return what moves freely and predictably: nothing of it is held, tethered, or pushed to and fro.

    Args:
        model: the compiled scene.
        state: where its run begins.
        body: the body of every atom, named by the first of its atoms, (n_atoms,).
        group: the group of every atom, (n_atoms,).

    Raises:
        TooManyMoversError: there are too many to follow.
    """
    is_unpredictable = np.zeros(model.n_atoms, dtype=bool)
    for force in model.forces:
        if not _is_predictable(force):
            is_unpredictable[force.atoms] = True
    is_free = ~np.isin(body, body[is_unpredictable])
    size = np.bincount(body, minlength=model.n_atoms)
    is_loose = is_free & (size[body] == 1)
    alike = _alike(model, state, group)
    names = np.where(is_loose, model.n_atoms + alike, body)
    number = numbered(names[is_free])
    n_movers = int(number.max(initial=-1)) + 1
    if n_movers > MOST_MOVERS:
        raise TooManyMoversError
    free = np.flatnonzero(is_free)
    order = np.argsort(number, kind="stable")
    parts = np.split(free[order], np.cumsum(np.bincount(number, minlength=n_movers))[:-1])
    return [_mover(model, state, atoms, alike, bool(is_loose[atoms[0]])) for atoms in parts if atoms.size]


def _is_predictable(force: ExternalForce) -> bool:
    """Return whether the flight of a body on which a force acts is known: a torque leaves the centroid alone.

    A kind of force that nothing is known of makes it unknown.
    """
    match force:
        case DampingForce() | PushForce() | TorqueForce():
            return True
        case OscillateForce():
            return not any(force.impulse)
        case TowardsForce():
            return force.magnitude == 0.0
        case _:
            return False


def _alike(model: Model, state: State, group: Indices) -> Indices:
    """Number the atoms of a group that start with one velocity and that the same forces act on alike, (n_atoms,)."""
    acted = [np.isin(np.arange(model.n_atoms), force.atoms) for force in model.forces]
    return numbered(group, *state.velocity.T, *acted)


def _mover(model: Model, state: State, atoms: Indices, alike: Indices, is_loose: bool) -> Mover:
    position = state.position[atoms]
    offset = position - position.mean(axis=0)
    damping = 0.0
    drives = []
    is_turning = bool((state.velocity[atoms] != state.velocity[atoms[0]]).any())
    for force in model.forces:
        share = _share(force, atoms)
        is_turning |= 0.0 < share < 1.0 and not isinstance(force, TorqueForce)
        is_turning |= isinstance(force, TorqueForce) and share > 0.0 and force.magnitude != 0.0
        if isinstance(force, DampingForce):
            damping += share * force.coefficient
        elif isinstance(force, PushForce) and share and any(force.impulse):
            until = math.inf if force.until_round is None else float(force.until_round)
            drives.append(Drive(force, share * np.array(force.impulse), float(force.from_round), until))
    flight = Flight(model.time_step, state.velocity[atoms].mean(axis=0), min(damping, 1.0), tuple(drives))
    radius = float(np.sqrt((offset * offset).sum(axis=1).max()))
    return Mover(atoms, flight, is_turning and not is_loose, is_loose, radius)


def _share(force: ExternalForce, atoms: Indices) -> float:
    """Return the share of some atoms that a force acts on."""
    return float(np.isin(atoms, force.atoms).sum()) / atoms.size
