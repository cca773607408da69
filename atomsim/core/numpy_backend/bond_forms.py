"""Bond subtotals in three equivalent forms, dense, offset and general; knows nothing of how tables come to them.

Whatever the form, each atom's bond forces fb = (c_k − c_i) · (1 − r²/d²) (paper section 2.3) are added over partners in
increasing partner index, starting from +0.0, so the forms agree to the last bit. Positions are (3, n_atoms), one row
per component, which lets every operation run along contiguous memory.
"""

from __future__ import annotations

from itertools import accumulate, pairwise, starmap
from typing import NamedTuple, Protocol

import numpy as np

from atomsim.core.model import Floats, Indices
from atomsim.core.pairs.near import sum_squares

TILE_BYTES = 1 << 19
"""A tile of differences should stay in the cache of one core."""

DENSE_BYTES = 48
"""What a tile holds for each pair of partner and atom: differences and their squares."""


class BondForm(Protocol):
    """The pairs of a table inside one span of atoms, in the form that is fastest for them.

    Attributes:
        name: what the form is called in reports.
        atoms: the span of atoms that the pairs touch.
    """

    name: str
    atoms: slice

    def subtotal(self, position: Floats) -> Floats:
        """Return the sum of bond forces on each atom of the span, (3, n_span); valid until the next call."""


def weigh_bonds(weight: Floats, rest_squared: Floats) -> None:
    """Turn d² into the bond's weight 1 − r² · (1/d²), in place; the force on i is weight · (c_k − c_i)."""
    np.divide(1.0, weight, out=weight)
    np.multiply(rest_squared, weight, out=weight)
    np.subtract(1.0, weight, out=weight)


class DenseForm:
    """All pairs of each of some bodies at once: rows are partners, columns are atoms, and the sum runs down the rows.

    The differences x_k − x_i come from the matrix product [x_k, 1] · [1; −x_i]: both its products are exact, so its
    one addition rounds exactly as the subtraction does. Bodies of one size lie side by side; the columns of a large one
    are cut into tiles to stay in the cache.
    """

    name = "dense"

    def __init__(self, atoms: slice, n_bodies: int, first: Indices, second: Indices, rest_squared: Floats) -> None:
        n_span = atoms.stop - atoms.start
        n_atoms = n_span // n_bodies
        n_tiles = max(1, min(n_atoms // 2, round(n_span * n_atoms * DENSE_BYTES / TILE_BYTES)))
        edges = np.arange(n_tiles + 1) * n_span // n_tiles
        above, below = np.searchsorted(first, edges), _n_below(second, edges)
        by_second = np.argsort(second, kind="stable")
        self.atoms = atoms
        self._bodies = (3, n_bodies, n_atoms)
        self._tiles = []
        for tile, columns in enumerate(starmap(slice, pairwise(edges.tolist()))):
            upper, lower = slice(*above[tile : tile + 2]), by_second[slice(*below[tile : tile + 2])]
            partner = np.concatenate((second[upper], first[lower]))
            atom = np.concatenate((first[upper], second[lower]))
            rest = np.concatenate((rest_squared[upper], rest_squared[lower]))
            self._tiles.append(_DenseTile(columns, n_bodies, n_atoms, partner, atom, rest))
        self._left = np.ones((3, n_bodies, n_atoms, 2))
        self._right = np.ones((3, n_bodies, 2, n_atoms))
        largest = max(tile.rest_squared.size for tile in self._tiles)
        self._scratch = np.empty((7, largest))
        self._subtotal = np.empty(self._bodies)

    def subtotal(self, position: Floats) -> Floats:
        """Return the sum of bond forces on each atom of the span, (3, n_span); valid until the next call."""
        bodies = position[:, self.atoms].reshape(self._bodies)
        self._left[..., 0] = bodies
        np.negative(bodies, out=self._right[:, :, 1])
        for tile in self._tiles:
            shape, size = tile.rest_squared.shape, tile.rest_squared.size
            scratch = self._scratch.reshape(-1)[: 7 * size].reshape(7, *shape)
            difference, squared, weight = scratch[:3], scratch[3:6], scratch[6]
            np.matmul(self._left, self._right[..., tile.columns], out=difference.transpose(0, 2, 1, 3))
            sum_squares(difference, squared, weight)
            weight.reshape(-1)[tile.unbound] = np.inf  # no pair, no division by zero
            weigh_bonds(weight, tile.rest_squared)
            if tile.has_gaps:
                weight.reshape(-1)[tile.unbound] = 0.0
            np.multiply(difference, weight, out=difference)
            np.add.reduce(difference, axis=1, out=self._subtotal[..., tile.columns])
        return self._subtotal.reshape(3, -1)


def _n_below(atoms: Indices, edges: Indices) -> Indices:
    """Return how many of the atoms, in any order, are below each edge."""
    counts: Indices = np.concatenate(([0], np.cumsum(np.bincount(atoms, minlength=int(edges[-1])))))[edges]
    return counts


class _DenseTile:
    """The constant part of some columns of a dense form: r² per (partner, body, atom) and the places that are no pair.

    Args:
        columns: atoms of the span; all of them if there is more than one body.
        n_bodies: how many bodies lie side by side.
        n_atoms: atoms of each body.
        partner: atom of the span that pulls, (n_entries,).
        atom: atom of the span that is pulled, (n_entries,).
        rest_squared: r² of each entry [length²], (n_entries,).
    """

    def __init__(
        self, columns: slice, n_bodies: int, n_atoms: int, partner: Indices, atom: Indices, rest_squared: Floats
    ) -> None:
        n_columns = (columns.stop - columns.start) // n_bodies
        self.columns = slice(columns.start, columns.start + n_columns)
        self.rest_squared = np.zeros((n_atoms, n_bodies, n_columns))
        place = partner % n_atoms, atom // n_atoms, atom % n_atoms - columns.start
        self.rest_squared[place] = rest_squared
        is_bound = np.zeros(self.rest_squared.shape, dtype=bool)
        is_bound[place] = True
        self.unbound = np.flatnonzero(~is_bound)
        self.has_gaps = self.unbound.size > n_bodies * n_columns
        # an atom is no partner of itself either, but there the difference is zero


class OffsetForm:
    """Pairs of few distinct offsets k − i: each run of pairs is a slice, so nothing is gathered or scattered.

    A run may pass over a few atoms that are not bound at its offset (the ends of a surface's rows); their weight is
    set to zero, which adds exactly nothing.
    """

    name = "offset"

    def __init__(self, atoms: slice, first: Indices, second: Indices, rest_squared: Floats, bounds: list[int]) -> None:
        runs = [
            Run(int(second[start] - first[start]), int(first[start]), int(first[stop - 1]) + 1)
            for start, stop in pairwise(bounds)
        ]
        ends = list(accumulate((run.stop - run.start for run in runs), initial=0))
        self.atoms = atoms
        self._rest_squared = np.zeros(ends[-1])
        is_bound = np.zeros(ends[-1], dtype=bool)
        for run, begin, pairs in zip(runs, ends, starmap(slice, pairwise(bounds)), strict=False):
            place = first[pairs] + (begin - run.start)
            self._rest_squared[place] = rest_squared[pairs]
            is_bound[place] = True
        self._unbound = np.flatnonzero(~is_bound)
        self._difference = np.empty((3, ends[-1]))
        self._squared = np.empty((3, ends[-1]))
        self._weight = np.empty(ends[-1])
        self._subtotal = np.empty((3, atoms.stop - atoms.start))
        self._runs = [
            (run.upper, run.lower, self._difference[:, start:stop])
            for run, (start, stop) in zip(runs, pairwise(ends), strict=True)
        ]  # offsets rise; so, for each atom, do its partners above, and its partners below fall

    def subtotal(self, position: Floats) -> Floats:
        """Return the sum of bond forces on each atom of the span, (3, n_span); valid until the next call."""
        span, total, weight = position[:, self.atoms], self._subtotal, self._weight
        for upper, lower, force in self._runs:
            np.subtract(span[:, upper], span[:, lower], out=force)
        sum_squares(self._difference, self._squared, weight)
        weight[self._unbound] = np.inf  # no pair, no division by zero
        weigh_bonds(weight, self._rest_squared)
        weight[self._unbound] = 0.0
        np.multiply(self._difference, weight, out=self._difference)
        total.fill(0.0)
        for upper, _, force in reversed(self._runs):
            total[:, upper] -= force
        for _, lower, force in self._runs:
            total[:, lower] += force
        return total


class Run(NamedTuple):
    """Pairs (i, i + offset) for start ≤ i < stop, a few of which may not be bound."""

    offset: int
    start: int
    stop: int

    @property
    def lower(self) -> slice:
        """The pairs' lower atoms."""
        return slice(self.start, self.stop)

    @property
    def upper(self) -> slice:
        """The pairs' higher atoms."""
        return slice(self.start + self.offset, self.stop + self.offset)


class GeneralForm:
    """Any pairs: gather both ends, scatter the forces with `bincount`, which adds in the order it is given."""

    name = "general"

    def __init__(self, atoms: slice, first: Indices, second: Indices, rest_squared: Floats) -> None:
        self.atoms = atoms
        self._first = first
        self._second = second
        self._rest_squared = rest_squared
        self._n_atoms = atoms.stop - atoms.start
        self._squared = np.empty((3, first.size))
        self._weight = np.empty(first.size)
        self._scatter = Scatter(first, second, self._n_atoms)

    def subtotal(self, position: Floats) -> Floats:
        """Return the sum of bond forces on each atom of the span, (3, n_span); valid until the next call."""
        span = position[:, self.atoms]
        force = np.take(span, self._second, axis=1)
        force -= np.take(span, self._first, axis=1)
        sum_squares(force, self._squared, self._weight)
        weigh_bonds(self._weight, self._rest_squared)
        force *= self._weight
        return self._scatter.total(force)


class Scatter:
    """Sums pair forces onto atoms: −force to the second atom, +force to the first, partners in increasing order.

    Sorted pairs list an atom's lower partners where it is second, in increasing order, and its higher partners where
    it is first: all second atoms followed by all first atoms is the order the convention asks for.
    """

    def __init__(self, first: Indices, second: Indices, n_atoms: int) -> None:
        self._n_atoms = n_atoms
        atom = np.concatenate((second, first))
        self._place = np.concatenate((atom, atom + n_atoms, atom + 2 * n_atoms))
        self._weight = np.empty((3, 2, first.size))

    def total(self, force: Floats) -> Floats:
        """Return the sum on each atom, (3, n_atoms), of pair forces (3, n_pairs)."""
        np.negative(force, out=self._weight[:, 0])
        self._weight[:, 1] = force
        total = np.bincount(self._place, weights=self._weight.reshape(-1), minlength=3 * self._n_atoms)
        return np.asarray(total, dtype=np.float64).reshape(3, self._n_atoms)
