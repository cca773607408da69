"""Which pairs of atoms a collision table declares, and whether two tables declare the same."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import Between, CollisionTable, Indices, Within
from atomsim.core.pairs.bonded import are_bound
from atomsim.findings.subject import Mask

Block = Within | Between

MOST_TRIED = 300
"""So many atoms of either set are tried, about, where bound pairs are left out."""


def is_declared(table: CollisionTable, first: Indices, second: Indices) -> Mask:
    """Return which pairs of atoms a table lets collide, (n_pairs,)."""
    mentioned = is_mentioned(table, first, second)
    return mentioned if table.bound is None else mentioned & ~are_bound(table.bound, first, second)


def is_mentioned(table: CollisionTable, first: Indices, second: Indices) -> Mask:
    """Return which pairs of atoms a table speaks of, if only to leave them out as bound, (n_pairs,)."""
    mentioned = np.zeros(first.size, dtype=bool)
    for block in table.blocks:
        mentioned |= _is_in(block, first, second)
    return mentioned


def _is_in(block: Block, first: Indices, second: Indices) -> Mask:
    if isinstance(block, Between):
        straight = np.isin(first, block.left) & np.isin(second, block.right)
        return straight | (np.isin(first, block.right) & np.isin(second, block.left))
    inside = np.isin(first, block.atoms) & np.isin(second, block.atoms)
    gap = np.abs(np.searchsorted(block.atoms, first) - np.searchsorted(block.atoms, second))
    return np.asarray(inside & (gap >= block.min_gap))


def common_pair(one: CollisionTable, other: CollisionTable) -> tuple[int, int] | None:
    """Return two atoms that both tables let collide, or None.

    Limitations: where bound pairs are left out, of very large sets only some atoms are tried.
    """
    for block in one.blocks:
        for partner in other.blocks:
            for left, right in _common_sides(block, partner):
                for first, second in _candidates(left, right, only_ends=one.bound is None and other.bound is None):
                    found = is_declared(one, first, second) & is_declared(other, first, second) & (first != second)
                    if found.any():
                        place = int(found.argmax())
                        return int(first[place]), int(second[place])
    return None


def sides(table: CollisionTable) -> list[tuple[Indices, Indices]]:
    """Return the two sides of every block of a table; those inside a selection are twice the same."""
    return [_sides(block) for block in table.blocks]


def _sides(block: Block) -> tuple[Indices, Indices]:
    return (block.left, block.right) if isinstance(block, Between) else (block.atoms, block.atoms)


def _common_sides(one: Block, other: Block) -> Iterator[tuple[Indices, Indices]]:
    """Yield sets of atoms such that every pair from both sets is in both blocks, but for `min_gap`."""
    partner_left, partner_right = _sides(other)
    for left, right in (_sides(one), _sides(one)[::-1]):
        yield (
            np.intersect1d(left, partner_left, assume_unique=True),
            np.intersect1d(right, partner_right, assume_unique=True),
        )


def _candidates(left: Indices, right: Indices, *, only_ends: bool) -> Iterator[tuple[Indices, Indices]]:
    """Yield pairs from two ascending sets, first < second; those of their ends are furthest apart in any selection."""
    if not left.size or not right.size:
        return
    sets = [(left[[0, -1]], right[[-1, 0]])]
    if not only_ends:
        some, others = (atoms[:: max(1, atoms.size // MOST_TRIED)] for atoms in (left, right))
        sets.append((np.repeat(some, others.size), np.tile(others, some.size)))
    for one, other in sets:
        yield np.minimum(one, other), np.maximum(one, other)
