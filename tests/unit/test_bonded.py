"""Which atoms are few bonds apart, beside a search that goes from atom to atom."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from atomsim.core.model import Between, BondTable, CollisionTable, Origin, Within
from atomsim.core.pairs import bonded
from atomsim.core.pairs.bonded import MOST_BONDS, are_bound, bonds_apart, bound_pairs
from atomsim.core.pairs.collisions import n_collision_pairs
from atomsim.scene.language.rules import FURTHEST_BOUND

N_ATOMS = 12

ORIGIN = Origin("bonds", "b", "<scene>", 1)

Pair = tuple[int, int]


def table(*pairs: Pair) -> BondTable:
    ordered = sorted({(min(pair), max(pair)) for pair in pairs})
    first, second = np.array(ordered, dtype=np.int64).reshape(-1, 2).T
    return BondTable(ORIGIN, first, second, np.ones(first.size))


def steps_between(pairs: list[Pair], one: int, other: int) -> int:
    """Return how many bonds two atoms are apart, or 0 where no way leads from one to the other."""
    reached, n_bonds = {one}, 0
    while other not in reached:
        wider = reached | {k for pair in pairs for i, k in (pair, pair[::-1]) if i in reached}
        if wider == reached:
            return 0
        reached, n_bonds = wider, n_bonds + 1
    return n_bonds


atoms = st.integers(0, N_ATOMS - 1)

bonds = st.lists(st.tuples(atoms, atoms).filter(lambda pair: pair[0] != pair[1]), max_size=25)

cliques = st.lists(st.sets(atoms, min_size=2, max_size=6), max_size=3).map(
    lambda drawn: [pair for clique in drawn for pair in combinations(sorted(clique), 2)]
)

EVERY = np.array(list(combinations(range(N_ATOMS), 2))).T


@given(bonds, cliques, st.integers(1, 4), st.sampled_from([1, 3, 1024]), st.booleans())
def test_pairs_up_to_so_many_bonds_apart(
    loose: list[Pair], rigid: list[Pair], n_bonds: int, n_together: int, sums_tell_nothing: bool
) -> None:
    tables, pairs = [table(*loose), table(*rigid)], loose + rigid
    mixed = (lambda number: np.zeros(number.shape, dtype=np.uint64)) if sums_tell_nothing else bonded._mixed
    with patch.object(bonded, "MOST_SETS", n_together), patch.object(bonded, "_mixed", mixed):
        bound = bound_pairs(tables, N_ATOMS, n_bonds)
        apart = bonds_apart(tables, N_ATOMS, *EVERY)
    expected = [steps_between(pairs, i, k) for i, k in EVERY.T.tolist()]
    assert apart.tolist() == expected
    assert are_bound(bound, *EVERY).tolist() == [1 <= steps <= n_bonds for steps in expected]
    assert are_bound(bound, *EVERY[::-1]).tolist() == are_bound(bound, *EVERY).tolist()


@given(bonds, cliques, st.sets(atoms, min_size=1), st.sets(atoms, min_size=1), st.integers(1, 3), st.integers(1, 4))
def test_collision_pairs_are_counted_without_the_bound_ones(
    loose: list[Pair], rigid: list[Pair], left: set[int], right: set[int], n_bonds: int, min_gap: int
) -> None:
    bound = bound_pairs([table(*loose, *rigid)], N_ATOMS, n_bonds)
    one, other = (np.array(sorted(chosen)) for chosen in (left, right))
    gapped = [(i, k) for (p, i), (q, k) in combinations(enumerate(one.tolist()), 2) if q - p >= min_gap]
    crossing = sorted({(min(i, k), max(i, k)) for i in left for k in right if i != k})
    for block, pairs in ((Within(one, min_gap), gapped), (Between(one, other), crossing)):
        whole = CollisionTable(ORIGIN, (block,))
        n_bound = int(are_bound(bound, *np.array(pairs, dtype=np.int64).reshape(-1, 2).T).sum())
        assert n_collision_pairs(whole) == len(pairs)
        assert n_collision_pairs(replace(whole, bound=bound)) == len(pairs) - n_bound


def test_all_atoms_of_a_rigid_body_are_one_set() -> None:
    """Two bodies of 500, joined by one bond: beside the joint, one set each, and no pair is listed."""
    body = [(i, k) for i, k in combinations(range(500), 2)]
    both = table(*body, *((i + 500, k + 500) for i, k in body), (0, 999))
    bound = bound_pairs([both], 1000, 2)
    assert bound.n_sets == 4
    assert bound.sets_near.size == 14  # all pairs of the four, but for those of the two bodies beside the joint
    first, second = np.array([1, 1, 1, 0]), np.array([2, 999, 998, 998])
    assert are_bound(bound, first, second).tolist() == [True, True, False, True]
    assert bonds_apart([both], 1000, first, second).tolist() == [1, 2, 3, 2]


def test_the_language_and_the_core_count_equally_far() -> None:
    assert MOST_BONDS == FURTHEST_BOUND
    line = table(*((i, i + 1) for i in range(30)))
    assert bonds_apart([line], 31, np.array([0, 0]), np.array([20, 21])).tolist() == [20, 0]


def test_atoms_without_bonds_are_bound_to_nobody() -> None:
    bound = bound_pairs([], 5, 3)
    assert not are_bound(bound, np.arange(4), np.arange(1, 5)).any()


def test_too_many_pairs_are_told_before_memory_is_full() -> None:
    line = table(*((i, i + 1) for i in range(30)))
    with (
        patch.object(bonded, "LARGE", 0),
        patch.object(bonded, "free_memory", return_value=100),
        pytest.raises(MemoryError, match="too many pairs are up to 3 bonds apart"),
    ):
        bound_pairs([line], 31, 3)
