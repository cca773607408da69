"""The searches for near pairs find exactly what looking at every pair finds."""

from __future__ import annotations

import itertools
from unittest.mock import patch

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from atomsim.core.model import Floats
from atomsim.core.pairs import near

SEARCHES = {
    "tiles": {"DENSE_LIMIT": 1 << 60},
    "small tiles": {"DENSE_LIMIT": 1 << 60, "TILE": 5},
    "cells": {"DENSE_LIMIT": -1},
    "small bands": {"DENSE_LIMIT": -1, "TILE": 3},
}

near_ones = st.floats(-3, 3) | st.integers(-6, 6).map(lambda number: number / 2)
far_ones = st.floats(-1e30, 1e30)
points = st.lists(st.tuples(*[near_ones] * 3) | st.tuples(*[near_ones | far_ones] * 3), min_size=1, max_size=25)
cutoffs = st.floats(0.1, 3) | st.sampled_from([0.5, 1.0, 2.0, 2.5])


def columns(rows: list[tuple[float, float, float]]) -> Floats:
    return np.array(rows, dtype=np.float64).T


def by_looking(left: Floats, right: Floats | None, cutoff: float) -> list[tuple[int, int]]:
    """Return the near pairs, looking at one after the other."""
    partner = left if right is None else right
    found = []
    for i, k in itertools.product(range(left.shape[1]), range(partner.shape[1])):
        x, y, z = (partner[:, k] - left[:, i]).tolist()
        if (right is not None or i < k) and (x * x + y * y) + z * z < cutoff * cutoff:
            found.append((i, k))
    return found


@given(points, st.none() | points, cutoffs)
@example([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (1.0, 1.0, 1.0)], None, 2.0)  # exactly at the cutoff is not near
@example([(0.0, 0.0, 0.0)], [(0.0, 0.0, 0.0)], 1.0)
@example([(1e6, 0.0, 0.0), (1e6, 0.5, 0.0), (-1e6, 0.0, 0.0)], None, 1.0)  # beyond the outermost cells
def test_all_searches_find_the_same_pairs(
    left: list[tuple[float, float, float]], right: list[tuple[float, float, float]] | None, cutoff: float
) -> None:
    one, other = columns(left), None if right is None else columns(right)
    expected = by_looking(one, other, cutoff)
    for thresholds in SEARCHES.values():
        with patch.multiple(near, **thresholds):
            first, second = near.near_pairs(one, other, cutoff)
        assert list(zip(first.tolist(), second.tolist(), strict=True)) == expected
