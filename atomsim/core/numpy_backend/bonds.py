"""How bonds are cut into pieces and which form each is computed in; knows nothing of rounds, collisions or scenes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np

from atomsim.core.model import BondTable, Floats, Indices
from atomsim.core.numpy_backend.bond_forms import DENSE_BYTES, TILE_BYTES, BondForm, DenseForm, GeneralForm, OffsetForm

DENSE_FILL = 0.6
"""From this share of all pairs of a span on, computing all of them beats gathering the bound ones."""

RUN_PAIRS = 48
"""From this many pairs per run on, slices beat gathering."""

FEW_PAIRS = 300
"""Below this number of pairs calls cost more than pairs: such spans share one gathering form."""

RUN_GAP = 8
"""So many missing pairs in a row are cheaper to compute in vain than to begin a new run for."""


def joined(tables: Iterable[BondTable]) -> list[BondTable]:
    """Join tables that follow one another and share no atom, for a few long arrays are faster than many short ones.

    No sum changes by a bit: the order of tables matters only where they meet on an atom.
    """
    tables = [table for table in tables if table.first.size]
    n_atoms = max((int(table.second.max()) + 1 for table in tables), default=0)
    parts: list[list[BondTable]] = []
    taken = np.zeros(n_atoms, dtype=bool)
    for table in tables:
        touched = np.zeros(n_atoms, dtype=bool)
        touched[table.first] = touched[table.second] = True
        if parts and not (touched & taken).any():
            parts[-1].append(table)
            taken |= touched
        else:
            parts.append([table])
            taken = touched
    return [part[0] if len(part) == 1 else _join(part) for part in parts]


def _join(tables: list[BondTable]) -> BondTable:
    first = np.concatenate([table.first for table in tables])
    second = np.concatenate([table.second for table in tables])
    rest_squared = np.concatenate([table.rest_squared for table in tables])
    order = np.lexsort((second, first))
    return BondTable(tables[0].origin, first[order], second[order], rest_squared[order])


def bond_forms(table: BondTable, resting: Indices | None = None) -> list[BondForm]:
    """Cut a table into spans that share no atom and give each the form that suits it.

    Args:
        table: the pairs.
        resting: atoms whose impulse is going to be discarded; pairs between two of them are left out.

    Returns:
        Forms in order of atoms; no atom belongs to two of them.
    """
    first, second, rest_squared = table.first, table.second, table.rest_squared
    if resting is not None and resting.size and first.size:
        is_resting = np.zeros(int(second.max()) + 1, dtype=bool)
        is_resting[resting[resting < is_resting.size]] = True
        kept = ~(is_resting[first] & is_resting[second])
        first, second, rest_squared = first[kept], second[kept], rest_squared[kept]
    spans = _few_together(_side_by_side(_disjoint_spans(first, second)))
    return [_form(span, first[span.pairs], second[span.pairs], rest_squared[span.pairs]) for span in spans]


class _Span(NamedTuple):
    """Consecutive pairs, the atoms they touch, and how many dense bodies of one size these are; 0 if not dense."""

    pairs: slice
    atoms: slice
    n_bodies: int


def _disjoint_spans(first: Indices, second: Indices) -> Iterator[_Span]:
    """Cut sorted pairs wherever no pair reaches over the cut."""
    if not first.size:
        return
    reach = np.maximum.accumulate(second)
    cuts = np.flatnonzero(first[1:] > reach[:-1]) + 1
    for start, stop in pairwise([0, *cuts.tolist(), first.size]):
        atoms = slice(int(first[start]), int(reach[stop - 1]) + 1)
        n_atoms = atoms.stop - atoms.start
        is_dense = stop - start >= DENSE_FILL * n_atoms * (n_atoms - 1) / 2
        yield _Span(slice(start, stop), atoms, int(is_dense))


def _side_by_side(spans: Iterable[_Span]) -> list[_Span]:
    """Put dense bodies of one size that follow one another together, as many as one tile can hold."""
    together: list[_Span] = []
    for span in spans:
        before = together[-1] if together else None
        n_atoms = span.atoms.stop - span.atoms.start
        if (
            before is not None
            and before.n_bodies
            and span.n_bodies
            and before.atoms.stop == span.atoms.start
            and before.atoms.stop - before.atoms.start == before.n_bodies * n_atoms
            and (before.n_bodies + 1) * n_atoms * n_atoms * DENSE_BYTES <= TILE_BYTES
        ):
            together[-1] = _Span(
                slice(before.pairs.start, span.pairs.stop),
                slice(before.atoms.start, span.atoms.stop),
                before.n_bodies + 1,
            )
        else:
            together.append(span)
    return together


def _few_together(spans: Iterable[_Span]) -> Iterator[_Span]:
    """Put spans of few pairs that follow one another together."""
    for is_few, run in groupby(spans, key=lambda span: span.pairs.stop - span.pairs.start < FEW_PAIRS):
        together = list(run)
        if is_few:
            pairs = slice(together[0].pairs.start, together[-1].pairs.stop)
            together = [_Span(pairs, slice(together[0].atoms.start, together[-1].atoms.stop), 0)]
        yield from together


def _local(first: Indices, second: Indices) -> tuple[slice, Indices, Indices]:
    """Return the span of atoms that sorted pairs touch, and the pairs counted from its start."""
    atoms = slice(int(first[0]), int(second.max()) + 1)
    if not atoms.start:
        return atoms, first, second  # a large body is not copied for nothing
    return atoms, first - atoms.start, second - atoms.start


def _form(span: _Span, first: Indices, second: Indices, rest_squared: Floats) -> BondForm:
    """Choose the form for the pairs of one span."""
    atoms, first, second = _local(first, second)
    if span.n_bodies:
        return DenseForm(atoms, span.n_bodies, first, second, rest_squared)
    if first.size < FEW_PAIRS:
        return GeneralForm(atoms, first, second, rest_squared)
    order = np.lexsort((first, second - first))
    bounds = _run_bounds(first[order], second[order])
    if first.size >= RUN_PAIRS * (len(bounds) - 1):
        return OffsetForm(atoms, first[order], second[order], rest_squared[order], bounds)
    return GeneralForm(atoms, first, second, rest_squared)


def _run_bounds(first: Indices, second: Indices) -> list[int]:
    """Cut pairs sorted by (offset, first) into runs: run r is pairs bounds[r] to bounds[r + 1]."""
    cuts = np.flatnonzero((np.diff(second - first) != 0) | (np.diff(first) > RUN_GAP)) + 1
    return [0, *cuts.tolist(), first.size]
