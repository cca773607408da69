"""Pairs of atoms that are few bonds apart, kept by sets of twins.

Twins are atoms that are bound to one another and to the same others, so they are equally many bonds away from
everything else. All atoms of a rigid body are twins: whatever its size, it takes no more room here than one atom, and
its pairs are never listed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from atomsim.core.free_memory import free_memory
from atomsim.core.model import BondTable, BoundPairs, Indices
from atomsim.core.pairs.near import LARGE, distinct, ragged_ranges

Flags = NDArray[np.bool_]

MOST_BONDS = 20
"""So many bonds apart are counted at most."""

MOST_SETS = 1024
"""Sets of twins that are gone out from at a time."""

CANDIDATES = 1 << 21
"""About so many steps from set to set are taken at a time."""

DENSE = 16
"""Numbers below so many times their count are sorted faster by ticking them off."""


def bound_pairs(bonds: Sequence[BondTable], n_atoms: int, n_bonds: int) -> BoundPairs:
    """Return which atoms are at most so many bonds apart.

    Args:
        bonds: all bonds of a scene.
        n_atoms: its number of atoms.
        n_bonds: number of bonds, 1 or more.

    Raises:
        MemoryError: there are more such pairs than fit into memory.
    """
    graph = _graph_of(bonds, n_atoms)
    found: list[Indices] = []
    size = 0
    for sources, levels in _walks(graph, np.arange(graph.n_sets)):
        within = np.concatenate(list(islice(levels, n_bonds + 1)))
        within.sort()
        found.append(_global(within, sources, graph.n_sets))
        size += within.nbytes
        if size > LARGE and 2 * size > free_memory():
            raise MemoryError(f"too many pairs are up to {n_bonds} bonds apart to fit into memory")
    return BoundPairs(graph.twins, graph.n_sets, np.concatenate(found))


def are_bound(bound: BoundPairs, first: Indices, second: Indices) -> Flags:
    """Return for each pair of different atoms whether it is one of the bound pairs, (n_pairs,) bool."""
    return _contains(bound.sets_near, bound.twins[first] * bound.n_sets + bound.twins[second])


def first_near(bound: BoundPairs) -> Indices:
    """Return where in `sets_near` the sets near each set begin, (n_sets + 1,)."""
    return np.searchsorted(bound.sets_near, np.arange(bound.n_sets + 1) * bound.n_sets)


def n_bound_between(bound: BoundPairs, left: Indices, right: Indices) -> int:
    """Return how many bound pairs of different atoms have one in `left` and the other in `right`, both ascending."""
    both = left[np.isin(left, right, assume_unique=True)]
    n_ordered = _n_partners(bound, left, right) - both.size  # no atom is its own partner
    return n_ordered - (_n_partners(bound, both, both) - both.size) // 2


def _n_partners(bound: BoundPairs, left: Indices, right: Indices) -> int:
    """Return how many of `right`, summed over `left`, are bound to each, itself among them."""
    near = np.bincount(bound.twins[right], minlength=bound.n_sets)[bound.sets_near % bound.n_sets]
    return int(np.add.reduceat(near, first_near(bound)[:-1])[bound.twins[left]].sum())


def n_bound_within(bound: BoundPairs, atoms: Indices, min_gap: int) -> int:
    """Return how many bound pairs of ascending atoms are at least `min_gap` (1 or more) places apart among them."""
    if min_gap == 1:
        return n_bound_between(bound, atoms, atoms)
    n_places, first, twins = atoms.size, first_near(bound), bound.twins[atoms]
    place, count = np.arange(n_places), first[twins + 1] - first[twins]
    near = bound.sets_near[ragged_ranges(first[twins], count)] % bound.n_sets
    members = np.sort(twins * n_places + place)
    far = near * n_places + np.minimum(np.repeat(place, count) + min_gap, n_places)
    return int((np.searchsorted(members, (near + 1) * n_places) - np.searchsorted(members, far)).sum())


def bonds_apart(bonds: Sequence[BondTable], n_atoms: int, first: Indices, second: Indices) -> Indices:
    """Return how many bonds the atoms of each pair are apart, (n_pairs,); 0 where it is more than MOST_BONDS.

    Args:
        bonds: all bonds of a scene.
        n_atoms: its number of atoms.
        first: one atom of each pair, (n_pairs,).
        second: the other atom, a different one.
    """
    graph = _graph_of(bonds, n_atoms)
    apart = np.zeros(first.size, dtype=np.int64)
    start, goal = graph.twins[first], graph.twins[second]
    apart[start == goal] = 1
    for sources, levels in _walks(graph, distinct([start[start != goal]])):
        here = np.flatnonzero((start >= sources[0]) & (start <= sources[-1]) & (start != goal))
        wanted = np.searchsorted(sources, start[here]) * graph.n_sets + goal[here]
        for n_bonds, level in enumerate(islice(levels, MOST_BONDS + 1)):
            reached = _contains(level, wanted)
            apart[here[reached]] = n_bonds
            here, wanted = here[~reached], wanted[~reached]
            if not here.size:
                break
    return apart


@dataclass(frozen=True, slots=True)
class _Graph:
    """Which sets of twins are bound: those next to set s are partner[first[s]:first[s + 1]], ascending, with s."""

    twins: Indices
    n_sets: int
    first: Indices
    partner: Indices


def _graph_of(bonds: Sequence[BondTable], n_atoms: int) -> _Graph:
    """Find the twins among all atoms, and which of their sets are bound."""
    atom = np.arange(n_atoms)
    ends = [(table.first, table.second) for table in bonds]
    key = distinct(
        [atom * n_atoms + atom, *(one * n_atoms + other for pair in ends for one, other in (pair, pair[::-1]))]
    )
    row = key // n_atoms
    first, partner = np.searchsorted(row, np.arange(n_atoms + 1)), key - row * n_atoms
    leader = _leaders(first, partner)
    leads = np.flatnonzero(leader == atom)
    number = np.zeros(n_atoms, dtype=np.int64)
    number[leads] = np.arange(leads.size)
    twins = number[leader]
    count = first[leads + 1] - first[leads]
    pairs = np.repeat(np.arange(leads.size), count) * leads.size + twins[partner[ragged_ranges(first[leads], count)]]
    pairs = distinct([pairs])
    row = pairs // max(1, leads.size)
    return _Graph(twins, leads.size, np.searchsorted(row, np.arange(leads.size + 1)), pairs - row * leads.size)


def _leaders(first: Indices, partner: Indices) -> Indices:
    """Return the first of each atom's twins: of those whose rows, which name the atom itself too, are the same.

    Rows are first compared by a sum of mixed numbers, then one by one with that of the first atom of the same sum.
    """
    n_atoms, size = first.size - 1, np.diff(first)
    sums = np.add.reduceat(_mixed(partner), first[:-1])
    order = np.argsort(sums, kind="stable")
    is_new = np.ones(n_atoms, dtype=bool)
    is_new[1:] = sums[order[1:]] != sums[order[:-1]]
    leader = np.empty(n_atoms, dtype=np.int64)
    leader[order] = order[np.maximum.accumulate(np.where(is_new, np.arange(n_atoms), 0))]
    follower = np.flatnonzero((leader != np.arange(n_atoms)) & (size == size[leader]))
    count = size[follower]
    differs = partner[ragged_ranges(first[follower], count)] != partner[ragged_ranges(first[leader[follower]], count)]
    is_twin = np.zeros(n_atoms, dtype=bool)
    is_twin[follower] = True
    is_twin[np.repeat(follower, count)[differs]] = False
    return np.where(is_twin, leader, np.arange(n_atoms))


def _mixed(number: Indices) -> np.ndarray[tuple[int], np.dtype[np.uint64]]:
    """Return numbers that look random and are the same for the same number (the finaliser of SplitMix64)."""
    mixed = (number + 1).astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return mixed ^ (mixed >> np.uint64(31))


def _walks(graph: _Graph, sources: Indices) -> Iterator[tuple[Indices, Iterator[Indices]]]:
    """Go out from some sets, a few at a time: yield these, and for each number of bonds the sets so far away."""
    widest = int(np.diff(graph.first).max(initial=1))
    n_together = max(1, min(MOST_SETS, CANDIDATES // widest**2))
    for start in range(0, sources.size, n_together):
        together = sources[start : start + n_together]
        yield together, _levels(graph, together)


def _levels(graph: _Graph, sources: Indices) -> Iterator[Indices]:
    """Yield the sets at 0, 1, 2, … bonds from sources as keys (place in sources) · n_sets + set, ascending."""
    n_sets = graph.n_sets
    before, level = sources[:0], np.arange(sources.size) * n_sets + sources
    while level.size:
        yield level
        source, here = level // n_sets, level % n_sets
        count = graph.first[here + 1] - graph.first[here]
        step = np.repeat(source * n_sets, count) + graph.partner[ragged_ranges(graph.first[here], count)]
        step = _distinct_below(step, sources.size * n_sets)
        before, level = level, step[~(_contains(level, step) | _contains(before, step))]


def _distinct_below(numbers: Indices, limit: int) -> Indices:
    """Return whole numbers below a limit in ascending order, each once."""
    if limit > DENSE * numbers.size:
        return distinct([numbers])
    is_there = np.zeros(limit, dtype=bool)
    is_there[numbers] = True
    return np.flatnonzero(is_there)


def _global(keys: Indices, sources: Indices, n_sets: int) -> Indices:
    """Turn places in sources into sets; consecutive sources keep the order."""
    return keys + int(sources[0]) * n_sets


def _contains(numbers: Indices, wanted: Indices) -> Flags:
    """Return for each wanted number whether it is among ascending ones."""
    if not numbers.size:
        return np.zeros(wanted.size, dtype=bool)
    found: Flags = numbers[np.minimum(np.searchsorted(numbers, wanted), numbers.size - 1)] == wanted
    return found
