"""How far selections reach: lowest and highest atoms, boxes, radii; and how much their bonds are stretched."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Literal

import numpy as np

from atomsim.core.gauges.block import PAIRS_AT_A_TIME, Atoms, Block, Memoryless, dot, length, one_row, ordered_sum
from atomsim.core.gauges.motion import mean
from atomsim.core.model import Floats, Indices


@dataclass(frozen=True, slots=True, eq=False)
class Level(Memoryless):
    """The coordinate of the lowest or highest of some atom centres along an axis."""

    atoms: Atoms
    axis: int
    which: Literal["lowest", "highest"]
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the least or largest coordinate."""
        along = block.position[self.axis, self.atoms]
        return one_row(along.min(axis=0) if self.which == "lowest" else along.max(axis=0))


@dataclass(frozen=True, slots=True, eq=False)
class Extent(Memoryless):
    """The size of the box around some atom centres, along some axes."""

    atoms: Atoms
    axes: tuple[int, ...] = (0, 1, 2)

    @property
    def n_columns(self) -> int:
        return len(self.axes)

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the largest less the least coordinate per axis."""
        along = block.position[list(self.axes)][:, self.atoms]
        return np.asarray(along.max(axis=1) - along.min(axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class Radius(Memoryless):
    """The distance from the centroid of some atoms to the nearest or farthest of them."""

    atoms: Atoms
    which: Literal["inner", "outer"]
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the least or largest |c − centroid|."""
        position = block.position[:, self.atoms]
        offset = position - mean(position)[:, None]
        squared = dot(offset, offset)
        return one_row(np.sqrt(squared.min(axis=0) if self.which == "inner" else squared.max(axis=0)))


@dataclass(frozen=True, slots=True, eq=False)
class Strain(Memoryless):
    """The strain d/r − 1 of some bonds: the largest, the least, or the mean.

    Attributes:
        first: one atom of each bond, (n_bonds,) int64.
        second: the other, (n_bonds,) int64.
        rest: the desired distance r of each, above zero [length], (n_bonds,) float64.
        which: what is told of them.
    """

    first: Indices
    second: Indices
    rest: Floats
    which: Literal["max", "min", "mean"]
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return max, min or Σ / n over the bonds, some of which are looked at at a time."""
        step = max(1, PAIRS_AT_A_TIME // block.n_frames)
        parts = (self._of(slice(start, start + step), block.position) for start in range(0, self.first.size, step))
        if self.which == "mean":
            total = ordered_sum(next(parts))
            for part in parts:
                total = ordered_sum(np.concatenate([total[None], part]))
            return one_row(total / self.first.size)
        extreme = np.maximum if self.which == "max" else np.minimum
        return one_row(reduce(extreme, (extreme.reduce(part, axis=0) for part in parts)))

    def _of(self, bonds: slice, position: Floats) -> Floats:
        """Return the strain of some bonds, (n, n_frames)."""
        way = position.take(self.second[bonds], axis=1) - position.take(self.first[bonds], axis=1)
        return np.asarray(length(way) / self.rest[bonds, None] - 1.0)
