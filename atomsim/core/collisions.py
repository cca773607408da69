"""Which declared collision pairs are near, remembered over rounds; knows no forces from outside and no scenes.

A collision force fc = (c_k − c_i) · min(0, 1 − 4/d²) (paper section 2.3) is exactly zero for d ≥ 2, so pairs that far
apart may be skipped without changing a bit. A list of the pairs nearer than 2 + SKIN stays valid until some atom has
moved SKIN/2 since it was made; when it is made anew never shows in the result.
"""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Between, CollisionTable, Floats, Indices, Within
from atomsim.core.near import near_pairs, squared_distance

CONTACT_SQUARED = 4.0
"""Two unit balls touch when their centres are less than 2 apart: (1 + 1)²."""

SKIN = 0.5
"""How much further than contact a list looks [length]: a longer list against a list made more often."""


class NearList:
    """The pairs of all collision tables that may be in contact, kept up to date.

    Args:
        tables: the declared collisions.
        n_atoms: number of atoms of the model.
        skin: how much further than contact the list looks [length].
    """

    def __init__(self, tables: tuple[CollisionTable, ...], n_atoms: int, skin: float = SKIN) -> None:
        self._tables = tables
        self._skin = skin
        self._atoms = _involved(tables, n_atoms)
        self._made_at: Floats | None = None
        self.pairs: list[tuple[Indices, Indices]] = []
        """For each table the near pairs (first, second), sorted, valid for the last position asked about."""

    def update(self, position: Floats) -> bool:
        """Make the lists valid for a position, (3, n_atoms); return whether they had to be made anew."""
        if not self._tables:
            return False
        involved = position[:, self._atoms]
        if self._made_at is not None:
            moved = squared_distance(self._made_at, involved).max()
            if 4.0 * moved < 0.999999 * self._skin * self._skin:  # a little early, against rounding
                return False
        self._made_at = involved.copy()
        self.pairs = [table_pairs_near(table, position, 2.0 + self._skin) for table in self._tables]
        return True


def table_pairs_near(table: CollisionTable, position: Floats, cutoff: float) -> tuple[Indices, Indices]:
    """Return the pairs of a table nearer than a cutoff, canonical: first < second, no duplicates, sorted.

    Args:
        table: the declared collisions.
        position: atom centres [length], (3, n_atoms).
        cutoff: distance below which a pair is near [length].
    """
    n_atoms = position.shape[1]
    keys = []
    for block in table.blocks:
        if isinstance(block, Between):
            left, right = near_pairs(position[:, block.left], position[:, block.right], cutoff)
            one, other = block.left[left], block.right[right]
            first, second = np.minimum(one, other), np.maximum(one, other)
            keys.append((first * n_atoms + second)[first != second])
        else:
            left, right = near_pairs(position[:, block.atoms], None, cutoff)
            keys.append((block.atoms[left] * n_atoms + block.atoms[right])[right - left >= block.min_gap])
    key = np.unique(np.concatenate(keys))
    return key // n_atoms, key % n_atoms


def _involved(tables: tuple[CollisionTable, ...], n_atoms: int) -> slice | Indices:
    """Return the atoms that may collide at all, as a slice where they are consecutive."""
    is_involved = np.zeros(n_atoms, dtype=bool)
    for table in tables:
        for block in table.blocks:
            for atoms in (block.left, block.right) if isinstance(block, Between) else (block.atoms,):
                is_involved[atoms] = True
    return as_index(np.flatnonzero(is_involved))


def as_index(atoms: Indices) -> slice | Indices:
    """Return ascending atoms as a slice where they are consecutive: reading a slice copies nothing."""
    if atoms.size and atoms[-1] - atoms[0] == atoms.size - 1:
        return slice(int(atoms[0]), int(atoms[-1]) + 1)
    return atoms


def n_collision_pairs(table: CollisionTable) -> int:
    """Return how many pairs a table declares; those in several blocks are counted in each."""
    return sum(_n_block_pairs(block) for block in table.blocks)


def _n_block_pairs(block: Within | Between) -> int:
    """Return how many pairs of different atoms a block holds."""
    if isinstance(block, Within):
        n_reached = max(0, block.atoms.size - block.min_gap)
        return n_reached * (n_reached + 1) // 2
    n_both = int(np.intersect1d(block.left, block.right).size)
    return int(block.left.size) * int(block.right.size) - n_both * (n_both + 1) // 2
