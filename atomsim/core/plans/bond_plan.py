"""Lays bonds out as tiles and rows for the kernels; knows no positions and no rounds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from atomsim.core.model import BondTable, Floats, Indices
from atomsim.core.plans.records import LANES, UNBOUND, Bonds

PART_ENTRIES = 1 << 20
"""Bonds laid out at a time, each seen from both of its atoms: some tens of megabytes."""

PASS_ENTRIES = 12
"""A pass over a tile takes as long as so many entries of rows."""


def plan_bonds(tables: Sequence[BondTable], atoms: range, held: Indices, margin: int) -> Bonds:
    """Lay out the bonds of some atoms.

    Args:
        tables: the bonds.
        atoms: the atoms whose subtotals are wanted; partners may be any.
        held: atoms whose impulse is going to be discarded; nothing is computed for them.
        margin: slot of atom 0.
    """
    layout = _Layout(margin)
    for table in tables:
        cuts = _cuts(table)
        for part in _parts(table, atoms):
            layout.add_tiles(*_seen_from(table, part, held), cuts)
        layout.end_table()
    return layout.finish()


def _parts(table: BondTable, atoms: range) -> Iterator[range]:
    """Cut atoms into parts of whole tiles, few enough to be laid out in little memory."""
    n_parts = 1 + 2 * table.first.size // PART_ENTRIES
    n_atoms = LANES * (1 + len(atoms) // (LANES * n_parts))
    yield from (atoms[start : start + n_atoms] for start in range(0, len(atoms), n_atoms))


def _seen_from(table: BondTable, atoms: range, held: Indices) -> tuple[Indices, Indices, Floats]:
    """Return the bonds of some atoms as (atom, partner, r²), sorted by (atom, partner)."""
    above = slice(*np.searchsorted(table.first, (atoms.start, atoms.stop)).tolist())
    below = np.flatnonzero((table.second >= atoms.start) & (table.second < atoms.stop))
    atom = np.concatenate((table.second[below], table.first[above]))  # lower partners first
    partner = np.concatenate((table.first[below], table.second[above]))  # each half is sorted by partner
    rest_squared = np.concatenate((table.rest_squared[below], table.rest_squared[above]))
    wanted = np.flatnonzero(~np.isin(atom, held))
    order = wanted[np.argsort(atom[wanted], kind="stable")]
    return atom[order], partner[order], rest_squared[order]


def _cuts(table: BondTable) -> Indices:
    """Return the atoms that no bond reaches over: all before are bound among themselves only."""
    reach = np.maximum.accumulate(table.second)
    return table.first[1:][table.first[1:] > reach[:-1]]


class _Layout:
    """What has been laid out so far."""

    def __init__(self, margin: int) -> None:
        self._margin = margin
        self._table_first_tile, self._table_first_row = [0], [0]
        self._tile_slot: list[int] = []
        self._tile_is_banded: list[bool] = []
        self._tile_first_pass, self._row_first_entry = [0], [np.zeros(1, dtype=np.int64)]
        self._n_rows = self._n_entries = 0
        self._pass_partner: list[Indices] = []
        self._pass_rest_squared: list[Floats] = []
        self._row_slot: list[Indices] = []
        self._entry_partner: list[Indices] = []
        self._entry_rest_squared: list[Floats] = []

    def add_tiles(self, atom: Indices, partner: Indices, rest_squared: Floats, cuts: Indices) -> None:
        """Lay out bonds of one table, tile by tile."""
        for start, part in _tiles(atom, cuts):
            self._add_tile(start, atom[part], partner[part], rest_squared[part])

    def end_table(self) -> None:
        """Let what follows belong to the next table."""
        self._table_first_tile.append(len(self._tile_slot))
        self._table_first_row.append(self._n_rows)

    def _add_tile(self, start: int, atom: Indices, partner: Indices, rest_squared: Floats) -> None:
        """Choose what is fastest for the bonds of LANES consecutive atoms."""
        partners, partner_pass = np.unique(partner, return_inverse=True)
        offsets, offset_pass = np.unique(partner - atom, return_inverse=True)
        if PASS_ENTRIES * min(partners.size, offsets.size) > atom.size:
            self._add_rows(atom, partner, rest_squared)
        elif partners.size <= offsets.size:
            self._add_passes(False, start, partners + self._margin, partner_pass, atom - start, rest_squared)
        else:
            self._add_passes(True, start, offsets, offset_pass, atom - start, rest_squared)

    def _add_passes(
        self, is_banded: bool, start: int, partners: Indices, number: Indices, lane: Indices, rest_squared: Floats
    ) -> None:
        rest = np.full((partners.size, LANES), UNBOUND)
        rest[number, lane] = rest_squared
        self._tile_slot.append(start + self._margin)
        self._tile_is_banded.append(is_banded)
        self._tile_first_pass.append(self._tile_first_pass[-1] + partners.size)
        self._pass_partner.append(partners)
        self._pass_rest_squared.append(rest)

    def _add_rows(self, atom: Indices, partner: Indices, rest_squared: Floats) -> None:
        rows, count = np.unique(atom, return_counts=True)
        self._row_slot.append(rows + self._margin)
        self._row_first_entry.append(self._n_entries + np.cumsum(count))
        self._entry_partner.append(partner + self._margin)
        self._entry_rest_squared.append(rest_squared)
        self._n_rows += rows.size
        self._n_entries += atom.size

    def finish(self) -> Bonds:
        """Join everything."""
        return Bonds(
            table_first_tile=np.array(self._table_first_tile, dtype=np.int64),
            tile_slot=np.array(self._tile_slot, dtype=np.int64),
            tile_is_banded=np.array(self._tile_is_banded, dtype=np.int64),
            tile_first_pass=np.array(self._tile_first_pass, dtype=np.int64),
            pass_partner=_joined(self._pass_partner),
            pass_rest_squared=np.concatenate([np.empty((0, LANES)), *self._pass_rest_squared]),
            table_first_row=np.array(self._table_first_row, dtype=np.int64),
            row_slot=_joined(self._row_slot),
            row_first_entry=_joined(self._row_first_entry),
            entry_partner=_joined(self._entry_partner),
            entry_rest_squared=np.concatenate([np.empty(0), *self._entry_rest_squared]),
        )


def _tiles(atom: Indices, cuts: Indices) -> Iterator[tuple[int, slice]]:
    """Cut sorted atoms into tiles of at most LANES consecutive ones, preferably where no bond reaches over."""
    begin = 0
    while begin < atom.size:
        start = int(atom[begin])
        cut = int(np.searchsorted(cuts, start + LANES, side="right")) - 1
        stop = int(cuts[cut]) if cut >= 0 and cuts[cut] > start + LANES // 2 else start + LANES
        end = int(np.searchsorted(atom, stop))
        yield start, slice(begin, end)
        begin = end


def _joined(parts: list[Indices]) -> Indices:
    return np.concatenate([np.empty(0, dtype=np.int64), *parts])
