"""The forces from outside on a share of atoms, compiled; knows how forces are laid out, not why.

The laws and their order of evaluation are those of `atomsim.core.forces`.
"""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Floats
from atomsim.core.numba_backend.jit import inner
from atomsim.core.plans.force_plan import DAMPING, PUSH, TETHER, TORQUE, TOWARDS
from atomsim.core.plans.records import Forces


@inner
def add_forces(
    forces: Forces,
    pushes: Floats,
    outside: Floats,
    position: Floats,
    velocity: Floats,
    impulse: Floats,
    start: int,
    stop: int,
) -> None:
    """Apply all forces, in order, to the slots start ≤ slot < stop.

    `pushes` is (n_forces, 3); `outside`, what is added last, is (3, n_slots), or (3, 0) for nothing.
    """
    for force in range(forces.kind.size):
        kind = forces.kind[force]
        number = forces.number[force]
        centre_x, centre_y, centre_z, strength = 0.0, 0.0, 0.0, 0.0
        if kind == TORQUE:
            centre_x, centre_y, centre_z = _centroid(force, forces, position)
            strength = _strength(force, forces, position, centre_x, centre_y, centre_z)
        elif kind == TOWARDS:
            if pushes[force, 0] == 0.0:
                continue
            centre_x, centre_y, centre_z = number[0], number[1], number[2]
            if forces.n_about[force] > 0.0:
                centre_x, centre_y, centre_z = _centroid(force, forces, position)
        for run in range(forces.first_run[force], forces.first_run[force + 1]):
            first, last = max(start, forces.run_start[run]), min(stop, forces.run_stop[run])
            if kind == DAMPING:
                _damp(first, last, number[0], velocity, impulse)
            elif kind == PUSH:
                _push(first, last, pushes[force], impulse)
            elif kind == TORQUE:
                _twist(first, last, number, strength, centre_x, centre_y, centre_z, position, impulse)
            elif kind == TETHER:
                begin = forces.first_rest[run] + first - forces.run_start[run]
                _tether(first, last, forces.target[:, begin:], forces.rest_squared[begin:], position, impulse)
            elif kind == TOWARDS:
                _push_towards(first, last, number[3], centre_x, centre_y, centre_z, position, impulse)
    if outside.shape[1]:
        for component in range(3):
            for slot in range(start, stop):
                impulse[component, slot] += outside[component, slot]
    for run in range(forces.held_start.size):
        first, last = max(start, forces.held_start[run]), min(stop, forces.held_stop[run])
        for component in range(3):
            impulse[component, first:last] = 0.0


@inner
def _damp(first: int, last: int, coefficient: float, velocity: Floats, impulse: Floats) -> None:
    """j ← j − m·v."""
    for component in range(3):
        for slot in range(first, last):
            impulse[component, slot] -= coefficient * velocity[component, slot]


@inner
def _push(first: int, last: int, vector: Floats, impulse: Floats) -> None:
    """j ← j + g."""
    for component in range(3):
        for slot in range(first, last):
            impulse[component, slot] += vector[component]


@inner
def _centroid(force: int, forces: Forces, position: Floats) -> tuple[float, float, float]:
    """Return the centre that a force needs: the mean of positions, added one after the other."""
    x, y, z = 0.0, 0.0, 0.0
    for run in range(forces.first_about_run[force], forces.first_about_run[force + 1]):
        for slot in range(forces.about_start[run], forces.about_stop[run]):
            x += position[0, slot]
            y += position[1, slot]
            z += position[2, slot]
    count = forces.n_about[force]
    return x / count, y / count, z / count


@inner
def _arm(axis: Floats, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return axis × (x, y, z)."""
    return axis[1] * z - axis[2] * y, axis[2] * x - axis[0] * z, axis[0] * y - axis[1] * x


@inner
def _strength(force: int, forces: Forces, position: Floats, x: float, y: float, z: float) -> float:
    """Return s = magnitude / Σ|u|² of a torque about (x, y, z); 0 where all u vanish. `number` is axis, magnitude."""
    axis, leverage = forces.number[force], 0.0
    for run in range(forces.first_run[force], forces.first_run[force + 1]):
        for slot in range(forces.run_start[run], forces.run_stop[run]):
            u, v, w = _arm(axis, position[0, slot] - x, position[1, slot] - y, position[2, slot] - z)
            leverage += (u * u + v * v) + w * w
    return axis[3] / leverage if leverage > 0.0 else 0.0


@inner
def _twist(
    first: int,
    last: int,
    axis: Floats,
    strength: float,
    x: float,
    y: float,
    z: float,
    position: Floats,
    impulse: Floats,
) -> None:
    """j ← j + s · u with u = axis × (c − centre)."""
    for slot in range(first, last):
        u, v, w = _arm(axis, position[0, slot] - x, position[1, slot] - y, position[2, slot] - z)
        impulse[0, slot] += strength * u
        impulse[1, slot] += strength * v
        impulse[2, slot] += strength * w


@inner
def _tether(first: int, last: int, target: Floats, rest_squared: Floats, position: Floats, impulse: Floats) -> None:
    """j ← j + (target − c) · (1 − r²/d²); none at the target. Both arrays begin with the first atom's."""
    for slot in range(first, last):
        dx = target[0, slot - first] - position[0, slot]
        dy = target[1, slot - first] - position[1, slot]
        dz = target[2, slot - first] - position[2, slot]
        squared = (dx * dx + dy * dy) + dz * dz
        if squared == 0.0:
            squared = np.inf
        weight = 1.0 - rest_squared[slot - first] * (1.0 / squared)
        impulse[0, slot] += weight * dx
        impulse[1, slot] += weight * dy
        impulse[2, slot] += weight * dz


@inner
def _push_towards(
    first: int, last: int, magnitude: float, x: float, y: float, z: float, position: Floats, impulse: Floats
) -> None:
    """j ← j + (magnitude/√q) · (t − c) with t = (x, y, z) and q = |t − c|²; none at t itself."""
    for slot in range(first, last):
        dx, dy, dz = x - position[0, slot], y - position[1, slot], z - position[2, slot]
        squared = (dx * dx + dy * dy) + dz * dz
        if squared == 0.0:
            squared = np.inf
        weight = magnitude / np.sqrt(squared)
        impulse[0, slot] += weight * dx
        impulse[1, slot] += weight * dy
        impulse[2, slot] += weight * dz
