"""Finding atoms at the same place, where a force would have no direction; knows positions and tables only."""

from __future__ import annotations

import math

import numpy as np

from atomsim.core.model import Between, CollisionTable, Floats, Indices, Within
from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.core.pairs.near import pair_squares

Pairs = tuple[Indices, Indices]

NO_DISTANCE = 2e-162
"""Atoms nearer than this are at one place: the square of their distance is zero [length]."""


def coincident_among(position: Floats, first: Indices, second: Indices) -> Pairs:
    """Return those of some pairs whose distance squared is zero.

    Args:
        position: atom centres [length], (n_atoms, 3).
        first: one atom of each pair, (n_pairs,).
        second: the other, (n_pairs,).
    """
    coincide = pair_squares(position.T, first, second) == 0.0
    return first[coincide], second[coincide]


def coincident_anywhere(position: Floats) -> Pairs:
    """Return pairs of atoms at exactly one place, some at every such place.

    Args:
        position: atom centres [length], (n_atoms, 3).
    """
    x, y, z = position.T
    mixed = (x + math.sqrt(2.0) * y) + math.pi * z  # the same for atoms at one place, and hardly ever for others
    in_order = np.sort(mixed)
    repeated = in_order[1:][in_order[1:] == in_order[:-1]]
    atoms = np.flatnonzero(np.isin(mixed, repeated)) if repeated.size else np.empty(0, dtype=np.int64)
    order, start, stop = _crowds(position[atoms])
    return atoms[order[start]], atoms[order[stop - 1]]


def coincident_pairs(position: Floats, table: CollisionTable) -> Pairs:
    """Return pairs of a collision table at distance zero: not all (a crowd has too many), but some at every such place.

    Args:
        position: atom centres [length], (n_atoms, 3).
        table: the declared collisions.

    Returns:
        The pairs, first < second; one may come more than once.

    Raises:
        MemoryError: some pairs are bound and do not collide, and there are too many at one place to look at each.
    """
    found = [
        _within(position, block) if isinstance(block, Within) else _between(position, block) for block in table.blocks
    ]
    one, other = np.concatenate(found, axis=1)
    if one.size and table.bound is not None:  # those found may be bound, and others at their place not
        return table_pairs_near(table, np.ascontiguousarray(position.T), NO_DISTANCE)
    return np.minimum(one, other), np.maximum(one, other)


def _within(position: Floats, block: Within) -> Pairs:
    """Of the atoms at one place, the first and the last are furthest apart in index."""
    order, start, stop = _crowds(position[block.atoms])
    low, high = order[start], order[stop - 1]
    collides = high - low >= block.min_gap
    return block.atoms[low[collides]], block.atoms[high[collides]]


def _between(position: Floats, block: Between) -> Pairs:
    """Of the atoms at one place, those of the left side come first, each side in order.

    An atom may be on both sides: if the first of the left is the last of the right, the last of the left and the first
    of the right are the pair to look at.
    """
    atoms = np.concatenate((block.left, block.right))
    order, start, stop = _crowds(position[atoms])
    before = np.concatenate(([0], np.cumsum(order < block.left.size)))
    middle = start + before[stop] - before[start]
    is_mixed = (start < middle) & (middle < stop)
    start, middle, stop = start[is_mixed], middle[is_mixed], stop[is_mixed]
    first = atoms[order[np.concatenate((start, middle - 1))]]
    second = atoms[order[np.concatenate((stop - 1, middle))]]
    return first[first != second], second[first != second]


def _crowds(position: Floats) -> tuple[Indices, Indices, Indices]:
    """Sort by place: the atoms order[start[n]:stop[n]], ascending, are a crowd of two or more at one place."""
    place = np.stack([_places(coordinate) for coordinate in position.T])
    order = np.lexsort(place)
    is_new = np.ones(order.size + 1, dtype=bool)
    is_new[1:-1] = (place[:, order[1:]] != place[:, order[:-1]]).any(axis=0)
    bounds = np.flatnonzero(is_new)
    start, stop = bounds[:-1], bounds[1:]
    return order, start[stop - start > 1], stop[stop - start > 1]


def _places(coordinate: Floats) -> Indices:
    """Number the places along an axis; those so near each other that the square of the way between is zero are one."""
    order = np.argsort(coordinate)
    gap = np.diff(coordinate[order])
    place = np.zeros(order.size, dtype=np.int64)
    place[order[1:]] = np.cumsum(gap * gap > 0.0)
    return place
