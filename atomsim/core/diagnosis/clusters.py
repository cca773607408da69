"""Rigid clusters of a body, and atoms that are too loosely bound to be part of any, by counting bonds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Indices
from atomsim.core.pairs.near import ragged_ranges

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Bars:
    """Bonds as they take freedoms from a body: pairs of places of its atoms, each pair once, (n_bars,) each."""

    first: Indices
    second: Indices

    def among(self, is_left: Mask) -> Bars:
        """Return those between some atoms."""
        kept = is_left[self.first] & is_left[self.second]
        return Bars(self.first[kept], self.second[kept])

    def between(self, part: Indices) -> Bars:
        """Return those between different parts; −1 is one part, too."""
        kept = part[self.first] != part[self.second]
        return Bars(self.first[kept], self.second[kept])


@dataclass(frozen=True, slots=True, eq=False)
class _Graph:
    """The atoms that each atom has bars to: partner[start[atom]:start[atom + 1]]."""

    start: Indices
    partner: Indices

    @classmethod
    def of(cls, bars: Bars, n_atoms: int) -> _Graph:
        ends, partners = np.concatenate((bars.first, bars.second)), np.concatenate((bars.second, bars.first))
        order = np.argsort(ends, kind="stable")
        start = np.concatenate(([0], np.cumsum(np.bincount(ends, minlength=n_atoms))))
        return cls(start, partners[order])

    def partners(self, atom: int) -> Indices:
        return self.partner[self.start[atom] : self.start[atom + 1]]

    def partners_of_all(self, atoms: Indices) -> Indices:
        """Return the partners of some atoms, one after the other."""
        return self.partner[ragged_ranges(self.start[atoms], self.start[atoms + 1] - self.start[atoms])]


def prune(bars: Bars, n_atoms: int, is_held: Mask) -> tuple[int, Mask]:
    """Take away atoms that have up to three bars to what is left, one after the other.

    Such bars are independent of all others in generic position, so each takes one freedom.

    Returns:
        How many freedoms the bars of these atoms take, and which atoms are left, held ones among them.
    """
    graph = _Graph.of(bars, n_atoms)
    degree = np.diff(graph.start)
    is_left = np.ones(n_atoms, dtype=bool)
    waiting = np.flatnonzero((degree <= 3) & ~is_held).tolist()
    n_taken = 0
    while waiting:
        atom = waiting.pop()
        if not is_left[atom]:
            continue
        is_left[atom] = False
        n_taken += int(degree[atom])
        partners = graph.partners(atom)
        degree[partners] -= 1
        waiting += partners[(degree[partners] <= 3) & is_left[partners] & ~is_held[partners]].tolist()
    return n_taken, is_left


def clusters(bars: Bars, n_atoms: int, is_held: Mask) -> Indices:
    """Join atoms to rigid clusters, as far as triangles and three bars to a cluster do it.

    Returns:
        The cluster of every atom, (n_atoms,): −1 for held atoms and what is rigidly bound to them; an atom that is in
        no cluster is one by itself.
    """
    graph = _Graph.of(bars, n_atoms)
    cluster = np.arange(n_atoms)
    is_free = ~is_held
    if is_held.any():
        _grow(graph, np.flatnonzero(is_held), cluster, is_free, -1)
    for atom in np.flatnonzero(np.diff(graph.start) >= 2).tolist():
        seed = _triangle(graph, atom, is_free) if is_free[atom] else None
        if seed is not None:
            _grow(graph, seed, cluster, is_free, atom)
    return cluster


def _triangle(graph: _Graph, atom: int, is_free: Mask) -> Indices | None:
    """Return three free atoms with bars to one another, one of them given, or None."""
    partners = graph.partners(atom)
    partners = partners[is_free[partners]]
    for partner in partners.tolist():
        common = np.intersect1d(graph.partners(partner), partners, assume_unique=True)
        if common.size:
            return np.array([atom, partner, int(common[0])])
    return None


def _grow(graph: _Graph, seed: Indices, cluster: Indices, is_free: Mask, name: int) -> None:
    """Join to a cluster whatever has three bars to it, until nothing more has."""
    n_bars = np.zeros(cluster.size, dtype=np.int64)
    joining = seed
    while joining.size:
        cluster[joining] = name
        is_free[joining] = False
        np.add.at(n_bars, graph.partners_of_all(joining), 1)
        joining = np.flatnonzero((n_bars >= 3) & is_free)
