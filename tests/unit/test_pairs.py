"""Which pairs a bond rule binds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.running import atoms_at, compiled

GROUPS: dict[str, Any] = {
    "thread": {"shape": "string", "count": 5, "step": [1, 0, 0], "centre": [0, 0, 50]},
    "ring": {"shape": "ring", "count": 5, "radius": 2, "centre": [0, 0, 100]},
    "floor": {"shape": "plane", "counts": [3, 2], "step_x": [5, 0, 0], "step_y": [0, 5, 0]},
    "ball": atoms_at((0, 0, 51.5)),
}
"""Atoms 0–4, 5–9, 10–15 and 16."""


def bound(**bonds: Any) -> list[tuple[int, int]]:
    model, _ = compiled(GROUPS, bonds={"b": bonds})
    (table,) = model.bonds
    assert table.first.dtype == table.second.dtype == np.int64
    assert not table.first.flags.writeable
    assert not table.second.flags.writeable
    assert not table.rest_squared.flags.writeable
    return list(zip(table.first.tolist(), table.second.tolist(), strict=True))


def test_all_pairs_inside_each_group() -> None:
    inside = [(i, k) for i in range(5) for k in range(i + 1, 5)]
    assert bound(within="thread", rule="all-pairs") == inside
    both = [*inside, *((i + 5, k + 5) for i, k in inside)]
    assert bound(within=["ring", "thread"], rule="all-pairs") == both


def test_all_pairs_between_groups_that_overlap() -> None:
    assert bound(between=["ball", "thread[1:3]"], rule="all-pairs") == [(1, 16), (2, 16)]
    assert bound(between=["thread[0:2]", "thread[1:3]"], rule="all-pairs") == [(0, 1), (0, 2), (1, 2)]


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({"within": "thread"}, [(0, 1), (1, 2), (2, 3), (3, 4)]),
        ({"within": "thread", "reach": 3}, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (1, 4), (2, 3), (2, 4), (3, 4)]),
        ({"within": "thread", "closed": True}, [(0, 1), (0, 4), (1, 2), (2, 3), (3, 4)]),
        ({"within": "ring"}, [(5, 6), (5, 9), (6, 7), (7, 8), (8, 9)]),
        ({"within": "ring", "closed": False}, [(5, 6), (6, 7), (7, 8), (8, 9)]),
        ({"within": "ring[0:4]"}, [(5, 6), (6, 7), (7, 8)]),
        ({"within": "thread[::2]"}, [(0, 2), (2, 4)]),
        ({"within": "thread[0:2]", "closed": True, "reach": 9}, [(0, 1)]),
    ],
)
def test_neighbours(keys: dict[str, Any], expected: list[tuple[int, int]]) -> None:
    assert bound(rule="neighbour", **keys) == expected


def test_reach_beyond_the_end_binds_every_pair() -> None:
    assert bound(within="ring", rule="neighbour", reach=99) == bound(within="ring", rule="all-pairs")


def test_distance_in_space_is_below_the_threshold_not_at_it() -> None:
    assert bound(within="thread", rule="distance-threshold", threshold=2) == [(0, 1), (1, 2), (2, 3), (3, 4)]
    assert (0, 2) in bound(within="thread", rule="distance-threshold", threshold=2.0000001)
    assert bound(between=["thread", "ball"], rule="distance-threshold", threshold=1.6) == [(2, 16)]


def test_distance_on_the_grid_counts_steps() -> None:
    rows = [(10, 11), (10, 13), (11, 12), (11, 14), (12, 15), (13, 14), (14, 15)]
    diagonals = [(10, 14), (11, 13), (11, 15), (12, 14)]
    assert bound(within="floor", rule="distance-threshold", metric="grid", threshold=1.1) == rows
    assert bound(within="floor", rule="distance-threshold", metric="grid", threshold=2) == sorted(rows + diagonals)
    left = bound(within="floor[0:2, :]", rule="distance-threshold", metric="grid", threshold=1.1)
    assert left == [(10, 11), (10, 13), (11, 14), (13, 14)]


def test_listed_pairs_count_inside_the_selection_once() -> None:
    assert bound(within="ring", rule="pairs", pairs=[[3, 0], [0, 3], [1, 2]]) == [(5, 8), (6, 7)]
    assert bound(between=["ball", "thread[2:]"], rule="pairs", pairs=[[0, 0], [0, 2]]) == [(2, 16), (4, 16)]


def test_atoms_at_the_same_place_are_not_bound_by_distance() -> None:
    model, _ = compiled(
        {"a": atoms_at((0, 0, 0), (0, 0, 0), (1, 0, 0))},
        bonds={"b": {"within": "a", "rule": "distance-threshold", "threshold": 2}},
    )
    assert model.bonds[0].first.tolist() == [0, 1]


def test_desired_distances_are_squared_without_a_root() -> None:
    model, _ = compiled(
        {"a": atoms_at((0, 0, 0), (0.1, 0.2, 0.3))},
        bonds={"own": {"within": "a", "rule": "all-pairs"}, "set": {"within": "a", "rule": "all-pairs", "rest": 0.7}},
        jitter={"amplitude": 0.01},
    )
    assert model.bonds[0].rest_squared.tolist() == [(0.1 * 0.1 + 0.2 * 0.2) + 0.3 * 0.3]  # as placed, before jitter
    assert model.bonds[1].rest_squared.tolist() == [0.7 * 0.7]
