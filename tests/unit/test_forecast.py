"""Whole warnings, their numbers known by hand, and the silence of scenes that are well."""

from __future__ import annotations

from typing import Any

import pytest
from support.running import PAPER_SCENES, atoms_at, compiled, paper_scene

from atomsim.compiler import compile_scene
from atomsim.core.forecast import forecast

ROD = {"left": {"shape": "string", "count": 70, "step": [0, 0.25, 0.25]}}
RIGID = {"left": {"within": "left", "rule": "all-pairs"}}


def warnings(groups: dict[str, Any], time_step: float, **sections: Any) -> list[str]:
    return forecast(*compiled(groups, time_step, **sections))


@pytest.mark.parametrize("name", PAPER_SCENES)
def test_the_scenes_of_the_paper_are_well(name: str) -> None:
    assert forecast(*compile_scene(paper_scene(name))) == []


def test_a_rod_of_70_atoms_needs_a_time_step_below_a_35th() -> None:
    """λmax = 140, so τ < 4/140 = 1/35."""
    assert warnings(ROD, 1 / 36, bonds=RIGID) == []
    assert warnings(ROD, 1 / 34, bonds=RIGID) == [
        "time_step 0.0294118 is at or above 0.0286, the largest that the stiffness of this scene allows; "
        "expect it to blow up; try time_step 0.01"
    ]


def balls(speed: float) -> dict[str, Any]:
    return {
        "cue": atoms_at((0, 0, 0), velocity=[speed, 0, 0]),
        "hit": atoms_at((50, 0, 0)),
    }


CONTACT = {"c": {"between": ["cue", "hit"]}}


def test_atoms_too_fast_to_meet() -> None:
    """Both could move 1 per round, which is as much as contact is deep."""
    assert warnings(balls(9.9), 0.1, collisions=CONTACT) == []
    assert warnings(balls(10.0), 0.1, collisions=CONTACT) == [
        "collisions.c (<scene>:1): atoms of cue move 1 per round, so two of them may pass through each other "
        "(contact is at distance 2); try time_step 0.05"
    ]


def test_fast_atoms_that_do_not_collide_are_no_concern() -> None:
    assert warnings(balls(1000.0), 0.1) == []


def test_overlaps_at_the_start_tell_the_worst_pair_and_the_energy() -> None:
    """U(1) = (1 − 4 + 4 ln 4) / 2 for contact at 2, divided by τ."""
    groups = {"a": atoms_at((0, 0, 0), (1.9, 0, 0)), "b": atoms_at((0, 1, 0))}
    (warning,) = warnings(groups, 0.1, collisions={"c": {"among": ["a", "b"]}})
    assert warning == (
        "collisions.c (<scene>:1): 1 pairs overlap at the start, most a[0] (atom 0) and b[0] (atom 2) 1 apart "
        "(contact is at 2); that releases the energy 12.7"
    )


def test_touching_is_no_overlap() -> None:
    assert warnings({"a": atoms_at((0, 0, 0), (2, 0, 0))}, 0.1, collisions={"c": {"within": "a"}}) == []


def test_absurd_numbers_are_warned_of_in_finite_words() -> None:
    """No time step to try can be named where there is none."""
    groups = {"a": atoms_at((0, 0, 0), (1e-150, 0, 0), velocity=[1e150, 0, 0])}
    found = warnings(
        groups,
        1e308,
        bonds={"b": {"within": "a", "rule": "all-pairs", "rest": 1e150}},
        collisions={"c": {"within": "a"}},
    )
    assert found == [
        "time_step 1e+308 is at or above 0, the largest that the stiffness of this scene allows; expect it to blow up",
        "collisions.c (<scene>:1): atoms of a move inf per round, so two of them may pass through each other "
        "(contact is at distance 2)",
        "collisions.c (<scene>:1): 1 pairs overlap at the start, most a[0] (atom 0) and a[1] (atom 1) 1e-150 apart "
        "(contact is at 2); that releases the energy 1.38e-305",
    ]
