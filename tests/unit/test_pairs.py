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


COPIED: dict[str, Any] = {
    "hub": atoms_at((0, 0, 0), (0, 0, 1)),
    "spoke": {"shape": "string", "from": [1, 0, 0], "to": [3, 0, 0], "count": 3, "copies": {"count": 3, "axis": "z"}},
    "rim": {
        "shape": "ring",
        "count": 4,
        "radius": 1,
        "axis": "y",
        "centre": [5, 0, 0],
        "copies": {"count": 3, "axis": "z"},
    },
    "tile": {
        "shape": "plane",
        "counts": [2, 2],
        "step_x": [1, 0, 0],
        "step_y": [0, 1, 0],
        "centre": [0, 0, 9],
        "copies": {"count": 2, "step": [1.5, 0, 0]},
    },
}
"""Atoms 0–1; 2–4, 5–7, 8–10; 11–14, 15–18, 19–22; 23–26, 27–30."""


@pytest.mark.parametrize(
    ("bonds", "expected"),
    [
        (
            {"within": "spoke", "rule": "all-pairs"},
            [(2, 3), (2, 4), (3, 4), (5, 6), (5, 7), (6, 7), (8, 9), (8, 10), (9, 10)],
        ),
        ({"within": "spoke.1", "rule": "neighbour"}, [(5, 6), (6, 7)]),
        ({"within": "spoke[1:]", "rule": "neighbour"}, [(3, 4), (6, 7), (9, 10)]),
        ({"within": "spoke", "rule": "pairs", "pairs": [[2, 0]]}, [(2, 4), (5, 7), (8, 10)]),
        ({"within": "rim.2", "rule": "neighbour"}, [(19, 20), (19, 22), (20, 21), (21, 22)]),
        (
            {"within": "rim", "rule": "neighbour", "closed": False, "reach": 9},
            [(a + i, a + k) for a in (11, 15, 19) for i in range(4) for k in range(i + 1, 4)],
        ),
        (
            {"within": "tile", "rule": "distance-threshold", "threshold": 1.2},
            [(23, 24), (23, 25), (24, 26), (25, 26), (27, 28), (27, 29), (28, 30), (29, 30)],
        ),
        (
            {"within": "tile[:, 0]", "rule": "distance-threshold", "threshold": 2, "metric": "grid"},
            [(23, 24), (27, 28)],
        ),
        ({"between": ["hub[0]", "spoke[0]"], "rule": "all-pairs"}, [(0, 2), (0, 5), (0, 8)]),
        ({"between": ["spoke[-1]", "rim[0]"], "rule": "all-pairs"}, [(4, 11), (7, 15), (10, 19)]),
        ({"between": ["rim", "spoke"], "rule": "pairs", "pairs": [[3, 1]]}, [(3, 14), (6, 18), (9, 22)]),
        ({"between": ["spoke", "hub"], "rule": "distance-threshold", "threshold": 1.1}, [(0, 2), (0, 5), (0, 8)]),
        ({"between": ["spoke.0[-1]", "spoke.1[-1]"], "rule": "all-pairs"}, [(4, 7)]),
        (
            {"between": [["hub[1]", "rim[2]"], "spoke[1]"], "rule": "all-pairs"},
            [(1, 3), (1, 6), (1, 9), (3, 13), (6, 17), (9, 21)],
        ),
        ({"between": ["spoke", "spoke"], "rule": "pairs", "pairs": [[0, 2]]}, [(2, 4), (5, 7), (8, 10)]),
    ],
)
def test_bonds_go_copy_by_copy(bonds: dict[str, Any], expected: list[tuple[int, int]]) -> None:
    model, _ = compiled(COPIED, bonds={"b": bonds})
    (table,) = model.bonds
    assert list(zip(table.first.tolist(), table.second.tolist(), strict=True)) == expected
