"""Which declared collision pairs are near, remembered over rounds; knows no forces from outside and no scenes.

A collision force fc = (c_k − c_i) · min(0, 1 − 4/d²) (paper section 2.3) is exactly zero for d ≥ 2, so pairs that far
apart may be skipped without changing a bit. A list of the pairs nearer than 2 + skin stays valid until some atom has
moved skin/2 since it was made; when it is made anew, and how far it looks, never shows in the result.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from atomsim.core.model import Between, CollisionTable, Floats, Indices, Within
from atomsim.core.near import near_pairs, squared_distance

CONTACT_SQUARED = 4.0
"""Two unit balls touch when their centres are less than 2 apart: (1 + 1)²."""

SKIN = 0.5
"""How much further than contact the first list looks [length]: a longer list against a list made more often."""

NARROWEST_SKIN, WIDEST_SKIN = 0.1, 8.0
"""Between these the next list may look further, or less far."""

FEW_PAIRS = 1 << 17
"""So few pairs may all be listed: a list may look as far as it likes, where an atom falls out of the scene, say."""

MAKING_COST = 400
"""Finding the partners of one atom takes about as long as one round of so many partners."""


class NearList:
    """The pairs of all collision tables that may be in contact, kept up to date.

    Args:
        tables: the declared collisions.
        n_atoms: number of atoms of the model.
        skin: how much further than contact the first list looks [length]; later ones adapt.
    """

    def __init__(self, tables: tuple[CollisionTable, ...], n_atoms: int, skin: float = SKIN) -> None:
        self._tables = tables
        self._n_updates = 0
        self._skin = skin
        self._widest_skin = widest_skin(tables)
        self._atoms = as_index(involved_atoms(tables, n_atoms))
        self._made_at: Floats | None = None
        none = np.empty(0, dtype=np.int64)
        self.first, self.second = none, none
        """The near pairs of all tables, table after table and each sorted, valid for the last position asked about."""
        self.bounds = np.zeros(len(tables) + 1, dtype=np.int64)
        """The near pairs of a table are those from bounds[table] to bounds[table + 1]."""

    def update(self, position: Floats) -> bool:
        """Make the lists valid for a position, (3, n_atoms); return whether they had to be made anew."""
        if not self._tables:
            return False
        involved = position[:, self._atoms]
        self._n_updates += 1
        if self._made_at is not None:
            if squared_distance(self._made_at, involved).max() < squared_reach(self._skin):
                return False
            making = MAKING_COST * involved.shape[1]
            self._skin = better_skin(self._skin, self._widest_skin, self._n_updates, making, 2 * self.first.size)
        self._made_at = involved.copy()
        self._n_updates = 0
        pairs = [table_pairs_near(table, position, 2.0 + self._skin) for table in self._tables]
        self.first, self.second = (np.concatenate(ends) for ends in zip(*pairs, strict=True))
        np.cumsum([first.size for first, _ in pairs], out=self.bounds[1:])
        return True


def squared_reach(skin: float) -> float:
    """Return the squared way that an atom may move before a list ends to be valid; a little less, against rounding."""
    return 0.25 * 0.999999 * skin * skin


def widest_skin(tables: Iterable[CollisionTable]) -> float:
    """Return how much further than contact lists may look without danger of becoming huge [length]."""
    return 1e6 if sum(map(n_collision_pairs, tables)) <= FEW_PAIRS else WIDEST_SKIN


def better_skin(skin: float, widest: float, n_rounds: int, making: float, n_near: int) -> float:
    """Return how far the next list should look, so that making lists costs one to four times as much as using them.

    Args:
        skin: how much further than contact the last list looked [length].
        widest: how much further it may look [length].
        n_rounds: rounds that it was valid for.
        making: what making it cost, in partners used in one round.
        n_near: partners it listed, over all these atoms.
    """
    using = n_near * n_rounds
    if making > 4 * using:
        return min(1.4 * skin, widest)
    return max(skin / 1.4, NARROWEST_SKIN) if making < using else skin


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
    if len(table.blocks) == 1 and isinstance(table.blocks[0], Within):
        return found[0]  # sorted as it is
    n_atoms = position.shape[1]
    key = np.unique(np.concatenate([first * n_atoms + second for first, second in found]))
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
    return sum(_n_block_pairs(block) for block in table.blocks)


def _n_block_pairs(block: Within | Between) -> int:
    """Return how many pairs of different atoms a block holds."""
    if isinstance(block, Within):
        n_reached = max(0, block.atoms.size - block.min_gap)
        return n_reached * (n_reached + 1) // 2
    n_both = int(np.intersect1d(block.left, block.right).size)
    return int(block.left.size) * int(block.right.size) - n_both * (n_both + 1) // 2
