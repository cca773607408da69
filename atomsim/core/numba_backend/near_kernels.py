"""Finding the collision pairs that are near each other, compiled; knows no forces.

Space is cut into cells a little wider than the cutoff, and the cells are dealt out to the buckets of a table, so any
extent of a scene takes the same memory. An atom's near partners are in the buckets of the 27 cells around it; whatever
else is in these buckets is too far away and not taken.
"""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Floats, Indices
from atomsim.core.numba_backend.jit import inner, kernel
from atomsim.core.plans.records import Bound, Grids, NearPairs, Queries

STRIDE_Y, STRIDE_Z = 73856093, 19349663
"""Spread rows of cells over the buckets; the cells of a row along x are neighbours there, as atoms of a block are."""

CELLS = 0.999999
"""Cells per cutoff: a little less than one, against rounding."""

MAX_CELL = float(1 << 30)
"""Whatever lies further out shares the outermost cell; up to there rounding is finer than a cell's excess width."""


@inner
def _cell(coordinate: float, cells_per_length: float) -> int:
    """Return the cell of a coordinate; atoms without a place (NaN) are put somewhere."""
    cell = np.floor(coordinate * cells_per_length)
    if not abs(cell) < MAX_CELL:
        cell = MAX_CELL if cell > 0.0 else -MAX_CELL
    return int(cell)


@kernel
def sort_into_buckets(position: Floats, cutoff: float, grids: Grids) -> None:
    """Sort the targets of every grid by the bucket they are in, keeping their order inside a bucket."""
    cells_per_length = CELLS / cutoff
    for grid in range(grids.mask.size):
        mask = grids.mask[grid]
        start, stop = grids.first_target[grid], grids.first_target[grid + 1]
        first_item = grids.bucket_first_item[grids.first_bucket[grid] : grids.first_bucket[grid + 1]]
        first_item[:] = 0
        for target in range(start, stop):
            slot = grids.target_slot[target]
            bucket = 0
            if mask:
                x = _cell(position[0, slot], cells_per_length)
                y = _cell(position[1, slot], cells_per_length)
                z = _cell(position[2, slot], cells_per_length)
                bucket = (x + y * STRIDE_Y + z * STRIDE_Z) & mask
            grids.target_bucket[target] = bucket
            first_item[bucket + 1] += 1
        first_item[0] = start
        for bucket in range(mask + 1):
            first_item[bucket + 1] += first_item[bucket]
        for target in range(stop - 1, start - 1, -1):
            bucket = grids.target_bucket[target]
            first_item[bucket + 1] -= 1
            item = first_item[bucket + 1]
            slot = grids.target_slot[target]
            grids.item_slot[item] = slot
            grids.item_tag[item] = grids.target_tag[target]
            for component in range(3):
                grids.item_position[component, item] = position[component, slot]
        for bucket in range(mask + 1):  # each entry now is where the bucket before it begins
            first_item[bucket] = first_item[bucket + 1]
        first_item[mask + 1] = stop


@kernel
def find_near(position: Floats, cutoff: float, queries: Queries, grids: Grids, near: NearPairs) -> bool:
    """List the partners nearer than a cutoff of every atom that asks; return False if the list has no room for them."""
    row, entry = 0, 0
    for table in range(queries.table_first_query.size - 1):
        near.table_first_row[table] = row
        query, last = queries.table_first_query[table], queries.table_first_query[table + 1]
        while query < last:
            slot, first = queries.slot[query], entry
            while query < last and queries.slot[query] == slot:
                end = _look_around(position, cutoff, query, queries, grids, near.entry_partner, entry)
                if end < 0:
                    return False
                entry = _keep_partners(query, queries, grids, near.entry_partner, entry, end)
                query += 1
            entry = _sort_distinct(near.entry_partner, first, entry)
            if grids.bound.table_row[table] >= 0:
                entry = _leave_out_bound(
                    slot, grids.bound.table_row[table], grids.bound, near.entry_partner, first, entry
                )
            if entry > first:
                near.row_slot[row] = slot
                near.row_first_entry[row] = first
                row += 1
    near.table_first_row[near.table_first_row.size - 1] = row
    near.row_first_entry[row] = entry
    return True


@inner
def _look_around(
    position: Floats, cutoff: float, query: int, queries: Queries, grids: Grids, partner: Indices, entry: int
) -> int:
    """Append the near items in the cells around an atom, in any order, perhaps twice; return the new end, or −1."""
    slot, grid = queries.slot[query], queries.grid[query]
    mask = grids.mask[grid]
    first_item = grids.bucket_first_item[grids.first_bucket[grid] : grids.first_bucket[grid + 1]]
    if not mask:
        return _take_near(position, cutoff, slot, grids, partner, entry, first_item[0], first_item[1])
    cells_per_length = CELLS / cutoff
    x = _cell(position[0, slot], cells_per_length)
    y = _cell(position[1, slot], cells_per_length)
    z = _cell(position[2, slot], cells_per_length)
    for row_z in range(z - 1, z + 2):
        for row_y in range(y - 1, y + 2):
            middle = x + row_y * STRIDE_Y + row_z * STRIDE_Z
            low, high = (middle - 1) & mask, (middle + 1) & mask
            if low > high:  # the three cells of the row lie around the end of the table
                entry = _take_near(position, cutoff, slot, grids, partner, entry, first_item[0], first_item[high + 1])
                high = mask
            entry = _take_near(position, cutoff, slot, grids, partner, entry, first_item[low], first_item[high + 1])
    return entry


@inner
def _take_near(
    position: Floats, cutoff: float, slot: int, grids: Grids, partner: Indices, entry: int, start: int, stop: int
) -> int:
    """Append those of some items that are near; return the new end, −1 without room, and again after that."""
    if entry < 0 or entry + stop - start > partner.size:
        return -1
    x, y, z = position[0, slot], position[1, slot], position[2, slot]
    place = grids.item_position
    for item in range(start, stop):
        dx, dy, dz = place[0, item] - x, place[1, item] - y, place[2, item] - z
        partner[entry] = item
        entry += int((dx * dx + dy * dy) + dz * dz < cutoff * cutoff)
    return entry


@inner
def _keep_partners(query: int, queries: Queries, grids: Grids, partner: Indices, first: int, end: int) -> int:
    """Turn items into slots and drop those that do not collide with the atom that asks; return the new end."""
    tag, gap = queries.tag[query], grids.gap[queries.grid[query]]
    kept = first
    for number in range(first, end):
        item = partner[number]
        if abs(grids.item_tag[item] - tag) >= gap:
            partner[kept] = grids.item_slot[item]
            kept += 1
    return kept


@inner
def _sort_distinct(partner: Indices, first: int, end: int) -> int:
    """Sort partners, mostly few, and drop those that come twice; return the new end. (Shell's sort.)"""
    gap = 1
    while gap < (end - first) // 3:
        gap = 3 * gap + 1
    while gap > 0:
        for number in range(first + gap, end):
            found, place = partner[number], number
            while place >= first + gap and partner[place - gap] > found:
                partner[place] = partner[place - gap]
                place -= gap
            partner[place] = found
        gap //= 3
    kept = first
    for number in range(first, end):
        if kept == first or partner[kept - 1] != partner[number]:
            partner[kept] = partner[number]
            kept += 1
    return kept


@inner
def _leave_out_bound(slot: int, row: int, bound: Bound, partner: Indices, first: int, end: int) -> int:
    """Drop partners that are few bonds away; return the new end."""
    twins, own = bound.twins[row], bound.twins[row, slot]
    kept = first
    for number in range(first, end):
        low, high = bound.first_near[own], bound.first_near[own + 1]
        wanted = twins[partner[number]]
        while low < high:
            middle = (low + high) // 2
            if bound.near[middle] < wanted:
                low = middle + 1
            else:
                high = middle
        if low == bound.first_near[own + 1] or bound.near[low] != wanted:
            partner[kept] = partner[number]
            kept += 1
    return kept
