"""How bonds are laid out for the compiled backend."""

from __future__ import annotations

import numpy as np
import pytest

from atomsim.core.model import BondTable, Indices, Origin
from atomsim.core.plans import bond_plan
from atomsim.core.plans.bond_plan import plan_bonds
from atomsim.core.plans.records import LANES, UNBOUND, Bonds

NONE = np.empty(0, dtype=np.int64)


def table_of(first: Indices, second: Indices) -> BondTable:
    return BondTable(Origin("bonds", "b", "<scene>", 1), first, second, 0.5 + first + 0.001 * second)


def all_pairs(n_atoms: int) -> BondTable:
    return table_of(*np.triu_indices(n_atoms, 1))


def chain(n_atoms: int) -> BondTable:
    return table_of(np.arange(n_atoms - 1), np.arange(1, n_atoms))


def bonds_in(plan: Bonds, margin: int) -> dict[tuple[int, int], float]:
    """Return r² by (atom, partner) of everything in a plan."""
    found = {}
    for tile, start in enumerate(plan.tile_slot):
        for number in range(plan.tile_first_pass[tile], plan.tile_first_pass[tile + 1]):
            for lane in np.flatnonzero(plan.pass_rest_squared[number] != UNBOUND):
                partner = plan.pass_partner[number] + (start + lane if plan.tile_is_banded[tile] else 0)
                found[int(start + lane - margin), int(partner - margin)] = float(plan.pass_rest_squared[number, lane])
    for row, slot in enumerate(plan.row_slot):
        for entry in range(plan.row_first_entry[row], plan.row_first_entry[row + 1]):
            pair = int(slot - margin), int(plan.entry_partner[entry] - margin)
            found[pair] = float(plan.entry_rest_squared[entry])
    return found


def both_ways(table: BondTable) -> dict[tuple[int, int], float]:
    pairs = list(zip(table.first.tolist(), table.second.tolist(), table.rest_squared.tolist(), strict=True))
    return {pair: rest for i, k, rest in pairs for pair in ((i, k), (k, i))}


def test_all_pairs_of_a_string_are_one_tile() -> None:
    plan = plan_bonds([all_pairs(70)], range(70), NONE, margin=100)
    assert plan.tile_slot.tolist() == [100]
    assert plan.tile_is_banded.tolist() == [0]
    assert plan.pass_partner.tolist() == list(range(100, 170))
    assert plan.row_slot.size == 0
    assert bonds_in(plan, 100) == both_ways(all_pairs(70))


def test_how_many_are_laid_out_at_a_time_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = plan_bonds([all_pairs(200)], range(200), NONE, margin=300)
    monkeypatch.setattr(bond_plan, "PART_ENTRIES", 1000)
    in_parts = plan_bonds([all_pairs(200)], range(200), NONE, margin=300)
    for one, other in zip(whole, in_parts, strict=True):
        assert np.array_equal(one, other)


def test_neighbours_in_a_long_string_are_bands() -> None:
    plan = plan_bonds([chain(200)], range(200), NONE, margin=80)
    assert plan.tile_is_banded.all()
    assert plan.tile_slot.tolist() == [80, 80 + LANES, 80 + 2 * LANES]
    assert plan.pass_partner.tolist() == [-1, 1] * 3
    assert bonds_in(plan, 80) == both_ways(chain(200))


def test_scattered_bonds_are_rows() -> None:
    table = table_of(np.array([0, 3, 50]), np.array([40, 90, 51]))
    plan = plan_bonds([table], range(100), NONE, margin=5)
    assert plan.tile_slot.size == 0
    assert (plan.row_slot - 5).tolist() == [0, 3, 40, 50, 51, 90]
    assert bonds_in(plan, 5) == both_ways(table)


def test_tiles_end_where_no_bond_reaches_over() -> None:
    first, second = np.triu_indices(50, 1)
    two = table_of(np.concatenate((first, first + 50)), np.concatenate((second, second + 50)))
    plan = plan_bonds([two], range(100), NONE, margin=0)
    assert plan.tile_slot.tolist() == [0, 50]
    assert plan.pass_partner.tolist() == list(range(100))


def test_each_share_has_the_bonds_of_its_atoms() -> None:
    tables = [all_pairs(90), chain(90)]
    whole = bonds_in(plan_bonds(tables[:1], range(90), NONE, 0), 0)
    parts = [bonds_in(plan_bonds(tables[:1], range(start, start + 30), NONE, 0), 0) for start in (0, 30, 60)]
    assert {**parts[0], **parts[1], **parts[2]} == whole
    assert sum(map(len, parts)) == len(whole)


def test_tables_stay_apart() -> None:
    plan = plan_bonds([all_pairs(70), chain(70), chain(3)], range(70), NONE, 0)
    assert plan.table_first_tile.tolist() == [0, 1, 2, 2]
    assert plan.table_first_row.tolist() == [0, 0, 0, 3]


def test_nothing_is_computed_for_held_atoms() -> None:
    plan = plan_bonds([chain(6)], range(6), np.array([0, 1, 2, 3]), 0)
    assert bonds_in(plan, 0).keys() == {(4, 3), (4, 5), (5, 4)}


def test_partners_increase() -> None:
    table = table_of(np.array([0, 0, 1, 2, 5]), np.array([3, 5, 3, 3, 6]))
    plan = plan_bonds([table], range(10), NONE, 0)
    rows = dict(zip(plan.row_slot.tolist(), np.split(plan.entry_partner, plan.row_first_entry[1:-1]), strict=True))
    assert rows[3].tolist() == [0, 1, 2]
    assert rows[0].tolist() == [3, 5]
    assert rows[5].tolist() == [0, 6]
