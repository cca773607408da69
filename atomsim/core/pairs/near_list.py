"""Near collision pairs remembered over rounds; knows no forces and no scenes.

A list of the pairs nearer than 2 + skin stays valid until two of its atoms may have come nearer to each other by skin:
until some atom has moved skin/2 since it was made, apart from what it has in common with all others. When lists are
made anew, and how far they look, never shows in the result.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from atomsim.core.model import CollisionTable, Floats
from atomsim.core.pairs.collisions import as_index, involved_atoms, n_collision_pairs, table_pairs_near
from atomsim.core.pairs.near import squared_distance

SKIN = 0.5
"""How much further than contact the first list looks [length]: a longer list against a list made more often."""

NARROWEST_SKIN, WIDEST_SKIN = 0.1, 8.0
"""Between these the next list may look further, or less far."""

FEW_PAIRS = 1 << 17
"""So few pairs may all be listed: a list may look as far as it likes, where an atom falls out of the scene, say."""

MANY_ATOMS = 2000
"""From so many atoms on, making lists takes so much longer than looking at each that what drifts is looked at twice."""

LONGEST_DRIFT = 1e6
"""Atoms may drift so many skins together before rounding could hide that one of them approaches another."""

MAKING_COST, MAKING_COST_OF_MANY = 400, 70
"""Finding the partners of one atom takes about as long as one round of so many partners, which take longer when they
are too many for the cache."""

MANY_PAIRS = 1 << 15
"""From so many near pairs on, the cache does not hold what is known of them."""


class NearList:
    """The pairs of all collision tables that may be in contact, kept up to date.

    Args:
        tables: the declared collisions.
        n_atoms: number of atoms of the model.
        skin: how much further than contact the first lists look [length]; later ones adapt.
    """

    def __init__(self, tables: tuple[CollisionTable, ...], n_atoms: int, skin: float = SKIN) -> None:
        self._tables = tables
        self._n_updates = 0
        self._skin = skin
        self._widest_skin = widest_skin(tables)
        involved = involved_atoms(tables, n_atoms)
        self._atoms = as_index(involved)
        self._drifting = (
            [as_index(involved_atoms([table], n_atoms)) for table in tables] if involved.size >= MANY_ATOMS else []
        )
        self._made_at: Floats | None = None
        self.first, self.second = np.empty((2, 0), dtype=np.int64)
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
            if squared_distance(self._made_at[:, self._atoms], involved).max() < squared_reach(self._skin):
                return False
            if self._only_drifted(self._made_at, position):
                return False
            self._skin = self._better_skin(involved.shape[1])
        self._made_at = position.copy()
        self._n_updates = 0
        pairs = [table_pairs_near(table, position, 2.0 + self._skin) for table in self._tables]
        self.first, self.second = (np.concatenate(ends) for ends in zip(*pairs, strict=True))
        np.cumsum([first.size for first, _ in pairs], out=self.bounds[1:])
        return True

    def _only_drifted(self, made_at: Floats, position: Floats) -> bool:
        """Return whether what moved, moved along with all other atoms of its table."""
        return bool(self._drifting) and all(
            stay_apart(position[:, atoms] - made_at[:, atoms], self._skin) for atoms in self._drifting
        )

    def _better_skin(self, n_atoms: int) -> float:
        """Return how far the next list should look, after what the last one cost."""
        n_pairs = self.first.size
        making = n_atoms * (MAKING_COST if n_pairs < MANY_PAIRS else MAKING_COST_OF_MANY)
        return better_skin(self._skin, self._widest_skin, self._n_updates, making, 2 * n_pairs)


def stay_apart(moved: Floats, skin: float) -> bool:
    """Return whether no two atoms that moved so far, (3, n_atoms), can have come nearer to each other by skin.

    What is common to all of them brings none nearer: a falling block needs no new list.
    """
    drift = 0.5 * (moved.min(axis=1) + moved.max(axis=1))
    if not np.abs(drift).max() < LONGEST_DRIFT * skin:
        return False
    return bool(squared_distance(drift[:, None], moved).max() < squared_reach(skin))


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
