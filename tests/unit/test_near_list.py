"""How long lists of near pairs are kept, and how far the next ones look."""

from __future__ import annotations

import numpy as np
import pytest

from atomsim.core.model import Between, CollisionTable, Origin, Within
from atomsim.core.pairs import near_list
from atomsim.core.pairs.near_list import WIDEST_SKIN, NearList, stay_apart, widest_skin

LINE = np.array([np.arange(8) * 0.5, np.zeros(8), np.zeros(8)])


def table_of(*blocks: Within | Between) -> CollisionTable:
    return CollisionTable(Origin("collisions", "c", "<scene>", 1), blocks)


def test_a_list_is_kept_until_an_atom_has_moved_half_the_skin() -> None:
    near = NearList((table_of(Within(np.arange(8), 1)),), 8, skin=0.5)
    assert near.update(LINE)
    assert not near.update(LINE)
    moved = LINE.copy()
    moved[1, 3] = 0.249
    assert not near.update(moved)
    moved[1, 3] = 0.25
    assert near.update(moved)
    assert not near.update(moved)


def test_atoms_that_never_collide_may_move_freely() -> None:
    near = NearList((table_of(Within(np.array([0, 1, 5]), 1)),), 8)
    assert near.update(LINE)
    moved = LINE.copy()
    moved[2, 2:5] = 100
    assert not near.update(moved)


def test_an_atom_that_falls_out_of_the_scene_makes_ever_fewer_lists() -> None:
    tables = (table_of(Within(np.array([0, 7]), 1)),)
    near, position, made = NearList(tables, 8), LINE.copy(), 0
    for _ in range(1000):
        position[2, 7] += 1.0
        made += near.update(position)
    assert made < 30


def test_lists_of_many_atoms_never_look_far() -> None:
    assert widest_skin([table_of(Within(np.arange(10**6), 1))]) == WIDEST_SKIN
    assert widest_skin([table_of(Between(np.arange(625), np.array([700])))]) > 1000


def test_no_collisions_need_no_list() -> None:
    near = NearList((), 8)
    assert not near.update(LINE)
    assert near.first.size == 0


def test_atoms_that_fall_together_need_no_new_list(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near_list, "MANY_ATOMS", 8)
    near, position = NearList((table_of(Within(np.arange(8), 1)),), 8, skin=0.5), LINE.copy()
    assert near.update(position)
    for _ in range(100):
        position[2] -= 3.0
        assert not near.update(position)
    position[2, 5] += 0.499
    assert not near.update(position)
    position[2, 4] -= 0.001
    assert near.update(position)


def test_each_table_has_its_own_drift(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two blocks fly apart: what touches inside of each stays the same."""
    monkeypatch.setattr(near_list, "MANY_ATOMS", 8)
    tables = (table_of(Within(np.arange(4), 1)), table_of(Within(np.arange(4, 8), 1)))
    near, position = NearList(tables, 8, skin=0.5), LINE.copy()
    near.update(position)
    position[0, :4] -= 7.0
    position[0, 4:] += 9.0
    assert not near.update(position)
    assert NearList((table_of(Within(np.arange(8), 1)),), 8, skin=0.5).update(position)


def test_a_drift_that_rounding_could_hide_something_in_makes_a_new_list() -> None:
    moved = np.full((3, 4), 2e6)
    assert stay_apart(moved / 4, 1.0)
    assert not stay_apart(moved, 1.0)
    for value in (np.inf, np.nan):
        assert not stay_apart(np.array([[0.0, value], [0.0, 0.0], [0.0, 0.0]]), 1.0)
