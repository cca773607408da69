"""Which groups overlap where they are set to collide, and which key of the collision would leave them out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from atomsim.core.model import CollisionTable, Indices, Model, Within
from atomsim.core.pairs.bonded import bonds_apart, bound_pairs
from atomsim.core.pairs.collisions import n_collision_pairs

MOST_NAMED = 6
"""So many pairs of groups are named; further ones are counted."""


def overlapping_groups(model: Model, first: Indices, second: Indices) -> list[str]:
    """Return which groups the atoms of some pairs belong to, and how many pairs: the most frequent first.

    Args:
        model: the compiled scene.
        first: one atom of each pair, (n_pairs,).
        second: the other, (n_pairs,).
    """
    starts = np.array([group.start for group in model.groups])
    one, other = (np.searchsorted(starts, atoms, side="right") - 1 for atoms in (first, second))
    count = np.bincount(one * starts.size + other)
    pairs = np.flatnonzero(count)
    pairs = pairs[np.argsort(-count[pairs], kind="stable")].tolist()
    named = [
        f"{count[pair]} {_both(model.groups[pair // starts.size].name, model.groups[pair % starts.size].name)}"
        for pair in pairs[:MOST_NAMED]
    ]
    n_more = int(count[pairs[MOST_NAMED:]].sum())
    return [*named, f"{n_more} of others"] if n_more else named


def _both(one: str, other: str) -> str:
    return f"inside {one}" if one == other else f"of {one} and {other}"


@dataclass(frozen=True, slots=True)
class Sparing:
    """What leaves overlapping pairs out of a collision.

    Attributes:
        keys: what to write into the collision; nothing where no key helps.
        n_left: how many pairs it would not leave out.
    """

    keys: dict[str, bool | int]
    n_left: int


def sparing(model: Model, table: CollisionTable, first: Indices, second: Indices) -> Sparing:
    """Return the key of a collision that leaves its overlapping pairs out.

    Bonds are the reason why most atoms overlap, so they come first: `except_bound` with the smallest number of bonds
    that leaves all these pairs out, else `min_gap`, else `except_bound` for some of the pairs.
    """
    apart = bonds_apart(model.bonds, model.n_atoms, first, second)
    n_left, keys = int((apart == 0).sum()), _except_bound(model, table, int(apart.max()))
    gap = _min_gap(table, first, second)
    if gap and (n_left or not keys):
        return Sparing({"min_gap": gap}, 0)
    return Sparing(keys, n_left if keys else first.size)


def _except_bound(model: Model, table: CollisionTable, n_bonds: int) -> dict[str, bool | int]:
    """Return the key that leaves out pairs up to so many bonds apart; nothing if it leaves nothing to collide."""
    if not n_bonds:
        return {}
    try:
        bound = bound_pairs(model.bonds, model.n_atoms, n_bonds)
    except MemoryError:
        return {}
    if not n_collision_pairs(replace(table, bound=bound)):
        return {}
    return {"except_bound": True if n_bonds == 1 else n_bonds}


def _min_gap(table: CollisionTable, first: Indices, second: Indices) -> int:
    """Return the `min_gap` just above the places that pairs are apart; 0 where it has no place or leaves no pair."""
    blocks = [block for block in table.blocks if isinstance(block, Within)]
    min_gap = 1 + max((_widest_gap(block.atoms, first, second) for block in blocks), default=0)
    is_remedy = len(blocks) == len(table.blocks) and any(block.atoms.size > min_gap for block in blocks)
    return min_gap if is_remedy else 0


def _widest_gap(atoms: Indices, first: Indices, second: Indices) -> int:
    """Return how many places of a selection lie between the two atoms of a pair, at most; 0 if it holds no pair."""
    inside = np.isin(first, atoms) & np.isin(second, atoms)
    gap = np.searchsorted(atoms, second[inside]) - np.searchsorted(atoms, first[inside])
    return int(gap.max(initial=0))
