"""How near selections are: gaps, overlaps, contacts; without looking at all pairs where there are many."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atomsim.core.gauges.block import PAIRS_AT_A_TIME, Block, Memoryless, one_row
from atomsim.core.model import CollisionTable, Floats, Indices
from atomsim.core.pairs.collisions import CONTACT_SQUARED, as_index, n_collision_pairs, table_pairs_near
from atomsim.core.pairs.near import squared_distance

FEW_PAIRS = 1 << 16
"""Up to so many pairs it is cheaper to look at all of them than to find out which are near."""

FEW_DECLARED = 1 << 14
"""Up to so many pairs of declared collisions are all looked at in every frame."""

SMALLEST_LEAF = 32
"""Atoms of a selection that are boxed together, at least."""

FURTHEST_SKIN = 4.0
"""If atoms move further than this within a block [length], it is looked at in halves."""


@dataclass(frozen=True, slots=True, eq=False)
class Gap(Memoryless):
    """The least distance between the surfaces of two selections: that of atom centres, less two radii.

    Attributes:
        left: ascending atoms of one selection.
        right: ascending atoms of the other; an atom in both is no pair with itself.
    """

    left: Indices
    right: Indices
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return min |c_k − c_i| − 2, below zero where they overlap."""
        is_small = self.left.size * self.right.size <= FEW_PAIRS
        least = _least_of_all if is_small else _least_of_boxes
        return one_row(np.sqrt(least(block.position, self.left, self.right)) - 2.0)


@dataclass(frozen=True, slots=True, eq=False)
class Overlap(Memoryless):
    """How deep two selections are in one another: max(0, −gap)."""

    gap: Gap
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the depth."""
        return np.maximum(0.0, -self.gap.measure(block, memory))


@dataclass(frozen=True, slots=True, eq=False)
class Contacts(Memoryless):
    """The number of pairs that collisions declare, with centres less than 2 apart.

    Attributes:
        tables: the declared collisions; a pair in two of them counts twice.
        sides: which atoms one and the other end of a pair may be, (n_atoms,) bool each; the same pair of ends is
            counted once.
    """

    tables: tuple[CollisionTable, ...]
    sides: tuple[NDArray[np.bool_], NDArray[np.bool_]]
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the number of pairs in contact."""
        count = np.zeros((1, block.n_frames))
        for table in self.tables:
            count += self._count(table, block.position)
        return count

    def _count(self, table: CollisionTable, position: Floats) -> Floats:
        """Count pairs of one table, among those that may come near in any of the frames, (n_frames,)."""
        n_frames = position.shape[2]
        first_frame = np.ascontiguousarray(position[:, :, 0])
        reach = np.inf
        if n_collision_pairs(table) > FEW_DECLARED:
            moved = np.sqrt(squared_distance(first_frame[:, :, None], position).max())
            if n_frames > 1 and not 2.0 * moved < FURTHEST_SKIN:
                halves = np.array_split(position, 2, axis=2)
                return np.concatenate([self._count(table, half) for half in halves])
            reach = 2.0 + 2.000001 * moved
        first, second = table_pairs_near(table, first_frame, reach)
        one, other = self.sides
        is_asked = (one[first] & other[second]) | (other[first] & one[second])
        first, second = first[is_asked], second[is_asked]
        count = np.zeros(n_frames)
        step = max(1, PAIRS_AT_A_TIME // n_frames)
        for start in range(0, first.size, step):
            part = slice(start, start + step)
            squared = squared_distance(position.take(first[part], axis=1), position.take(second[part], axis=1))
            count += np.count_nonzero(squared < CONTACT_SQUARED, axis=0)
        return count


def _least_of_all(position: Floats, left: Indices, right: Indices) -> Floats:
    """Return the least d² of all pairs, (n_frames,), one atom of the smaller side after the other."""
    few, many = sorted((left, right), key=len)
    partners = position[:, as_index(many)]
    least = np.full(position.shape[2], np.inf)
    for atom in few.tolist():
        squared = squared_distance(position[:, [atom]], partners)
        squared[many == atom] = np.inf
        np.minimum(least, squared.min(axis=0), out=least)
    return least


def _least_of_boxes(position: Floats, left: Indices, right: Indices) -> Floats:
    """Return the least d² of all pairs, (n_frames,), looking only into boxes that may hold it."""
    sides = [_leaves(position[:, :, 0], atoms) for atoms in (left, right)]
    return np.array([_least_in_frame(position[:, :, frame], *sides) for frame in range(position.shape[2])])


class _Leaves(NamedTuple):
    """The atoms of a selection, those near each other together."""

    atoms: Indices
    starts: Indices

    def of(self, leaf: int) -> Indices:
        """Return the atoms of one leaf."""
        stop = self.starts[leaf + 1] if leaf + 1 < self.starts.size else self.atoms.size
        return self.atoms[self.starts[leaf] : stop]


def _leaves(position: Floats, atoms: Indices) -> _Leaves:
    """Halve a selection across its longest side until the parts are small."""
    most = max(SMALLEST_LEAF, int(np.sqrt(atoms.size)))
    parts, done = [atoms], []
    while parts:
        part = parts.pop()
        if part.size <= most:
            done.append(part)
            continue
        places = position[:, part]
        longest = int(np.argmax(places.max(axis=1) - places.min(axis=1)))
        order = np.argpartition(places[longest], part.size // 2)
        parts += [part[order[: part.size // 2]], part[order[part.size // 2 :]]]
    sizes = np.array([part.size for part in done])
    return _Leaves(np.concatenate(done), np.cumsum(sizes) - sizes)


def _least_in_frame(position: Floats, left: _Leaves, right: _Leaves) -> float:
    """Return the least d² of one frame: boxes that are further apart than a pair already found hold no nearer one."""
    if not np.isfinite(position[:, left.atoms]).all() or not np.isfinite(position[:, right.atoms]).all():
        return np.nan
    low, high = _boxes(position, left)
    other_low, other_high = _boxes(position, right)
    apart = np.maximum(low[:, :, None] - other_high[:, None], other_low[:, None] - high[:, :, None]).clip(min=0.0)
    bound = (apart[0] * apart[0] + apart[1] * apart[1]) + apart[2] * apart[2]
    least = np.inf
    order = np.argsort(bound, axis=None, kind="stable")
    for pair in order.tolist():
        one, other = divmod(pair, bound.shape[1])
        if bound[one, other] * 0.999999 > least:  # a little less, against rounding
            break
        first, second = left.of(one), right.of(other)
        squared = squared_distance(position[:, first, None], position[:, None, second])
        squared[first[:, None] == second] = np.inf
        least = min(least, float(squared.min()))
    return least


def _boxes(position: Floats, leaves: _Leaves) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner of the box of every leaf, (3, n_leaves)."""
    places = position[:, leaves.atoms]
    return np.minimum.reduceat(places, leaves.starts, axis=1), np.maximum.reduceat(places, leaves.starts, axis=1)
