"""Forces from outside, added to the impulse in order of declaration; knows no bonds, no collisions, no scenes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import assert_never

import numpy as np

from atomsim.core.model import (
    ActingForce,
    DampingForce,
    ExternalForce,
    Floats,
    HoldForce,
    Indices,
    OscillateForce,
    PushForce,
    TetherForce,
    TorqueForce,
    TowardsForce,
)
from atomsim.core.pairs.collisions import as_index
from atomsim.core.pairs.near import distinct

Law = Callable[[int, Floats, Floats, Floats], None]
"""Adds one force: (round_index, position, velocity, impulse), arrays (3, n_atoms), the last one changed in place."""


def quantise(value: float) -> float:
    """Round to a multiple of 2⁻⁴⁰, so that a libm that differs in the last place cannot change a run.

    >>> quantise(0.1) == 0.1, round(quantise(0.1), 12)
    (False, 0.1)
    """
    scaled = value * 1099511627776.0
    return round(scaled) / 1099511627776.0 if abs(scaled) < 2.0**52 else value  # beyond, a float has no fraction


def oscillation(force: OscillateForce, round_index: int) -> float:
    """Return sin(2π·round/period + phase), quantised."""
    return quantise(math.sin(2.0 * math.pi * round_index / force.period + force.phase))


def is_pushing(force: PushForce | TowardsForce, round_index: int) -> bool:
    """Return whether from_round ≤ round < until_round."""
    return round_index >= force.from_round and (force.until_round is None or round_index < force.until_round)


def held_atoms(forces: Sequence[ExternalForce]) -> Indices:
    """Return the atoms whose impulse is discarded, ascending."""
    return distinct([force.atoms for force in forces if isinstance(force, HoldForce)])


def acting(forces: Sequence[ExternalForce]) -> list[ActingForce]:
    """Return the forces that change the impulse, in the order in which they do; what is held is held after them all."""
    return [force for force in forces if not isinstance(force, HoldForce)]


def law(force: ActingForce) -> Law:
    """Return what to call in every round."""
    match force:
        case DampingForce():
            return _damping(force)
        case PushForce():
            return _push(force)
        case TowardsForce():
            return _push_towards(force)
        case OscillateForce():
            return _oscillate(force)
        case TorqueForce():
            return _torque(force)
        case TetherForce():
            return _tether(force)
        case _:
            assert_never(force)


def strength(force: ActingForce) -> float | None:
    """Return the largest impulse that a force gives to an atom in a round.

    It is 0 for what only ever takes energy away, and None where nobody can tell beforehand.
    """
    match force:
        case PushForce() | OscillateForce():
            return math.hypot(*force.impulse)
        case TowardsForce():
            return abs(force.magnitude)
        case DampingForce():
            return 0.0
        case TorqueForce() | TetherForce():
            return None
        case _:
            assert_never(force)


def _damping(force: DampingForce) -> Law:
    """j ← j − m·v (paper section 2.3)."""
    atoms, coefficient = as_index(force.atoms), force.coefficient

    def apply(_: int, __: Floats, velocity: Floats, impulse: Floats) -> None:
        impulse[:, atoms] -= coefficient * velocity[:, atoms]

    return apply


def _push(force: PushForce) -> Law:
    """j ← j + g while the round is in its range."""
    atoms, vector = as_index(force.atoms), np.array(force.impulse)[:, None]

    def apply(round_index: int, _: Floats, __: Floats, impulse: Floats) -> None:
        if is_pushing(force, round_index):
            impulse[:, atoms] += vector

    return apply


def _push_towards(force: TowardsForce) -> Law:
    """j ← j + (magnitude/√q) · (t − c) with q = |t − c|², while the round is in its range; none at t itself.

    √ is rounded exactly, as + − × ÷ are (IEEE 754).
    """
    atoms, centre = as_index(force.atoms), as_index(force.centre)
    point, n_centre = np.array(force.target), float(force.centre.size)

    def apply(round_index: int, position: Floats, _: Floats, impulse: Floats) -> None:
        if is_pushing(force, round_index):
            target = np.cumsum(position[:, centre], axis=1)[:, -1] / n_centre if n_centre else point
            difference = target[:, None] - position[:, atoms]
            squared = (difference[0] * difference[0] + difference[1] * difference[1]) + difference[2] * difference[2]
            squared[squared == 0.0] = np.inf
            impulse[:, atoms] += (force.magnitude / np.sqrt(squared)) * difference

    return apply


def _oscillate(force: OscillateForce) -> Law:
    """j ← j + g · sin(2π·round/period + phase)."""
    atoms, vector = as_index(force.atoms), np.array(force.impulse)[:, None]

    def apply(round_index: int, _: Floats, __: Floats, impulse: Floats) -> None:
        impulse[:, atoms] += vector * oscillation(force, round_index)

    return apply


def _torque(force: TorqueForce) -> Law:
    """j ← j + s · u with u = axis × (c − centre) and s = magnitude / Σ|u|²; no impulse where all u vanish.

    Sums run over atoms in increasing index (`cumsum` adds one after the other), the cross product is a·b − c·d.
    """
    atoms, about = as_index(force.atoms), as_index(force.about)
    axis_x, axis_y, axis_z = force.axis
    n_about = float(force.about.size)

    def apply(_: int, position: Floats, __: Floats, impulse: Floats) -> None:
        centre = np.cumsum(position[:, about], axis=1)[:, -1] / n_about
        x, y, z = position[:, atoms] - centre[:, None]
        arm = np.stack((axis_y * z - axis_z * y, axis_z * x - axis_x * z, axis_x * y - axis_y * x))
        leverage = np.cumsum((arm[0] * arm[0] + arm[1] * arm[1]) + arm[2] * arm[2])[-1]
        if leverage > 0.0:
            impulse[:, atoms] += (force.magnitude / leverage) * arm

    return apply


def _tether(force: TetherForce) -> Law:
    """j ← j + (target − c) · (1 − r²/d²): a bond (paper section 2.3) to a fixed point; none at the point itself."""
    atoms, target = as_index(force.atoms), force.target.T

    def apply(_: int, position: Floats, __: Floats, impulse: Floats) -> None:
        difference = target - position[:, atoms]
        squared = (difference[0] * difference[0] + difference[1] * difference[1]) + difference[2] * difference[2]
        squared[squared == 0.0] = np.inf
        impulse[:, atoms] += (1.0 - force.rest_squared * (1.0 / squared)) * difference

    return apply
