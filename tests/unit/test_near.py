"""Searching for near pairs where there are too many to look at."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
import pytest

from atomsim.core.pairs import near
from atomsim.core.pairs.near import distinct, near_pairs, squared_distance


def test_cells_find_what_tiles_find_among_thousands() -> None:
    random = np.random.default_rng(1)
    left, right = random.uniform(-9, 9, (3, 2500)), random.uniform(-9, 9, (3, 2000))
    assert left.shape[1] * right.shape[1] > near.DENSE_LIMIT
    for partner in (None, right):
        cells = near_pairs(left, partner, 1.0)
        with patch.object(near, "DENSE_LIMIT", 1 << 60):
            tiles = near_pairs(left, partner, 1.0)
        assert cells[0].size > 1000
        assert np.array_equal(cells, tiles)


def test_a_hundred_thousand_atoms_far_apart_are_searched_without_their_pairs() -> None:
    position = np.zeros((3, 100_000))
    position[0] = np.arange(100_000) * 0.75
    first, second = near_pairs(position, None, 1.0)
    assert np.array_equal(first, np.arange(99_999))
    assert np.array_equal(second, first + 1)


def test_nothing_near_is_two_empty_arrays_of_indices() -> None:
    first, second = near_pairs(np.array([[0.0, 5.0], [0.0, 0.0], [0.0, 0.0]]), None, 5.0)
    assert (first.size, second.size, first.dtype, second.dtype) == (0, 0, np.int64, np.int64)


def test_more_near_pairs_than_memory_end_in_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near, "LARGE", 1000)
    monkeypatch.setattr(near, "free_memory", lambda: 10**5)
    crowd = np.random.default_rng(1).uniform(0, 1, (3, 300))
    with pytest.raises(MemoryError, match="pairs are near each other"):
        near_pairs(crowd, None, 3.0)


def test_squared_distance_adds_x_and_y_before_z() -> None:
    left, right = np.zeros((3, 1)), np.array([[1e8], [1.0], [1.0]])
    assert squared_distance(left, right).tolist() == [(1e8 * 1e8 + 1.0) + 1.0]
    assert (1e8 * 1e8 + 1.0) + 1.0 != 1e8 * 1e8 + 2.0


def test_distinct_numbers_ascend() -> None:
    numbers = np.random.default_rng(1).integers(-5, 20, 30)
    assert distinct([numbers[:9], numbers[9:]]).tolist() == sorted(set(numbers.tolist()))
    assert distinct([]).tolist() == []
    assert distinct([np.array([7])]).tolist() == [7]
