"""Forces of which nothing comes in any round of the run."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.model import (
    DampingForce,
    ExternalForce,
    OscillateForce,
    PushForce,
    TorqueForce,
    TowardsForce,
)
from atomsim.core.pairs.near import distinct
from atomsim.findings.finding import Remedy, Symptom
from atomsim.findings.subject import Subject

SHORTEST_LEVER = 1e-6
"""Atoms nearer than this to the axis of a torque lie on it [length]: what is left is rounding, or jitter."""

LEAST_SINE = 0.01
"""An oscillation that never reaches this part of its impulse does nothing."""

MOST_SINES = 1_000_000
"""So many rounds of an oscillation are looked at."""


def force_never_acts(subject: Subject) -> Iterator[Symptom]:
    """Find impulses of zero, windows beyond the run, sines that stay at zero, and torques without a lever."""
    for name, forces in _by_name(subject).items():
        found = [_why(force, subject) for force in forces]
        if found[0] is not None and None not in found:
            message, keys = found[0]
            yield Symptom(
                at=("forces", name),
                names=(("forces", name), *subject.group_paths(distinct([force.atoms for force in forces]))),
                message=message,
                remedy={"forces": {name: keys}},
            )


def _by_name(subject: Subject) -> dict[str, list[ExternalForce]]:
    """Return the forces of each declaration: one that goes copy by copy is several."""
    named: dict[str, list[ExternalForce]] = {}
    for force in subject.model.forces:
        named.setdefault(force.origin.name, []).append(force)
    return named


def _why(force: ExternalForce, subject: Subject) -> tuple[str, Remedy | None] | None:
    """Return why a force never acts, and the keys to change, or None where it does."""
    rounds = subject.scene.rounds
    match force:
        case PushForce() if not any(force.impulse):
            return "`impulse` is zero, so this force does nothing", None
        case PushForce() | TowardsForce() if force.from_round >= rounds:
            return (
                f"this begins in round {force.from_round}, when the run is over: its last round is {rounds - 1}",
                {"from_round": 0},
            )
        case OscillateForce() if not any(force.impulse):
            return "`impulse` is zero, so this force does nothing", None
        case OscillateForce() if _largest_sine(force, rounds) < LEAST_SINE:
            return (
                f"sin(2π·round/{force.period:g}{f' + {force.phase:g}' if force.phase else ''}) is below "
                f"{LEAST_SINE:g} in every round of the run",
                {"phase": round(math.pi / 2, 4)},
            )
        case TorqueForce() | TowardsForce() if force.magnitude == 0.0:
            return "`magnitude` is zero, so this force does nothing", None
        case TorqueForce() if _longest_lever(force, subject) < SHORTEST_LEVER:
            return (
                "all its atoms lie on the axis, where a torque does nothing, or, a hair beside it, throws them away; "
                "choose another `axis` or `about`",
                {"axis": _other_axis(force)},
            )
        case DampingForce() if force.coefficient == 0.0:
            return "`coefficient` is zero, so this force does nothing", None
        case _:
            return None


def _largest_sine(force: OscillateForce, rounds: int) -> float:
    angle = 2.0 * np.pi * np.arange(min(rounds, MOST_SINES)) / force.period + force.phase
    return float(np.abs(np.sin(angle)).max())


def _longest_lever(force: TorqueForce, subject: Subject) -> float:
    position = subject.state.position
    centre = position[force.about].mean(axis=0)
    return float(np.abs(np.cross(force.axis, position[force.atoms] - centre)).max())


def _other_axis(force: TorqueForce) -> str:
    """Return the axis of space that the axis of the force is furthest from."""
    return "xyz"[int(np.abs(force.axis).argmin())]
