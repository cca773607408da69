"""Convex hulls of points in a plane."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from atomsim.core.forces import quantise
from atomsim.core.model import Floats, Indices

_DIRECTIONS = 16
"""In so many directions the farthest points are found first; few others lie outside the polygon that they make."""


def hull(x: Floats, y: Floats) -> Indices:
    """Return the points that are corners of the convex hull, ascending; of equal points, at least one.

    Args:
        x, y: the points, (n,) float64.

    Returns:
        Their indices, (n_corners,) int64; empty if there are no points.
    """
    if not x.size:
        return np.empty(0, dtype=np.int64)
    outside = np.flatnonzero(_is_outside(x, y, _farthest(x, y)))
    in_order = outside[np.lexsort((y[outside], x[outside]))].tolist()
    return np.unique(_chain(x, y, in_order) + _chain(x, y, reversed(in_order)))


def _farthest(x: Floats, y: Floats) -> list[int]:
    """Return the points that are farthest in some directions, which are corners of the hull, in mathematical sense."""
    turns = (2.0 * math.pi * number / _DIRECTIONS for number in range(_DIRECTIONS))
    found = [int(np.argmax(quantise(math.cos(turn)) * x + quantise(math.sin(turn)) * y)) for turn in turns]
    return list(dict.fromkeys(found))


def _is_outside(x: Floats, y: Floats, corners: list[int]) -> NDArray[np.bool_]:
    """Tell which points do not lie strictly inside a convex polygon, (n,) bool (Akl and Toussaint 1978)."""
    outside = np.zeros(x.size, dtype=bool)
    for one, other in zip(corners, corners[1:] + corners[:1], strict=True):
        outside |= (x[other] - x[one]) * (y - y[one]) - (y[other] - y[one]) * (x - x[one]) <= 0.0
    return outside


def _chain(x: Floats, y: Floats, in_order: Iterable[int]) -> list[int]:
    """Return one side of the hull of points that are sorted along x (Andrew 1979)."""
    chain: list[int] = []
    for point in in_order:
        while len(chain) > 1 and _turn(x, y, chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def _turn(x: Floats, y: Floats, one: int, other: int, third: int) -> float:
    """Return a number above zero where the way from one point by another to a third turns left."""
    return float((x[other] - x[one]) * (y[third] - y[one]) - (y[other] - y[one]) * (x[third] - x[one]))
