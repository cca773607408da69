"""What numbers tell before a run: stiffness, speed, overlap, stress, each known by hand."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
from support.examined import found, warnings


def scene(time_step: float, groups: Sequence[str], *sections: str) -> str:
    return "\n".join([f"atomsim: 1\ntime_step: {time_step!r}\nrounds: 100\ngroups:", *groups, *sections, ""])


ROD = ["  left: {shape: string, count: 70, step: [0, 0.25, 0.25], velocity: [1, 0, 0]}"]
RIGID = "bonds: {left: {within: left, rule: all-pairs}}"
MUD = "forces: {mud: {kind: damping, coefficient: 1}}"


def test_a_rod_of_70_atoms_needs_a_time_step_below_a_35th() -> None:
    """λmax = 140, so τ < 4/140 = 1/35."""
    assert warnings(scene(1 / 36, ROD, RIGID)) == []
    (stiff,) = found(scene(1 / 34, ROD, RIGID))
    assert str(stiff) == (
        "scene.yaml:6: warning: time_step 0.0294118 is at or above 0.0286, the largest that the stiffness of this "
        "scene allows; expect it to blow up; what makes it stiff: bonds.left; try time_step 0.01 [over-stiff]"
    )
    assert stiff.names == ("bonds.left", "time_step", "groups.left")
    assert stiff.remedy == "time_step: 0.01"


def test_damping_lowers_the_largest_time_step() -> None:
    """4 − 2m instead of 4: with m = 1 half as much; it is blamed only where the time step would do without it."""
    assert warnings(scene(1 / 71, ROD, RIGID, MUD)) == []
    (stiff,) = found(scene(1 / 69, ROD, RIGID, MUD), "over-stiff")
    assert "at or above 0.0143, the largest that the stiffness of this scene allows with its damping;" in stiff.message
    (stiff,) = found(scene(1 / 34, ROD, RIGID, MUD), "over-stiff")
    assert "at or above 0.0143, the largest that the stiffness of this scene allows; expect" in stiff.message


def test_collisions_need_room_for_an_atom_between_two_others() -> None:
    """τ (140 + 4) < 4 asks for τ < 1/36."""
    wall = ["  wall: {shape: atoms, positions: [[9, 0, 0]]}"]
    touch = "collisions: {touch: {between: [left, wall]}}"
    assert found(scene(1 / 37, ROD + wall, RIGID, touch), "over-stiff") == []
    (stiff,) = found(scene(1 / 35.5, ROD + wall, RIGID, touch), "over-stiff")
    assert "is a hair below 0.0286" in stiff.message
    assert "an atom pressed between two others needs less than 0.0278" in stiff.message
    assert found(scene(1 / 35.5, ROD + wall, RIGID), "over-stiff") == []


def test_where_no_rule_alone_is_to_blame_the_time_step_is() -> None:
    both = [*ROD, "  right: {shape: string, count: 70, step: [0, 0.25, 0.25], centre: [9, 0, 0]}"]
    rules = "bonds: {left: {within: left, rule: all-pairs}, right: {within: right, rule: all-pairs}}"
    (stiff,) = found(scene(0.1, both, rules), "over-stiff")
    assert (stiff.line, stiff.names[:3]) == (2, ("bonds.left", "bonds.right", "time_step"))


def test_a_threshold_that_binds_nearly_everything() -> None:
    brick = ["  brick: {shape: block, counts: [3, 3, 3], spacing: 1, velocity: [1, 0, 0]}"]
    rule = "bonds: {brick: {within: brick, rule: distance-threshold, threshold: %s}}"
    assert found(scene(0.01, brick, rule % 1.8)) == []
    (stiff,) = found(scene(0.01, brick, rule % 18))
    assert stiff.message.startswith(
        "`threshold: 18` binds 351 of the 351 pairs of brick, whose nearest atoms are 1 apart"
    )
    assert (stiff.line, stiff.remedy) == (6, "bonds:\n  brick: {threshold: 1.9}")


def balls(speed: float, *more: str) -> str:
    cue = f"  cue: {{shape: atoms, positions: [[0, 0, 0]], velocity: [{speed!r}, 0, 0]}}"
    return scene(0.1, [cue, "  hit: {shape: atoms, positions: [[50, 0, 0]]}"], *more)


CONTACT = "collisions: {c: {between: [cue, hit]}}"


def test_atoms_too_fast_to_meet() -> None:
    """Both could move 1 per round, which is as much as contact is deep."""
    assert warnings(balls(9.9, CONTACT)) == []
    (fast,) = found(balls(10.0, CONTACT), "tunnelling")
    assert str(fast) == (
        "scene.yaml:5: warning: atoms of cue move 1 per round, so they may pass unseen through what collisions.c lets "
        "them touch (contact is at distance 2); try time_step 0.05 [tunnelling]"
    )
    assert fast.names == ("groups.cue", "collisions.c", "groups.hit")
    assert fast.remedy == "time_step: 0.05"


def test_fast_atoms_that_do_not_collide_are_no_concern() -> None:
    assert found(balls(1000.0), "tunnelling") == []


def test_what_moves_as_one_does_not_meet() -> None:
    volley = ["  volley: {shape: string, count: 9, step: [3, 0, 0], velocity: [100, 0, 0]}"]
    assert found(scene(0.1, volley, "collisions: {own: {within: volley}}"), "tunnelling") == []


def test_overlaps_at_the_start_tell_the_worst_pair_and_the_energy() -> None:
    """U(1) = (1 − 4 + 4 ln 4) / 2 for contact at 2, divided by τ."""
    groups = [
        "  a: {shape: atoms, positions: [[0, 0, 0], [1.8, 0, 0]]}",
        "  b: {shape: atoms, positions: [[0, 1, 0]]}",
    ]
    (overlap,) = found(scene(0.1, groups, "collisions: {c: {among: [a, b]}}"))
    assert f"{(1 - 4 + 4 * math.log(4)) / 2 / 0.1:.3g}" == "12.7"
    assert str(overlap) == (
        "scene.yaml:7: warning: 1 pair overlaps at the start (1 of a and b), most a[0] (atom 0) and b[0] "
        "(atom 2), 1 apart (contact is at 2); that releases the energy 12.7; move them apart [overlap-at-start]"
    )
    assert (overlap.names, overlap.rounds) == (("collisions.c", "groups.a", "groups.b"), (0,))


def string(name: str, count: int, step: float) -> str:
    return f"  {name}: {{shape: string, count: {count}, step: [{step!r}, 0, 0]}}"


@pytest.mark.parametrize(
    ("groups", "within", "remedy"),
    [
        ([string("a", 5, 0.7)], "a", "{min_gap: 3}"),
        ([string("a", 5, 0.7), string("b", 2, 9.0)], "[b, a]", "{min_gap: 3}"),
        ([string("a", 5, 0.7)], "'a[::2]'", "{min_gap: 2}"),
        ([string("a", 5, 0.7)], "['a[::2]', a]", "{min_gap: 3}"),
        ([string("a", 3, 0.7)], "a", ""),
    ],
)
def test_the_smallest_gap_without_overlaps_is_the_remedy(groups: list[str], within: str, remedy: str) -> None:
    """Places 1 and 2 apart overlap, 3 apart do not; a gap that leaves no pair at all is no remedy."""
    collisions = "collisions: {c: {within: %s}}"
    (overlap,) = found(scene(1e-3, groups, collisions % within))
    assert overlap.remedy == (f"collisions:\n  c: {remedy}" if remedy else "")
    if "min_gap" in remedy:
        gap = int(remedy[-2])
        assert found(scene(1e-3, groups, collisions % f"{within}, min_gap: {gap}"), "overlap-at-start") == []
        assert len(found(scene(1e-3, groups, collisions % f"{within}, min_gap: {gap - 1}"), "overlap-at-start")) == 1


def test_the_groups_that_overlap_are_listed_with_their_numbers() -> None:
    names = "abcdefgh"
    groups = [
        f"  {name}: {{shape: atoms, positions: {[[50.0 * k, 0.1 * i, 0] for k in range(i + 1)]}}}"
        for i, name in enumerate(names)
    ]
    (overlap,) = found(scene(1e-3, groups, f"collisions: {{c: {{among: [{', '.join(names)}]}}}}"))
    assert "84 pairs overlap at the start (7 of g and h, 6 of f and g, 6 of f and h, 5 of e and f, " in overlap.message
    assert ", 5 of e and g, 5 of e and h, 50 of others), most " in overlap.message


def ring(count: int, radius: float) -> str:
    return f"  a: {{shape: ring, count: {count}, radius: {radius!r}}}"


NEIGHBOURS = "bonds: {t: {within: a, rule: neighbour}%s}"
HOOKED = NEIGHBOURS % ", hook: {between: ['a[-1]', b], rule: pairs, pairs: [[0, 0]]}"


@pytest.mark.parametrize(
    ("groups", "bonds", "collisions", "code", "key"),
    [
        ([string("a", 9, 1.5)], NEIGHBOURS % "", "within: a", "weld", "except_bound: true"),
        ([string("a", 9, 0.7)], NEIGHBOURS % "", "within: a", "weld", "except_bound: 2"),
        ([ring(12, 1.5)], NEIGHBOURS % "", "within: a", "weld", "except_bound: 2"),
        ([string("a", 9, 1.5), "  b: {shape: atoms, positions: [[7.5, 0, 0]]}"], HOOKED,
         "between: [a, b]", "weld", "except_bound: true"),
        ([string("a", 3, 0.7)], "bonds: {t: {within: a, rule: all-pairs}}", "within: a", "weld", None),
        ([string("a", 5, 0.7)], "bonds: {t: {within: a, rule: all-pairs}}", "within: a", "weld", "min_gap: 3"),
        ([string("a", 9, 0.9)], "bonds: {t: {within: a, rule: neighbour}}", "within: a, except_bound: true",
         "overlap-at-start", "except_bound: 2"),
    ],
)  # fmt: skip
def test_the_key_that_leaves_out_what_is_bound_is_the_remedy(
    groups: list[str], bonds: str, collisions: str, code: str, key: str | None
) -> None:
    """By the smallest number of bonds; not if it leaves nothing to collide."""
    collide = "collisions: {c: {%s}}"
    overlaps = found(scene(1e-3, groups, bonds, collide % collisions), code)
    assert [each.remedy for each in overlaps] == ["" if key is None else f"collisions:\n  c: {{{key}}}"]
    if key is not None:
        mended = f"{collisions.removesuffix(', except_bound: true')}, {key}"
        assert {each.code for each in found(scene(1e-3, groups, bonds, collide % mended))} <= {
            "idle",
            "floppy",
            "loose-joint",
        }


def test_a_key_that_leaves_out_only_some_is_named() -> None:
    groups = [string("a", 9, 1.5), "  b: {shape: atoms, positions: [[7.5, 0, 0], [-6, 1, 0]]}"]
    (weld,) = found(scene(1e-3, groups, HOOKED, "collisions: {c: {between: [a, b]}}"), "weld")
    assert weld.remedy == "collisions:\n  c: {except_bound: true}"


def test_touching_is_no_overlap_nor_is_what_jitter_makes_of_it() -> None:
    row = [string("row", 9, 2.0)]
    still = scene(0.1, row, "collisions: {c: {within: row}}")
    assert found(still, "overlap-at-start") == []
    assert found(still + "jitter: {amplitude: 0.02}\n", "overlap-at-start") == []


def test_overlaps_of_bound_pairs_are_told_with_their_bonds() -> None:
    text = scene(
        0.01, [string("row", 9, 1.5)], "bonds: {b: {within: row, rule: neighbour}}", "collisions: {c: {within: row}}"
    )
    assert [each.code for each in found(text)] == ["weld"]


def test_bonds_that_want_another_distance() -> None:
    row = [string("row", 9, 1.0)]
    bonds = "bonds: {b: {within: row, rule: neighbour, rest: %s}}"
    assert found(scene(0.01, row, bonds % 1.1), "prestressed") == []
    (stressed,) = found(scene(0.01, row, bonds % 1.2), "prestressed")
    assert str(stressed) == (
        "scene.yaml:6: warning: 8 bonds of 8 start more than 10% off `rest`, most between row[0] (atom 0) and row[1] "
        "(atom 1), which are 1 apart and want 1.2 [prestressed]"
    )
    assert stressed.remedy == "bonds:\n  b: {rest: initial}"


def test_jitter_is_no_stress() -> None:
    text = scene(0.01, ["  row: {shape: string, count: 9, step: [0.3, 0, 0], velocity: [1, 0, 0]}"],
                 "bonds: {b: {within: row, rule: neighbour, rest: 0.3}}", "jitter: {amplitude: 0.05}")  # fmt: skip
    assert found(text) == []


def test_a_weld_that_only_follows_from_stress_is_not_told_twice() -> None:
    text = scene(0.01, [string("row", 9, 3.0)], "bonds: {b: {within: row, rule: neighbour, rest: 1}}",
                 "collisions: {c: {within: row}}")  # fmt: skip
    assert [each.code for each in found(text)] == ["prestressed"]
