"""Lays collision tables out for the search for near pairs; knows no positions.

A table is a union of blocks. An atom's partners in a block are found by a *query* in the *grid* of the atoms it may
collide with there; what several queries of an atom find is joined. So a pair is found from both of its atoms, and the
declared pairs are never listed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate

import numpy as np

from atomsim.core.model import Between, BoundPairs, CollisionTable, Indices, Within
from atomsim.core.pairs.bonded import first_near
from atomsim.core.plans.records import Bound, Grids, NearPairs, Queries

FEW = 24
"""So few atoms look at all others, or are all looked at, in less time than sorting into buckets takes."""

Side = tuple[Indices, Indices, Indices, Indices, int]
"""Asking atoms and their tags, atoms asked for and theirs, the gap: one side of a block."""


def sides_of(table: CollisionTable) -> Iterator[Side]:
    """Yield from which atoms, and among which, a table's pairs are looked for."""
    for block in table.blocks:
        yield from _sides_of_block(block)


def _sides_of_block(block: Within | Between) -> Iterator[Side]:
    if isinstance(block, Between):
        yield block.left, block.left, block.right, block.right, 1
        yield block.right, block.right, block.left, block.left, 1
    else:
        place = np.arange(block.atoms.size)
        yield block.atoms, place, block.atoms, place, block.min_gap


def plan_grids(tables: Sequence[CollisionTable], margin: int) -> Grids:
    """Lay out the grids of all tables, one per side of a block."""
    sides = [side for table in tables for side in sides_of(table)]
    sizes = [target.size for _, _, target, _, _ in sides]
    n_buckets = [_n_buckets(asker.size, target.size) for asker, _, target, _, _ in sides]
    first_target, first_bucket = _firsts(sizes), _firsts([count + 1 for count in n_buckets])
    return Grids(
        first_target=first_target,
        target_slot=_joined([target for _, _, target, _, _ in sides]) + margin,
        target_tag=_joined([tag for _, _, _, tag, _ in sides]),
        gap=np.array([gap for *_, gap in sides], dtype=np.int64),
        mask=np.array(n_buckets, dtype=np.int64) - 1,
        first_bucket=first_bucket,
        target_bucket=np.zeros(first_target[-1], dtype=np.int64),
        bucket_first_item=np.zeros(first_bucket[-1], dtype=np.int64),
        item_slot=np.zeros(first_target[-1], dtype=np.int64),
        item_tag=np.zeros(first_target[-1], dtype=np.int64),
        item_position=np.zeros((3, first_target[-1])),
        bound=_plan_bound(tables, margin),
    )


def _plan_bound(tables: Sequence[CollisionTable], margin: int) -> Bound:
    """Lay out which pairs do not collide; tables that leave out the same pairs share a row."""
    rows: list[BoundPairs] = []
    table_row = np.full(len(tables), -1)
    for number, table in enumerate(tables):
        if table.bound is not None:
            if not any(row is table.bound for row in rows):
                rows.append(table.bound)
            table_row[number] = next(place for place, row in enumerate(rows) if row is table.bound)
    before = _firsts([row.n_sets for row in rows])
    twins = [np.pad(row.twins + start, margin) for row, start in zip(rows, before[:-1], strict=True)]
    near = [row.sets_near % row.n_sets + start for row, start in zip(rows, before[:-1], strict=True)]
    n_near = np.concatenate([[0], *(np.diff(first_near(row)) for row in rows)])
    return Bound(table_row, np.array(twins, dtype=np.int64, ndmin=2), np.cumsum(n_near), _joined(near))


def _n_buckets(n_asking: int, n_targets: int) -> int:
    """Return a power of two, one to two buckets per target but no fewer than four, or 1 for looking at all."""
    return 1 if min(n_asking, n_targets) <= FEW else 1 << max(2, n_targets.bit_length())


def plan_queries(tables: Sequence[CollisionTable], atoms: range, held: Indices, margin: int) -> Queries:
    """Lay out the queries of some atoms; held atoms need none, for their impulse is going to be discarded."""
    counts: list[int] = []
    queries: list[tuple[Indices, Indices, Indices]] = []
    grid, cost = 0, 0.0
    for table in tables:
        asking = []
        for asker, tag, target, *_ in sides_of(table):
            wanted = np.flatnonzero((asker >= atoms.start) & (asker < atoms.stop) & ~np.isin(asker, held))
            asking.append((asker[wanted], np.full(wanted.size, grid), tag[wanted]))
            cost += wanted.size * _query_cost(asker.size, target.size)
            grid += 1
        slot, grids, tags = (np.concatenate(column) for column in zip(*asking, strict=True))
        order = np.argsort(slot, kind="stable")
        queries.append((slot[order] + margin, grids[order], tags[order]))
        counts.append(order.size)
    slot, grids, tags = (_joined([columns[number] for columns in queries]) for number in range(3))
    return Queries(_firsts(counts), slot, grids, tags, np.array([cost]))


def _query_cost(n_asking: int, n_targets: int) -> float:
    """Return the time of a query as a part of the time of one that looks into buckets."""
    return (20 + n_targets) / 200 if _n_buckets(n_asking, n_targets) == 1 else 1.0


def empty_list(queries: Queries, n_entries: int) -> NearPairs:
    """Return a list with room for so many partners."""
    n_queries = queries.slot.size
    return NearPairs(
        table_first_row=np.zeros(queries.table_first_query.size, dtype=np.int64),
        row_slot=np.zeros(n_queries, dtype=np.int64),
        row_first_entry=np.zeros(n_queries + 1, dtype=np.int64),
        entry_partner=np.zeros(n_entries, dtype=np.int64),
    )


def _firsts(counts: Sequence[int]) -> Indices:
    return np.array(list(accumulate(counts, initial=0)), dtype=np.int64)


def _joined(parts: Sequence[Indices]) -> Indices:
    return np.concatenate([np.empty(0, dtype=np.int64), *parts])
