"""From a group's shape to where its atoms start and how fast; knows one group at a time, nothing of rules.

The order of operations is part of the numerics convention: whatever comes from cos, sin or sqrt is quantised before
the centre is added, so that a libm that differs in the last place cannot change a run.
"""

from __future__ import annotations

import math
from typing import assert_never

import numpy as np

from atomsim.compiler.ball import ball_offsets, count_in_ball
from atomsim.core.forces import quantise
from atomsim.core.model import Floats
from atomsim.scene.language import (
    AtomsGroup,
    BallGroup,
    BlockGroup,
    Copies,
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
    """Return the number of atoms of a group, with its copies, without making them."""
    return _count_atoms_of_one(group) * count_copies(group)


def count_copies(group: Group) -> int:
    """Return how many copies of a group there are, itself counted."""
    return math.prod(copies.count for copies in group.copies)


def _count_atoms_of_one(group: Group) -> int:
    match group:
        case StringGroup():
            return _count_along(group)
        case RingGroup():
            return group.count
        case BallGroup():
            return count_in_ball(group)
        case PlaneGroup() | BlockGroup():
            return math.prod(group.counts)
        case AtomsGroup():
            return len(group.positions)
        case PolygonGroup():
            return sum(_steps_along(start, stop, group.spacing) for start, stop in _sides(group))
        case _:
            assert_never(group)


def place(group: Group) -> tuple[Floats, Floats]:
    """Return the initial positions [length] and velocities of a group's atoms, each (n_atoms, 3) float64.

    Copies come one after the other, the first as written.
    """
    position, velocity = _place_one(group)
    for copies in group.copies:
        position, velocity = _copied(position, velocity, copies)
    return position, velocity


def _place_one(group: Group) -> tuple[Floats, Floats]:
    offset = _offsets(group)
    for turn in group.rotate:
        offset = _quantised(_rotated(offset, turn.axis, turn.degrees))
    if isinstance(group, AtomsGroup):
        position = np.array(group.positions)
        middle = _centroid(position)
        if group.rotate or group.centre is not None:
            position = (middle if group.centre is None else np.array(group.centre)) + offset
    else:
        position = _centre(group) + offset
    velocity = np.tile(np.array(group.velocity), (offset.shape[0], 1))
    if group.spin is not None:
        velocity = velocity + group.spin.rate * _cross(unit(group.spin.axis), offset)
    return position, velocity


def _offsets(group: Group) -> Floats:
    """Return the atoms of a shape relative to its centre, (n_atoms, 3)."""
    match group:
        case StringGroup():
            return _centred(_count_along(group))[:, None] * _step_along(group)
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
        case BallGroup():
            return ball_offsets(group)
        case AtomsGroup():
            points = np.array(group.positions)
            return points - _centroid(points)
        case _:
            assert_never(group)


def _centre(group: Group) -> Floats:
    """Return where the centre of a shape goes, (3,); a string may say instead where it begins."""
    if isinstance(group, StringGroup) and group.from_ is not None:
        return _vector(group.from_) + (_count_along(group) - 1) / 2 * _step_along(group)
    return np.array(group.centre if group.centre is not None else (0.0, 0.0, 0.0))


def _count_along(group: StringGroup) -> int:
    """Return the number of atoms of a string."""
    if group.spacing is None or group.from_ is None or group.to is None:
        return group.count or 0
    return _steps_along(group.from_, group.to, group.spacing) + 1


def _step_along(group: StringGroup) -> Floats:
    """Return the way from each atom of a string to the next, (3,)."""
    if group.from_ is None or group.to is None:
        return np.array(group.step)
    return (_vector(group.to) - _vector(group.from_)) / (_count_along(group) - 1)


def _copied(position: Floats, velocity: Floats, copies: Copies) -> tuple[Floats, Floats]:
    """Return some atoms and their copies, one copy after the other, the first where they are."""
    if copies.axis is None:
        way = np.arange(copies.count)[:, None, None] * np.array(copies.step)
        return (position + way).reshape(-1, 3), np.tile(velocity, (copies.count, 1))
    centre = _vector(copies.through or (0.0, 0.0, 0.0))
    step = 360.0 / copies.count if copies.degrees is None else copies.degrees
    positions, velocities = [position], [velocity]
    for degrees in (number * step for number in range(1, copies.count)):
        positions.append(centre + _quantised(_rotated(position - centre, copies.axis, degrees)))
        velocities.append(_quantised(_rotated(velocity, copies.axis, degrees)))
    return np.concatenate(positions), np.concatenate(velocities)


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
