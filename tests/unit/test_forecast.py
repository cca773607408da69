"""Whole warnings, their numbers known by hand, and the silence of scenes that are well."""

from __future__ import annotations

from typing import Any

import pytest
from support.running import PAPER_SCENES, atoms_at, compiled, paper_scene

from atomsim.compiler import compile_scene
from atomsim.core.diagnosis.forecast import forecast

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


def test_damping_lowers_the_largest_time_step() -> None:
    """4 − 2m instead of 4: with m = 1 half as much; it is blamed only where the time step would do without it."""
    mud = {"mud": {"kind": "damping", "coefficient": 1}}
    assert warnings(ROD, 1 / 71, bonds=RIGID, forces=mud) == []
    assert warnings(ROD, 1 / 69, bonds=RIGID, forces=mud) == [
        "time_step 0.0144928 is at or above 0.0143, the largest that the stiffness of this scene allows "
        "with its damping; expect it to blow up; try time_step 0.007"
    ]
    assert warnings(ROD, 1 / 34, bonds=RIGID, forces=mud) == [
        "time_step 0.0294118 is at or above 0.0143, the largest that the stiffness of this scene allows; "
        "expect it to blow up; try time_step 0.007"
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
        "collisions.c (<scene>:1): 1 pair overlaps at the start (1 of a and b), most a[0] (atom 0) and b[0] (atom 2) "
        "1 apart (contact is at 2); that releases the energy 12.7; move them apart"
    )


def string(count: int, step: float) -> dict[str, Any]:
    return {"shape": "string", "count": count, "step": [step, 0, 0]}


@pytest.mark.parametrize(
    ("groups", "within", "remedy"),
    [
        ({"a": string(5, 0.7)}, "a", ", or write `min_gap: 3`"),
        ({"a": string(5, 0.7), "b": string(2, 9)}, ["b", "a"], ", or write `min_gap: 3`"),
        ({"a": string(5, 0.7)}, "a[::2]", ", or write `min_gap: 2`"),
        ({"a": string(5, 0.7)}, ["a[::2]", "a"], ", or write `min_gap: 3`"),
        ({"a": string(3, 0.7)}, "a", ""),
    ],
)
def test_the_smallest_gap_without_overlaps_is_named(
    groups: dict[str, Any], within: str | list[str], remedy: str
) -> None:
    """Places 1 and 2 apart overlap, 3 apart do not; a gap that leaves no pair at all is no remedy."""
    (warning,) = warnings(groups, 1e-3, collisions={"c": {"within": within}})
    assert warning.endswith(f"; move them apart{remedy}")
    if "min_gap" in remedy:
        gap = int(remedy[-2])
        assert warnings(groups, 1e-3, collisions={"c": {"within": within, "min_gap": gap}}) == []
        assert len(warnings(groups, 1e-3, collisions={"c": {"within": within, "min_gap": gap - 1}})) == 1


def ring(count: int, radius: float) -> dict[str, Any]:
    return {"shape": "ring", "count": count, "radius": radius}


HOOK = {"hook": {"between": ["a[-1]", "b"], "rule": "pairs", "pairs": [[0, 0]]}}


@pytest.mark.parametrize(
    ("groups", "bonds", "collisions", "remedy"),
    [
        ({"a": string(9, 1.5)}, {"t": {"within": "a", "rule": "neighbour"}}, {"within": "a"}, ", or write {true}"),
        ({"a": string(9, 0.7)}, {"t": {"within": "a", "rule": "neighbour"}}, {"within": "a"}, ", or write {2}"),
        ({"a": ring(12, 1.5)}, {"t": {"within": "a", "rule": "neighbour"}}, {"within": "a"}, ", or write {2}"),
        (
            {"a": string(9, 1.5), "b": atoms_at((7.5, 0, 0))},
            {"t": {"within": "a", "rule": "neighbour"}, **HOOK},
            {"between": ["a", "b"]},
            ", or write {true}",
        ),
        (
            {"a": string(9, 1.5), "b": atoms_at((7.5, 0, 0), (-6, 1, 0))},
            {"t": {"within": "a", "rule": "neighbour"}, **HOOK},
            {"between": ["a", "b"]},
            "; {true} would leave out all but 2",
        ),
        ({"a": string(3, 0.7)}, {"t": {"within": "a", "rule": "all-pairs"}}, {"within": "a"}, ""),
        (
            {"a": string(5, 0.7)},
            {"t": {"within": "a", "rule": "all-pairs"}},
            {"within": "a"},
            ", or write `min_gap: 3`",
        ),
    ],
)
def test_the_key_that_leaves_out_what_is_bound_is_named(
    groups: dict[str, Any], bonds: dict[str, Any], collisions: dict[str, Any], remedy: str
) -> None:
    """By the smallest number of bonds; not if it leaves nothing to collide; only partly if some are not bound."""
    (warning,) = warnings(groups, 1e-3, bonds=bonds, collisions={"c": collisions})
    for word in ("true", "2"):
        remedy = remedy.replace(f"{{{word}}}", f"`except_bound: {word}`")
    assert warning.endswith(f"; move them apart{remedy}")
    if "or write `except_bound" in remedy:
        n_bonds = 1 + ("2" in remedy)
        for fewer, n_warnings in ((n_bonds, 0), (n_bonds > 1, 1)):
            collide = {"c": {**collisions, "except_bound": fewer}}
            assert len(warnings(groups, 1e-3, bonds=bonds, collisions=collide)) == n_warnings


def test_the_groups_that_overlap_are_listed_with_their_numbers() -> None:
    names = "abcdefgh"
    groups = {name: atoms_at(*[(50.0 * k, 0.1 * i, 0) for k in range(i + 1)]) for i, name in enumerate(names)}
    (warning,) = warnings(groups, 1e-3, collisions={"c": {"among": list(names)}})
    assert ": 84 pairs overlap at the start (7 of g and h, 6 of f and g, 6 of f and h, 5 of e and f, " in warning
    assert ", 5 of e and g, 5 of e and h, 50 of others), most " in warning


def test_touching_is_no_overlap() -> None:
    assert warnings({"a": atoms_at((0, 0, 0), (2, 0, 0))}, 0.1, collisions={"c": {"within": "a"}}) == []


def test_absurd_numbers_are_warned_of_in_finite_words() -> None:
    """The stiffness names no time step to try where there is none; every number said is finite."""
    groups = {"a": atoms_at((0, 0, 0), (1e-150, 0, 0), velocity=[1e150, 0, 0])}
    found = warnings(
        groups,
        1e150,
        bonds={"b": {"within": "a", "rule": "all-pairs", "rest": 1e150}},
        collisions={"c": {"within": "a"}},
    )
    assert found == [
        "time_step 1e+150 is at or above 0, the largest that the stiffness of this scene allows; expect it to blow up",
        "collisions.c (<scene>:1): atoms of a move 1e+300 per round, so two of them may pass through each other "
        "(contact is at distance 2); try time_step 5e-151",
        "collisions.c (<scene>:1): 1 pair overlaps at the start (1 inside a), most a[0] (atom 0) and a[1] (atom 1) "
        "1e-150 apart (contact is at 2); that releases the energy 1.38e-147; move them apart",
    ]


def torque(groups: dict[str, Any], **keys: Any) -> list[str]:
    return warnings(groups, 0.1, forces={"motor": {"kind": "torque", "axis": [1, 1, 1], "magnitude": 1, **keys}})


def test_a_torque_on_atoms_on_its_axis() -> None:
    """The numbers of the axis are rounded, so that the atoms are off it by a hair."""
    axle = {"a": {"shape": "string", "count": 9, "step": [0.3, 0.3, 0.3]}}
    assert torque(axle) == [
        "forces.motor (<scene>:1): all its atoms lie on the axis, where a torque does nothing, or, a hair beside it, "
        "throws them away; choose another `axis` or `about`"
    ]
    assert torque(axle, magnitude=0) == torque(axle, axis="x") == torque({**axle, "b": atoms_at((9, 0, 0))}) == []
    assert torque({**axle, "b": atoms_at((9, 0, 0))}, acts_on="a", about="b") == []
