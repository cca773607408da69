"""The three forms of bonds: which is chosen, and that larger tables come to the same bits in each."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from support.running import atoms_at, compiled

from atomsim.core.model import BondTable, Floats, Indices, Origin
from atomsim.core.numpy_backend import bonds
from atomsim.core.numpy_backend.bond_forms import DenseForm
from atomsim.core.numpy_backend.bonds import bond_forms, joined

ORIGIN = Origin("bonds", "b", "<scene>", 1)


def table_of(group: dict[str, Any], **rule: Any) -> BondTable:
    model, _ = compiled({"g": group}, bonds={"b": {"within": "g", **rule}})
    return model.bonds[0]


def random_table(n_atoms: int, n_pairs: int, seed: int) -> BondTable:
    random = np.random.default_rng(seed)
    key = np.unique(np.sort(random.integers(0, n_atoms, (n_pairs, 2)), axis=1) @ [n_atoms, 1])
    first, second = key // n_atoms, key % n_atoms
    apart = first != second
    return BondTable(ORIGIN, first[apart], second[apart], random.uniform(0, 3, apart.sum()))


ROD = table_of({"shape": "string", "count": 70, "step": [0.3, 0, 0]}, rule="all-pairs")
LONG_ROD = table_of({"shape": "string", "count": 230, "step": [0.3, 0, 0]}, rule="all-pairs")
SURFACE = table_of(
    {"shape": "plane", "counts": [17, 17], "step_x": [1, 0, 0], "step_y": [0, 1, 0]},
    rule="distance-threshold",
    threshold=2,
)
TANGLE = random_table(200, 1500, 1)
NEARLY_ALL = random_table(40, 2500, 2)


def forms_of(table: BondTable) -> list[str]:
    return [form.name for form in bond_forms(table)]


def subtotal(table: BondTable, position: Floats, resting: Indices | None = None) -> Floats:
    total = np.zeros_like(position)
    for form in bond_forms(table, resting):
        total[:, form.atoms] += form.subtotal(position)
    return total


def in_plain_loops(table: BondTable, position: Floats) -> Floats:
    """Sum pair after pair, as the convention says."""
    total = np.zeros_like(position)
    for i, k, rest_squared in zip(table.first, table.second, table.rest_squared, strict=True):
        dx, dy, dz = position[:, k] - position[:, i]
        weight = 1.0 - rest_squared * (1.0 / ((dx * dx + dy * dy) + dz * dz))
        force = np.array([weight * dx, weight * dy, weight * dz])
        total[:, i] += force
        total[:, k] -= force
    return total


def test_the_form_suits_the_table() -> None:
    assert forms_of(ROD) == ["dense"]
    assert forms_of(SURFACE) == ["offset"]
    assert forms_of(TANGLE) == ["general"]
    assert forms_of(NEARLY_ALL) == ["dense"]
    assert forms_of(random_table(10, 5, 3)) == ["general"]
    assert forms_of(BondTable(ORIGIN, TANGLE.first[:0], TANGLE.second[:0], TANGLE.rest_squared[:0])) == []


def test_groups_in_one_table_get_a_form_each() -> None:
    model, _ = compiled(
        {
            "rod": {"shape": "string", "count": 40, "step": [0.3, 0, 0]},
            "idle": atoms_at((9, 9, 9)),
            "ring": {"shape": "ring", "count": 60, "radius": 4},
        },
        bonds={"b": {"within": ["rod", "ring"], "rule": "all-pairs"}},
    )
    forms = bond_forms(model.bonds[0])
    assert [form.atoms for form in forms] == [slice(0, 40), slice(41, 101)]


@pytest.mark.parametrize(
    "thresholds", [{"DENSE_FILL": 0.0}, {"DENSE_FILL": 2.0, "RUN_PAIRS": 0}, {"DENSE_FILL": 2.0, "RUN_PAIRS": 10**9}]
)
@pytest.mark.parametrize(
    "table", [ROD, LONG_ROD, SURFACE, TANGLE, NEARLY_ALL], ids=["rod", "long rod", "surface", "tangle", "nearly all"]
)
def test_every_form_is_the_plain_loop(table: BondTable, thresholds: dict[str, float]) -> None:
    position = np.random.default_rng(7).normal(size=(3, int(table.second.max()) + 3))
    with patch.multiple(bonds, FEW_PAIRS=0, **thresholds):
        found = subtotal(table, position)
    assert np.array_equal(found, in_plain_loops(table, position))


def test_a_long_rod_is_cut_into_tiles() -> None:
    (form,) = bond_forms(LONG_ROD)
    assert isinstance(form, DenseForm)
    assert len(form._tiles) > 1


def shifted(table: BondTable, by: int) -> BondTable:
    return BondTable(ORIGIN, table.first + by, table.second + by, table.rest_squared)


def pairs_of(table: BondTable) -> list[tuple[int, int, float]]:
    return list(zip(table.first.tolist(), table.second.tolist(), table.rest_squared.tolist(), strict=True))


def test_tables_that_share_no_atom_are_joined() -> None:
    one, other = shifted(NEARLY_ALL, 40), NEARLY_ALL
    (both,) = joined([one, other])
    assert pairs_of(both) == sorted(pairs_of(one) + pairs_of(other))


def test_tables_that_meet_on_an_atom_stay_in_order() -> None:
    """The third would fit to the first, but the second comes between them."""
    first, second, third = ROD, shifted(ROD, 69), shifted(ROD, 200)
    assert [pairs_of(table) for table in joined([first, second, third])] == [
        pairs_of(first),
        sorted(pairs_of(second) + pairs_of(third)),
    ]
    beside_first, on_second = shifted(ROD, 100), shifted(ROD, 169)
    assert len(joined([first, beside_first])) == 1
    assert len(joined([first, beside_first, on_second])) == 2
    nothing = BondTable(ORIGIN, ROD.first[:0], ROD.second[:0], ROD.rest_squared[:0])
    assert joined([first, nothing])[0] is first
    assert joined([]) == []


def test_equal_bodies_side_by_side_are_computed_at_once() -> None:
    (both,) = joined([ROD, shifted(ROD, 70)])
    (form,) = bond_forms(both)
    assert (form.name, form.atoms) == ("dense", slice(0, 140))
    position = np.random.default_rng(5).normal(size=(3, 140))
    assert np.array_equal(subtotal(both, position), in_plain_loops(both, position))


@pytest.mark.parametrize(
    "others",
    [
        [shifted(ROD, 71)],  # an idle atom between
        [shifted(NEARLY_ALL, 70)],  # another size
        [shifted(SURFACE, 70)],  # not dense
        [shifted(LONG_ROD, 70), shifted(LONG_ROD, 300)],  # too large for one tile
    ],
)
def test_other_bodies_are_not(others: list[BondTable]) -> None:
    (both,) = joined([ROD, *others])
    assert len(bond_forms(both)) == 1 + len(others)
    position = np.random.default_rng(5).normal(size=(3, int(both.second.max()) + 1))
    assert np.array_equal(subtotal(both, position), in_plain_loops(both, position))


def test_many_small_bodies_share_a_form() -> None:
    sizes = [3, 4, 5] * 50
    starts = np.cumsum([0, *sizes])
    bodies = [
        BondTable(ORIGIN, *(ends + start for ends in np.triu_indices(size, 1)), np.ones(size * (size - 1) // 2))
        for size, start in zip(sizes, starts, strict=False)
    ]
    (all_of_them,) = joined([*bodies, shifted(ROD, 700)])
    assert forms_of(all_of_them) == ["general", "dense"]
    position = np.random.default_rng(6).normal(size=(3, 770))
    assert np.array_equal(subtotal(all_of_them, position), in_plain_loops(all_of_them, position))


def test_pairs_between_two_resting_atoms_are_left_out() -> None:
    position = np.random.default_rng(3).normal(size=(3, 70))
    resting = np.arange(0, 50)
    full, cut = subtotal(ROD, position), subtotal(ROD, position, resting)
    assert np.array_equal(cut[:, 50:], full[:, 50:])
    assert not np.array_equal(cut[:, :50], full[:, :50])
    assert bond_forms(ROD, np.arange(70)) == []


def test_a_million_scattered_pairs_find_their_form_quickly() -> None:
    """Offsets are sorted once; looking for each of them in turn would take minutes."""
    table = random_table(300_000, 1_000_000, 4)
    assert forms_of(table) == ["general"]
