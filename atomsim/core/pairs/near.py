"""Finding pairs of atoms that are near each other without looking at all pairs; knows no forces and no tables.

Both searches return a *superset-free* answer: exactly the pairs whose squared distance, computed as the convention
says, is below the squared cutoff. How they look for them (tiles or cells) never shows in the result.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from atomsim.core.free_memory import free_memory
from atomsim.core.model import Floats, Indices

TILE = 1 << 15
"""Pair distances computed at a time: what is known of them should stay in the cache of one core."""

DENSE_LIMIT = 128
"""Up to so many pairs per atom it is cheaper to look at all of them than to sort atoms into cells."""

STRETCH = 1 << 18
"""Pairs measured at a time: a few megabytes per array."""

Found = tuple[Indices, float]
"""Keys first · n_right + second of near pairs, and which share of all candidates has been looked at."""

LARGE = 1 << 26
"""Bytes of pairs from which on it is worth asking whether more will fit."""

COPIES = 6
"""How often the pairs found are copied, at the worst moment, until they are a table."""

_MAX_CELL = float(1 << 19)
"""Cells are counted from the middle of the scene; whatever lies further out shares the outermost cell."""

_MOST_OUTSIDE = 1000
"""So many atoms may share the outermost cells; where there are more, the cells become wider."""


def near_pairs(left: Floats, right: Floats | None, cutoff: float) -> tuple[Indices, Indices]:
    """Return all pairs nearer than a cutoff, sorted by (first, second).

    Args:
        left: positions [length], (3, n_left).
        right: positions [length], (3, n_right), or None for pairs inside `left` with first < second.
        cutoff: distance below which a pair is near [length].

    Returns:
        Indices into `left` and into `right` (or again `left`).

    Raises:
        MemoryError: so many pairs are near that they would not fit, told from the first ones found.
    """
    n_left = left.shape[1]
    n_right = n_left if right is None else right.shape[1]
    search = _by_tiles if n_left * n_right <= DENSE_LIMIT * (n_left + n_right) else _by_cells
    found: list[Indices] = []
    size = 0
    for band, share in search(left, right, cutoff):
        found.append(band)
        size += band.nbytes
        if size > LARGE and size / share * COPIES > free_memory():
            raise MemoryError(
                f"about {size / share / band.itemsize:.2g} pairs are near each other, too many for memory"
            )
    if not found:
        empty = np.empty(0, dtype=np.int64)
        return empty, empty
    key = found[0] if len(found) == 1 else np.concatenate(found)
    key.sort()
    first = key // n_right
    return first, key - first * n_right


def distinct(numbers: Sequence[Indices]) -> Indices:
    """Return whole numbers in ascending order, each once; unlike `np.unique` it loads nothing first."""
    joined = np.concatenate([np.empty(0, dtype=np.int64), *numbers])
    joined.sort()
    is_new = np.ones(joined.size, dtype=bool)
    np.not_equal(joined[1:], joined[:-1], out=is_new[1:])
    return joined[is_new]


def squared_distance(left: Floats, right: Floats) -> Floats:
    """Return (dx·dx + dy·dy) + dz·dz of positions (3, …) that broadcast against each other."""
    return _squares(right - left)


def sum_squares(difference: Floats, scratch: Floats, out: Floats) -> None:
    """Set `out` (…) to d² = (dx·dx + dy·dy) + dz·dz of differences (3, …), which may themselves be the scratch."""
    np.multiply(difference, difference, out=scratch)
    np.add(scratch[0], scratch[1], out=out)
    np.add(out, scratch[2], out=out)


def _squares(difference: Floats) -> Floats:
    """Return d² of differences (3, …), which are lost."""
    squared = np.empty(difference.shape[1:])
    sum_squares(difference, difference, squared)
    return squared


def _all_squares(left: Floats, right: Floats) -> Floats:
    """Return d² of all pairs (n_left, n_right); see `DenseForm` for the differences, which are exact."""
    rows, columns = np.ones((3, left.shape[1], 2)), np.ones((3, 2, right.shape[1]))
    rows[:, :, 0] = left
    np.negative(right, out=columns[:, 1])
    return _squares(rows @ columns)


def pair_squares(position: Floats, first: Indices, second: Indices) -> Floats:
    """Return d² of pairs of atoms, in stretches, so that no more than the result is held for long.

    Args:
        position: atom centres [length], (3, n_atoms).
        first: one atom of each pair, (n_pairs,).
        second: the other, (n_pairs,).
    """
    stretches = [slice(start, start + STRETCH) for start in range(0, max(1, first.size), STRETCH)]
    squares = [_squares(position.take(second[part], axis=1) - position.take(first[part], axis=1)) for part in stretches]
    return squares[0] if len(squares) == 1 else np.concatenate(squares)


def _by_tiles(left: Floats, right: Floats | None, cutoff: float) -> Iterator[Found]:
    """Look at all pairs, a band of rows at a time."""
    partner = left if right is None else right
    n_right = partner.shape[1]
    rows = max(1, TILE // max(1, n_right))
    for start in range(0, left.shape[1], rows):
        band = left[:, start : start + rows]
        origin = start if right is None else 0  # inside one set only partners from the band's first row on matter
        near = np.flatnonzero(_all_squares(band, partner[:, origin:]) < cutoff * cutoff)
        first, second = np.divmod(near, n_right - origin)
        first += start
        second += origin
        if right is None:
            ordered = first < second
            first, second = first[ordered], second[ordered]
        if first.size:
            yield first * n_right + second, min(1.0, (start + rows) / left.shape[1])


def _by_cells(left: Floats, right: Floats | None, cutoff: float) -> Iterator[Found]:
    """Look only at pairs in neighbouring cells of a grid.

    Atoms are sorted by cell, z fastest, so the three cells (z − 1, z, z + 1) of a column are one run of atoms:
    each atom has nine runs to look at, or, inside one set, four runs and the rest of its own column.
    """
    partner = left if right is None else right
    n_right = partner.shape[1]
    middle = np.median(partner, axis=1)
    width = _cell_width(partner, middle, cutoff)
    seconds = _sorted_by_cell(partner, middle, width)
    firsts = seconds if right is None else _sorted_by_cell(left, middle, width)
    columns = [(0, 0), (0, 1), (1, -1), (1, 0), (1, 1)] if right is None else _ALL_COLUMNS
    runs = []
    for column in columns:
        shift = (column[0] << 42) + (column[1] << 21)
        start = np.searchsorted(seconds.key, firsts.key + (shift - 1), side="left")
        if right is None and column == (0, 0):
            start = np.arange(1, n_right + 1)
        runs.append((start, np.searchsorted(seconds.key, firsts.key + (shift + 1), side="right") - start))
    n_candidates = sum(int(count.sum()) for _, count in runs)
    n_seen = 0
    for start, run in runs:
        for band in _bands(run):
            count = run[band]
            place = ragged_ranges(start[band], count)
            n_seen += place.size
            here = np.repeat(firsts.position[:, band], count, axis=1)
            near = np.flatnonzero(squared_distance(here, np.take(seconds.position, place, axis=1)) < cutoff * cutoff)
            first, second = np.repeat(firsts.atom[band], count)[near], seconds.atom[place[near]]
            if right is None:
                first, second = np.minimum(first, second), np.maximum(first, second)
            if first.size:
                yield first * n_right + second, n_seen / n_candidates


class _Cells(NamedTuple):
    """Atoms in order of the cells they are in."""

    key: Indices
    atom: Indices
    position: Floats


def _sorted_by_cell(position: Floats, middle: Floats, width: float) -> _Cells:
    key = _cell_key(position, middle, width)
    order = np.argsort(key, kind="stable")
    return _Cells(key[order], order, np.take(position, order, axis=1))


_ALL_COLUMNS = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]


def _cell_width(position: Floats, middle: Floats, cutoff: float) -> float:
    """Return the width of cells: a little more than the cutoff, against rounding, and enough to tell atoms apart."""
    width = cutoff * 1.000001
    n_inside = position.shape[1] - _MOST_OUTSIDE
    if n_inside > 0:
        distance = np.abs(position - middle[:, None])
        distance.partition(n_inside, axis=1)
        width = max(width, float(distance[:, n_inside].max()) / _MAX_CELL)
    return width


def _cell_key(position: Floats, middle: Floats, width: float) -> Indices:
    """Number the cells: x, y, z in 21 bits each."""
    with np.errstate(over="ignore"):  # what is infinitely far out is in an outermost cell
        cell = (position - middle[:, None]) / width
    np.floor(cell, out=cell)
    np.clip(cell, -_MAX_CELL, _MAX_CELL, out=cell)
    x, y, z = (cell + (_MAX_CELL + 1)).astype(np.int64)
    key: Indices = (x << 42) + (y << 21) + z
    return key


def _bands(count: Indices) -> Iterator[slice]:
    """Cut atoms into runs that together have about TILE pairs to look at."""
    ends = np.cumsum(count)
    start = 0
    while start < ends.size:
        done = ends[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, done + TILE, side="right")))
        yield slice(start, stop)
        start = stop


def ragged_ranges(start: Indices, count: Indices) -> Indices:
    """Concatenate the ranges start[i] … start[i] + count[i] − 1."""
    before = np.cumsum(count) - count
    ranges: Indices = np.arange(int(count.sum())) + np.repeat(start - before, count)
    return ranges
