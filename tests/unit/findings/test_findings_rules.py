"""What is wrong between declarations: rules that bind too little or too much, forces and collisions in vain."""

from __future__ import annotations

import pytest
from support.examined import found, warnings

HEAD = "atomsim: 1\ntime_step: 0.01\nrounds: 900\ngroups:\n"

CRATES = (
    HEAD
    + """\
  floor: {shape: plane, counts: [9, 9], step_x: [1.6, 0, 0], step_y: [0, 1.6, 0]}
  lower: {shape: block, counts: [3, 3, 3], spacing: 1.5, centre: [0.2, 0.1, 4]}
  upper: {shape: block, counts: [3, 3, 3], spacing: 1.5, centre: [0, 0, 9]}
bonds:
  crates: {within: [lower, upper], rule: distance-threshold, threshold: 2.7}
collisions:
  stack: {among: [floor, lower, upper]}
forces:
  weight: {kind: gravity, acts_on: [lower, upper], impulse: [0, 0, -0.002]}
  ground: {kind: hold, acts_on: floor}
"""
)


def crates(old: str, new: str) -> str:
    assert CRATES.count(old) == 1
    return CRATES.replace(old, new)


def test_two_crates_are_well() -> None:
    assert warnings(CRATES) == []


def test_a_threshold_below_the_spacing_of_one_way_leaves_pieces() -> None:
    """Sheets of a block that is drawn out along z hang together within themselves only."""
    text = (
        HEAD
        + """\
  net: {shape: plane, counts: [4, 3], step_x: [1, 0, 0], step_y: [0, 1.6, 0]}
bonds: {net: {within: net, rule: distance-threshold, threshold: 1.5}}
forces: {weight: {kind: gravity, impulse: [0, 0, -0.001]}}
"""
    )
    (piece,) = found(text, "in-pieces")
    assert str(piece) == (
        "scene.yaml:6: warning: `threshold: 1.5` leaves net in 3 pieces: the widest gap to bridge is 1.6 [in-pieces]"
    )
    assert piece.names == ("bonds.net", "groups.net")
    assert piece.remedy == "bonds:\n  net: {threshold: 1.7}"
    assert found(text.replace("threshold: 1.5", "threshold: 1.7"), "in-pieces") == []
    sewn = text.replace("}}\nforces", "}, sewn: {within: net, rule: pairs, pairs: [[0, 4], [4, 8]]}}\nforces")
    assert found(sewn, "in-pieces") == []


def test_single_atoms_left_over_are_counted() -> None:
    text = (
        HEAD
        + """\
  bag: {shape: atoms, positions: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [9, 0, 0], [5, 0, 0]], velocity: [1, 0, 0]}
bonds: {bag: {within: all, rule: distance-threshold, threshold: 1.2}}
"""
    )
    (piece,) = found(text, "in-pieces")
    assert "leaves bag in 3 pieces, 2 atoms of it alone: the widest gap to bridge is 4" in piece.message
    assert piece.remedy == "bonds:\n  bag: {threshold: 4.1}"


def test_one_rule_for_several_groups_may_leave_them_apart() -> None:
    assert found(crates("within: [lower, upper]", "within: all"), "in-pieces") == []


def test_a_grid_in_pieces_is_measured_on_the_grid() -> None:
    text = crates("threshold: 2.7}", "threshold: 1.2, metric: grid}")
    assert found(text, "in-pieces") == []
    alone = crates("threshold: 2.7}", "threshold: 1, metric: grid}")
    with pytest.raises(Exception, match="nothing is bound"):
        found(alone)


def test_a_rule_that_binds_nothing_of_one_of_its_groups() -> None:
    wide = crates("spacing: 1.5, centre: [0, 0, 9]", "spacing: 2.75, centre: [0, 0, 9]")
    (missed,) = found(wide, "rule-misses-group")
    assert str(missed) == (
        "scene.yaml:9: warning: this rule binds no atom of upper: nothing there is less than 2.7 apart, but 2.75 "
        "[rule-misses-group]"
    )
    assert missed.names == ("bonds.crates", "groups.upper")
    assert missed.remedy == "bonds:\n  crates: {threshold: 2.8}"
    assert found(wide, "floppy") == found(wide, "in-pieces") == []


def test_a_rule_that_misses_one_of_several_partners() -> None:
    text = (
        HEAD
        + """\
  palm: {shape: string, count: 5, step: [1, 0, 0], velocity: [0, 0, 1]}
  left: {shape: string, count: 5, step: [0, 0, -1], centre: [-2, 0, -3]}
  right: {shape: string, count: 5, step: [0, 0, -1], centre: [2, 0, -5]}
bonds:
  rods: {within: [palm, left, right], rule: all-pairs}
  knuckles: {between: [palm, [left, right]], rule: distance-threshold, threshold: 2.5}
"""
    )
    (missed,) = found(text, "rule-misses-group")
    assert missed.message == "this rule binds no atom of right: nothing there is less than 2.5 apart, but 3"
    assert missed.names == ("bonds.knuckles", "groups.right")
    assert missed.remedy == "bonds:\n  knuckles: {threshold: 3.1}"


def test_a_single_atom_has_nothing_to_be_bound_to_inside() -> None:
    text = (
        HEAD
        + """\
  rod: {shape: string, count: 5, step: [1, 0, 0], velocity: [1, 0, 0]}
  tip: {shape: atoms, positions: [[3, 0, 0]]}
bonds:
  rods: {within: [rod, tip], rule: all-pairs}
  joint: {between: [rod, tip], rule: distance-threshold, threshold: 1.5}
"""
    )
    assert found(text, "rule-misses-group") == []


def test_a_rule_by_distance_glues_parts() -> None:
    near = crates("within: [lower, upper]", "within: all").replace("centre: [0, 0, 9]", "centre: [0, 0, 8]")
    (glue,) = found(near, "weld")
    assert glue.line == 9
    assert glue.names == ("bonds.crates", "groups.floor", "groups.lower", "groups.upper")
    assert glue.message.endswith(" bonds of this rule join floor, lower and upper to one body")
    assert glue.remedy == "bonds:\n  crates: {within: [floor, lower, upper]}"


def test_bonds_and_collisions_of_the_same_pairs_fight() -> None:
    text = (
        HEAD
        + """\
  beads: {shape: string, count: 20, step: [1.2, 0, 0], velocity: [1, 0, 0]}
bonds: {beads: {within: beads, rule: neighbour}}
collisions: {own: {within: beads}}
"""
    )
    (fight,) = found(text, "weld")
    assert (fight.line, fight.names) == (7, ("collisions.own", "bonds.beads", "groups.beads"))
    assert fight.message.startswith("19 pairs that bonds.beads keeps 1.2 apart or more should be 2 apart here")
    assert fight.remedy == "collisions:\n  own: {except_bound: true}"
    assert found(text.replace("beads}}\n", "beads, except_bound: true}}\n"), "weld") == []
    assert found(text.replace("beads}}\n", "beads, min_gap: 2}}\n"), "weld") == []
    assert found(text.replace("step: [1.2", "step: [1.95"), "weld") == []


def test_parts_that_may_collide_and_are_bound_by_distance_are_glued() -> None:
    glue = "  glue: {between: [floor, lower], rule: distance-threshold, threshold: 2.9}\ncollisions:"
    (weld,) = found(crates("collisions:", glue), "weld")
    assert (weld.line, weld.names) == (10, ("bonds.glue", "collisions.stack", "groups.floor", "groups.lower"))


@pytest.mark.parametrize(
    ("rule", "names"),
    [
        ("again: {between: [floor, lower]}", ("collisions.stack", "collisions.again", "groups.floor", "groups.lower")),
        ("again: {between: [upper, floor]}", ("collisions.stack", "collisions.again", "groups.floor", "groups.upper")),
        ("again: {within: all}", ("collisions.stack", "collisions.again", "groups.floor", "groups.upper")),
        (
            "again: {within: all, min_gap: 134}",
            ("collisions.stack", "collisions.again", "groups.floor", "groups.upper"),
        ),
        ("again: {within: lower}", None),
        ("again: {between: ['lower[0]', 'lower[1:]']}", None),
        ("again: {within: all, except_bound: true}",
         ("collisions.stack", "collisions.again", "groups.floor", "groups.upper")),
        ("again: {between: ['lower[0]', 'upper[0]']}",
         ("collisions.stack", "collisions.again", "groups.lower", "groups.upper")),
    ],
)  # fmt: skip
def test_pairs_in_two_collisions(rule: str, names: tuple[str, ...] | None) -> None:
    stack = "  stack: {among: [floor, lower, upper]}"
    twice = found(crates(stack, f"{stack}\n  {rule}"), "declared-twice")
    assert [(each.names, each.line) for each in twice] == ([] if names is None else [(names, 12)])


def test_pairs_that_are_left_out_are_not_declared_twice() -> None:
    text = (
        HEAD
        + """\
  rope: {shape: string, count: 9, step: [2, 0, 0], velocity: [1, 0, 0]}
bonds: {rope: {within: rope, rule: neighbour}}
collisions:
  own: {within: rope, except_bound: %s}
  near: {between: ["rope[0]", "rope[0:3]"]}
"""
    )
    assert found(text % 2, "declared-twice") == []
    (twice,) = found(text % "true", "declared-twice")
    assert "such as rope[0] (atom 0) and rope[2] (atom 2)" in twice.message


def test_pairs_in_two_bond_rules() -> None:
    text = crates("collisions:", "  stiff: {within: upper, rule: all-pairs}\ncollisions:")
    (twice,) = found(text, "declared-twice")
    assert (twice.line, twice.names) == (10, ("bonds.crates", "bonds.stiff", "groups.upper"))
    assert twice.message.startswith("bonds.crates binds 158 pairs of this one, too, such as upper[0] (atom 108) and ")


def test_a_scene_in_which_nothing_happens() -> None:
    still = CRATES[: CRATES.index("  weight:")] + "  ground: {kind: hold, acts_on: floor}\n"
    (idle,) = found(still, "idle")
    assert (idle.line, idle.names) == (12, ("forces",))
    assert found(still + "jitter: {amplitude: 0.001}\n", "idle") != []
    for stress in ("centre: [0.2, 0.1, 3]", "centre: [0.2, 0.1, 4], velocity: [1, 0, 0]"):
        assert found(still.replace("centre: [0.2, 0.1, 4]", stress), "idle") == []
    assert found(still.replace("threshold: 2.7", "threshold: 2.7, rest: 1.6"), "idle") == []
    taut = "  string: {kind: tether, acts_on: upper, target: [0, 0, 20], rest: 3}\n"
    assert found(still + taut, "idle") == []
    assert len(found(still + taut.replace(", rest: 3", ""), "idle")) == 1


def test_forces_on_what_is_held_blame_the_hold_when_there_are_several() -> None:
    held = crates("acts_on: floor", "acts_on: [floor, lower, upper]")
    (dead,) = found(held, "force-on-held")
    assert (dead.line, dead.names[:2]) == (13, ("forces.weight", "forces.ground"))
    several = held.replace("  ground", "  air: {kind: damping, acts_on: upper, coefficient: 0.1}\n  ground")
    (dead,) = found(several, "force-on-held")
    assert (dead.line, dead.names[:3]) == (15, ("forces.weight", "forces.air", "forces.ground"))
    assert dead.remedy == "forces:\n  ground: {acts_on: [floor]}"


def test_a_force_on_some_held_atoms_acts_on_the_others() -> None:
    assert found(crates("acts_on: [lower, upper], impulse", "acts_on: all, impulse"), "force-on-held") == []


@pytest.mark.parametrize(
    ("force", "message"),
    [
        ("{kind: push, acts_on: upper, impulse: [0, 0, 0]}", "`impulse` is zero, so this force does nothing"),
        ("{kind: gravity, acts_on: upper, impulse: [0, 0, -0.0]}", "`impulse` is zero, so this force does nothing"),
        ("{kind: push, acts_on: upper, impulse: [1, 0, 0], from_round: 900}",
         "this begins in round 900, when the run is over: its last round is 899"),
        ("{kind: push, acts_on: upper, impulse: [1, 0, 0], from_round: 899}", None),
        ("{kind: oscillate, acts_on: upper, impulse: [0, 0, 0], period: 9}",
         "`impulse` is zero, so this force does nothing"),
        ("{kind: oscillate, acts_on: upper, impulse: [1, 0, 0], period: 0.5}",
         "sin(2π·round/0.5) is below 0.01 in every round of the run"),
        ("{kind: oscillate, acts_on: upper, impulse: [1, 0, 0], period: 1e7, phase: 3.14}",
         "sin(2π·round/1e+07 + 3.14) is below 0.01 in every round of the run"),
        ("{kind: oscillate, acts_on: upper, impulse: [1, 0, 0], period: 9}", None),
        ("{kind: push, acts_on: upper, towards: floor, magnitude: 0}",
         "`magnitude` is zero, so this force does nothing"),
        ("{kind: push, acts_on: upper, towards: [0, 0, 9], magnitude: 1, from_round: 900}",
         "this begins in round 900, when the run is over: its last round is 899"),
        ("{kind: push, acts_on: upper, towards: floor, magnitude: -1}", None),
        ("{kind: torque, acts_on: upper, axis: z, magnitude: 0}", "`magnitude` is zero, so this force does nothing"),
        ("{kind: torque, acts_on: 'upper[13]', axis: z, magnitude: 1}",
         "all its atoms lie on the axis, where a torque does nothing, or, a hair beside it, throws them away; choose "
         "another `axis` or `about`"),
        ("{kind: torque, acts_on: 'upper[13]', axis: z, magnitude: 1, about: 'upper[0]'}", None),
        ("{kind: damping, acts_on: upper, coefficient: 0}", "`coefficient` is zero, so this force does nothing"),
    ],
)  # fmt: skip
def test_forces_of_which_nothing_comes(force: str, message: str | None) -> None:
    text = crates("  ground", f"  odd: {force}\n  ground")
    never = [(each.message, each.line, each.names) for each in found(text, "force-never-acts")]
    assert never == ([] if message is None else [(message, 14, ("forces.odd", "groups.upper"))])


def test_a_torque_is_judged_by_levers_as_rounding_leaves_them() -> None:
    """The numbers of the axis are rounded, so that the atoms are off it by a hair."""
    text = (
        HEAD
        + """\
  axle: {shape: string, count: 9, step: [0.3, 0.3, 0.3], velocity: [1, 0, 0]}
forces: {motor: {kind: torque, axis: [1, 1, 1], magnitude: 1}}
"""
    )
    (never,) = found(text, "force-never-acts")
    assert never.remedy == "forces:\n  motor: {axis: x}"


def test_a_torque_on_copies_is_told_once_and_only_if_none_of_them_has_a_lever() -> None:
    text = (
        HEAD
        + """\
  axle: {shape: string, count: 9, step: [0.3, 0, 0], velocity: [1, 0, 0], copies: {count: 3, COPIES}}
forces: {motor: {kind: torque, acts_on: axle, axis: x, magnitude: 1}}
"""
    )
    (never,) = found(text.replace("COPIES", "step: [0, 5, 0]"), "force-never-acts")
    assert never.names == ("forces.motor", "groups.axle")
    assert found(text.replace("COPIES", "axis: z, through: [9, 0, 0]"), "force-never-acts") == []


def test_collisions_of_what_is_held() -> None:
    text = crates("acts_on: floor", "acts_on: [floor, lower, upper]")
    (never,) = found(text, "collision-of-held")
    assert (never.line, never.names) == (11, ("collisions.stack", "groups.floor", "groups.lower", "groups.upper"))
    assert found(crates("acts_on: floor", "acts_on: [floor, lower]"), "collision-of-held") == []


def test_rounds_to_show_that_are_never_run() -> None:
    (note,) = found(CRATES + "render: {rounds: [0, 50, 2000, 3000]}\n")
    assert str(note) == ("scene.yaml:15: note: there is no round 2000 to show; the run ends at 900 [no-such-round]")
    assert (note.rounds, note.remedy) == ((2000, 3000), "render:\n  rounds: [0, 50]")
    assert found(CRATES + "render: {rounds: [0, 900]}\n") == []
