"""From a group's shape to where its atoms start and how fast; knows one group at a time, nothing of rules.

The order of operations is part of the numerics convention: whatever comes from cos, sin or sqrt is quantised before
the centre is added, so that a libm that differs in the last place cannot change a run.
"""

from __future__ import annotations

import math
from typing import assert_never

import numpy as np

from atomsim.core.forces import quantise
from atomsim.core.model import Floats
from atomsim.scene.language import (
    AtomsGroup,
    BlockGroup,
    Group,
    PlaneGroup,
    PolygonGroup,
    RingGroup,
    StringGroup,
    Vector,
)
from atomsim.scene.language.base import LARGEST_WHOLE_NUMBER

RING_PLANE = {"z": (0, 1), "y": (0, 2), "x": (1, 2)}
"""The two axes of a ring's plane, by the axis through it; angles are counted from the first."""


def count_atoms(group: Group) -> int:
    """Return the number of atoms of a group without making them."""
    match group:
        case StringGroup() | RingGroup():
            return group.count
        case PlaneGroup() | BlockGroup():
            return math.prod(group.counts)
        case AtomsGroup():
            return len(group.positions)
        case PolygonGroup():
            return sum(_steps_along(start, stop, group.spacing) for start, stop in _sides(group))
        case _:
            assert_never(group)


def place(group: Group) -> tuple[Floats, Floats]:
    """Return the initial positions [length] and velocities of a group's atoms, each (n_atoms, 3) float64."""
    offset = _offsets(group)
    for turn in group.rotate:
        offset = _quantised(_rotated(offset, turn.axis, turn.degrees))
    if isinstance(group, AtomsGroup):
        position = np.array(group.positions)
        middle = _centroid(position)
        if group.rotate or group.centre is not None:
            position = (middle if group.centre is None else np.array(group.centre)) + offset
    else:
        position = np.array(group.centre) + offset
    velocity = np.tile(np.array(group.velocity), (offset.shape[0], 1))
    if group.spin is not None:
        velocity = velocity + group.spin.rate * _cross(unit(group.spin.axis), offset)
    return position, velocity


def _offsets(group: Group) -> Floats:
    """Return the atoms of a shape relative to its centre, (n_atoms, 3)."""
    match group:
        case StringGroup():
            return _centred(group.count)[:, None] * _vector(group.step)
        case RingGroup():
            return _ring(group)
        case PlaneGroup():
            along_x = _centred(group.counts[0])[:, None] * _vector(group.step_x)
            along_y = _centred(group.counts[1])[:, None] * _vector(group.step_y)
            return (along_x[None, :, :] + along_y[:, None, :]).reshape(-1, 3)
        case BlockGroup():
            z, y, x = np.meshgrid(*(_centred(count) * group.spacing for count in group.counts[::-1]), indexing="ij")
            return np.stack((x, y, z), axis=-1).reshape(-1, 3)
        case PolygonGroup():
            points = np.concatenate([_along_side(start, stop, group.spacing) for start, stop in _sides(group)])
            return _quantised(points - _centroid(points))
        case AtomsGroup():
            points = np.array(group.positions)
            return points - _centroid(points)
        case _:
            assert_never(group)


def _centred(count: int) -> Floats:
    """Return i − (count − 1)/2 for every i."""
    places: Floats = np.arange(count, dtype=np.float64) - (count - 1) / 2
    return places


def _vector(vector: Vector) -> Floats:
    return np.array(vector, dtype=np.float64)


def _ring(group: RingGroup) -> Floats:
    """Atom i lies at the angle 2πi/count."""
    first, second = RING_PLANE[group.axis]
    offset = np.zeros((group.count, 3))
    for atom in range(group.count):
        angle = 2.0 * math.pi * atom / group.count
        offset[atom, first] = quantise(group.radius * math.cos(angle))
        offset[atom, second] = quantise(group.radius * math.sin(angle))
    return offset


def _sides(group: PolygonGroup) -> list[tuple[Vector, Vector]]:
    """Return the sides of a polygon, the last one back to the first corner."""
    return list(zip(group.corners, group.corners[1:] + group.corners[:1], strict=True))


def _steps_along(start: Vector, stop: Vector, spacing: float) -> int:
    """Return into how many even steps a side is divided."""
    dx, dy, dz = (end - begin for begin, end in zip(start, stop, strict=True))
    length = math.sqrt((dx * dx + dy * dy) + dz * dz)
    return max(1, round(min(length / spacing, LARGEST_WHOLE_NUMBER)))


def _along_side(start: Vector, stop: Vector, spacing: float) -> Floats:
    """Return the atoms from one corner on, without the next corner."""
    steps = _steps_along(start, stop, spacing)
    points: Floats = _vector(start) + (np.arange(steps) / steps)[:, None] * (_vector(stop) - _vector(start))
    return points


def _rotated(offset: Floats, axis: Vector, degrees: float) -> Floats:
    """Turn offsets about an axis (Rodrigues): cos·o + sin·(a × o) + (1 − cos)·(a·o)·a."""
    angle = math.radians(degrees)
    cosine, sine = math.cos(angle), math.sin(angle)
    direction = unit(axis)
    along = (direction[0] * offset[:, 0] + direction[1] * offset[:, 1]) + direction[2] * offset[:, 2]
    turned: Floats = (cosine * offset + sine * _cross(direction, offset)) + ((1.0 - cosine) * along)[
        :, None
    ] * direction
    return turned


def unit(axis: Vector) -> Floats:
    """Return a direction scaled to length one, (3,)."""
    largest = max(abs(part) for part in axis)
    x, y, z = (part / largest for part in axis)
    return np.array((x, y, z)) / math.sqrt((x * x + y * y) + z * z)


def _cross(axis: Floats, offset: Floats) -> Floats:
    """Return axis × offset for every atom."""
    x, y, z = offset.T
    return np.stack((axis[1] * z - axis[2] * y, axis[2] * x - axis[0] * z, axis[0] * y - axis[1] * x), axis=1)


def _centroid(points: Floats) -> Floats:
    """Return the mean point, adding one after the other."""
    total: Floats = np.cumsum(points, axis=0)[-1] / points.shape[0]
    return total


def _quantised(points: Floats) -> Floats:
    """Round every coordinate to a multiple of 2⁻⁴⁰, as `quantise` does, but let a zero keep its sign."""
    return np.round(points * 2.0**40) / 2.0**40
