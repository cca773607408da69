"""Which pairs the declared collisions are, and which of them are near; knows no forces from outside and no scenes.

A collision force fc = (c_k − c_i) · min(0, 1 − 4/d²) (paper section 2.3) is exactly zero for d ≥ 2, so pairs that far
apart may be skipped without changing a bit.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from atomsim.core.model import Between, BoundPairs, CollisionTable, Floats, Indices, Within
from atomsim.core.pairs.bonded import are_bound, n_bound_between, n_bound_within
from atomsim.core.pairs.near import distinct, near_pairs

CONTACT_SQUARED = 4.0
"""Two unit balls touch when their centres are less than 2 apart: (1 + 1)²."""


def table_pairs_near(table: CollisionTable, position: Floats, cutoff: float) -> tuple[Indices, Indices]:
    """Return the pairs of a table nearer than a cutoff, canonical: first < second, no duplicates, sorted.

    Args:
        table: the declared collisions.
        position: atom centres [length], (3, n_atoms).
        cutoff: distance below which a pair is near [length].

    Raises:
        MemoryError: so many pairs are near that they do not fit.
    """
    try:
        found = [_block_pairs_near(block, position, cutoff) for block in table.blocks]
    except MemoryError as error:
        raise MemoryError(f"{table.origin}: {error}") from None
    first, second = found[0] if _is_sorted(table) else _joined(found, position.shape[1])
    if table.bound is not None:
        apart = ~are_bound(table.bound, first, second)
        first, second = first[apart], second[apart]
    return first, second


def _is_sorted(table: CollisionTable) -> bool:
    """Return whether the pairs of a table's blocks are canonical as they are found."""
    return len(table.blocks) == 1 and isinstance(table.blocks[0], Within)


def _joined(found: Sequence[tuple[Indices, Indices]], n_atoms: int) -> tuple[Indices, Indices]:
    """Join the pairs of several blocks, each once, sorted."""
    key = distinct([first * n_atoms + second for first, second in found])
    first = key // n_atoms
    return first, key - first * n_atoms


def _block_pairs_near(block: Within | Between, position: Floats, cutoff: float) -> tuple[Indices, Indices]:
    """Return the near pairs of a block, first < second."""
    if isinstance(block, Between):
        left, right = near_pairs(position[:, block.left], position[:, block.right], cutoff)
        one, other = block.left[left], block.right[right]
        apart = one != other
        return np.minimum(one, other)[apart], np.maximum(one, other)[apart]
    left, right = near_pairs(position[:, as_index(block.atoms)], None, cutoff)
    if block.min_gap > 1:
        apart = right - left >= block.min_gap
        left, right = left[apart], right[apart]
    return block.atoms[left], block.atoms[right]


def involved_atoms(tables: Iterable[CollisionTable], n_atoms: int) -> Indices:
    """Return which of the atoms 0 … n_atoms − 1 may collide at all, ascending."""
    is_involved = np.zeros(n_atoms, dtype=bool)
    for table in tables:
        for block in table.blocks:
            for atoms in (block.left, block.right) if isinstance(block, Between) else (block.atoms,):
                is_involved[atoms] = True
    return np.flatnonzero(is_involved)


def as_index(atoms: Indices) -> slice | Indices:
    """Return ascending atoms as a slice where they are consecutive: reading a slice copies nothing."""
    if atoms.size and atoms[-1] - atoms[0] == atoms.size - 1:
        return slice(int(atoms[0]), int(atoms[-1]) + 1)
    return atoms


def n_collision_pairs(table: CollisionTable) -> int:
    """Return how many pairs a table declares; those in several blocks are counted in each."""
    n_bound = 0 if table.bound is None else sum(_n_bound_pairs(block, table.bound) for block in table.blocks)
    return sum(_n_block_pairs(block) for block in table.blocks) - n_bound


def _n_bound_pairs(block: Within | Between, bound: BoundPairs) -> int:
    """Return how many pairs of a block do not collide because they are bound."""
    if isinstance(block, Within):
        return n_bound_within(bound, block.atoms, block.min_gap)
    return n_bound_between(bound, block.left, block.right)


def _n_block_pairs(block: Within | Between) -> int:
    """Return how many pairs of different atoms a block holds."""
    if isinstance(block, Within):
        n_reached = max(0, block.atoms.size - block.min_gap)
        return n_reached * (n_reached + 1) // 2
    n_both = int(np.isin(block.left, block.right, assume_unique=True).sum())
    return int(block.left.size) * int(block.right.size) - n_both * (n_both + 1) // 2
