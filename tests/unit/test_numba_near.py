"""The compiled search for near collision pairs finds what the one in NumPy finds."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
from support.running import after, compiled, digest_of

from atomsim.core.model import Between, BondTable, CollisionTable, Floats, Origin, State, Within
from atomsim.core.pairs.bonded import bound_pairs
from atomsim.core.pairs.collisions import table_pairs_near

pytest.importorskip("numba", reason="the backend is an extra")

from atomsim.core.numba_backend.near_kernels import find_near, sort_into_buckets
from atomsim.core.numba_backend.stepper import NumbaStepper
from atomsim.core.plans import near_plan
from atomsim.core.plans.near_plan import empty_list, plan_grids, plan_queries
from atomsim.core.plans.records import NearPairs

MARGIN = 3

CUTOFF = 2.5

N_ATOMS = 300


def table_of(*blocks: Within | Between) -> CollisionTable:
    return CollisionTable(Origin("collisions", "c", "<scene>", 1), blocks)


EVEN, ODD, ALL = np.arange(0, N_ATOMS, 2), np.arange(1, N_ATOMS, 2), np.arange(N_ATOMS)

TRIPLES = bound_pairs(
    [
        BondTable(
            Origin("bonds", "b", "<scene>", 1),
            *np.array([(i, i + k) for i in range(0, N_ATOMS - 2, 3) for k in (1, 2)]).T,
            np.ones(2 * (N_ATOMS // 3)),
        )
    ],
    N_ATOMS,
    2,
)

CHAIN = bound_pairs(
    [
        BondTable(
            Origin("bonds", "b", "<scene>", 1), np.arange(N_ATOMS - 1), np.arange(1, N_ATOMS), np.ones(N_ATOMS - 1)
        )
    ],
    N_ATOMS,
    3,
)

TABLES = (
    table_of(Within(ALL, 1)),
    table_of(Within(EVEN, 4)),
    table_of(Between(ODD, EVEN[:30])),
    table_of(Between(ALL[:200], ALL[100:]), Within(ALL[50:150], 2), Within(ALL[50:150], 2)),
    replace(table_of(Within(ALL, 1)), bound=TRIPLES),
    replace(table_of(Between(ODD, ALL[:90]), Within(EVEN, 1)), bound=CHAIN),
    replace(table_of(Within(EVEN, 1)), bound=TRIPLES),
)


def search(position: Floats, room: int = 10**6) -> tuple[bool, NearPairs]:
    """Search all tables; return whether there was room, and the list."""
    padded = np.pad(position, ((0, 0), (MARGIN, MARGIN)))
    grids = plan_grids(TABLES, MARGIN)
    queries = plan_queries(TABLES, range(N_ATOMS), np.empty(0, dtype=np.int64), MARGIN)
    near = empty_list(queries, room)
    sort_into_buckets(padded, CUTOFF, grids)
    return find_near(padded, CUTOFF, queries, grids, near), near


def pairs_of(near: NearPairs, table: int) -> list[tuple[int, int]]:
    """Return what a list says of a table as (atom, partner), in its order."""
    rows = range(near.table_first_row[table], near.table_first_row[table + 1])
    return [
        (int(near.row_slot[row]) - MARGIN, int(near.entry_partner[entry]) - MARGIN)
        for row in rows
        for entry in range(near.row_first_entry[row], near.row_first_entry[row + 1])
    ]


def expected(table: int, position: Floats) -> list[tuple[int, int]]:
    first, second = table_pairs_near(TABLES[table], position, CUTOFF)
    pairs = list(zip(first.tolist(), second.tolist(), strict=True))
    return sorted([*pairs, *((k, i) for i, k in pairs)])


@pytest.mark.parametrize("table", range(len(TABLES)))
@pytest.mark.parametrize("few", [0, 10**9])
@pytest.mark.parametrize("stretch", [(9.0, 9.0, 9.0), (700.0, 0.0, 0.0), (1.0, 1.0, 1.0), (50.0, 1e12, 1e-9)])
def test_the_list_is_that_of_numpy(table: int, few: int, stretch: tuple[float, float, float]) -> None:
    position = np.random.default_rng(5).uniform(-1, 1, (3, N_ATOMS)) * np.array(stretch)[:, None]
    with patch.object(near_plan, "FEW", few):
        had_room, near = search(position)
    assert had_room
    assert pairs_of(near, table) == expected(table, position)


def test_atoms_far_away_or_nowhere_are_near_nobody() -> None:
    position = np.random.default_rng(6).uniform(-8, 8, (3, N_ATOMS))
    strays = [np.nan, np.inf, -np.inf, 1e300, -1e300, 1e18]
    position[1, : len(strays)] = strays
    had_room, near = search(position)
    alone = position.copy()
    alone[1, : len(strays)] = 1e6 * np.arange(1, len(strays) + 1)
    assert had_room
    assert pairs_of(near, 0) == expected(0, alone)


def test_a_list_without_room_says_so_and_writes_nowhere_else() -> None:
    position = np.random.default_rng(7).uniform(-4, 4, (3, N_ATOMS))
    for room in (0, 1, 50, 2000):
        had_room, near = search(position, room)
        assert not had_room
        assert near.entry_partner.size == room


def test_a_crowd_gets_a_longer_list() -> None:
    groups = {"crowd": {"shape": "block", "counts": [6, 6, 6], "spacing": 0.25}}
    model, state = compiled(groups, collisions={"contact": {"within": "crowd"}})
    stepper = NumbaStepper(model, state)
    stepper.advance(1)
    assert stepper._shares[0]._near.entry_partner.size > 16 * model.n_atoms
    assert digest_of(stepper.state()) == digest_of(after(model, state, 1))


def test_more_pairs_than_memory_is_an_error() -> None:
    groups = {"crowd": {"shape": "block", "counts": [6, 6, 6], "spacing": 0.25}}
    model, state = compiled(groups, collisions={"contact": {"within": "crowd"}})
    with (
        patch("atomsim.core.numba_backend.stepper.free_memory", return_value=1000),
        pytest.raises(MemoryError, match="too many for memory"),
    ):
        NumbaStepper(model, State(0, state.position, state.velocity), threads=2).advance(1)
