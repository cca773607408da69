"""Which declared pairs may touch, and how the list of near ones is kept."""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Between, CollisionTable, Origin, Within
from atomsim.core.pairs.collisions import as_index, table_pairs_near

ORIGIN = Origin("collisions", "c", "<scene>", 1)

LINE = np.array([np.arange(8) * 0.5, np.zeros(8), np.zeros(8)])


def table_of(*blocks: Within | Between) -> CollisionTable:
    return CollisionTable(ORIGIN, blocks)


def pairs(table: CollisionTable, cutoff: float) -> list[tuple[int, int]]:
    first, second = table_pairs_near(table, LINE, cutoff)
    return list(zip(first.tolist(), second.tolist(), strict=True))


def test_within_counts_its_gap_in_places_of_the_selection() -> None:
    atoms = np.array([0, 2, 4, 6])
    assert pairs(table_of(Within(atoms, 1)), 1.1) == [(0, 2), (2, 4), (4, 6)]
    assert pairs(table_of(Within(atoms, 2)), 2.1) == [(0, 4), (2, 6)]


def test_between_takes_sides_in_any_order_and_no_atom_with_itself() -> None:
    assert pairs(table_of(Between(np.array([4, 5]), np.array([3]))), 0.6) == [(3, 4)]
    assert pairs(table_of(Between(np.array([3, 4]), np.array([3, 4, 5]))), 0.6) == [(3, 4), (4, 5)]


def test_a_pair_of_several_blocks_counts_once() -> None:
    everything = Within(np.arange(8), 1)
    assert pairs(table_of(everything, everything, Between(np.arange(8), np.arange(8))), 0.6) == [
        (i, i + 1) for i in range(7)
    ]


def test_consecutive_atoms_are_read_as_a_slice() -> None:
    assert as_index(np.array([3, 4, 5])) == slice(3, 6)
    assert as_index(np.array([3])) == slice(3, 4)
    scattered = np.array([3, 5])
    assert as_index(scattered) is scattered
