"""Events of small scenes in which it is plain what happens, and what does not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.running import atoms_at

import atomsim
from atomsim.measures.events import SENTENCES, Event
from atomsim.measures.hysteresis import stretches
from atomsim.measures.parts import pairs_of, parts_of
from atomsim.scene.yaml.written import to_yaml

Happens = Callable[..., list[str]]

FLOOR = {"shape": "plane", "counts": [9, 9], "step_x": [1, 0, 0], "step_y": [0, 1, 0]}
HELD = {"kind": "hold", "acts_on": "floor"}
WEIGHT = {"kind": "gravity", "acts_on": "ball", "impulse": [0, 0, -0.01]}
LAND = {"between": ["ball", "floor"]}
TOWER = {"shape": "block", "counts": [2, 2, 8], "spacing": 1, "centre": [0, 0, 5.4]}


@pytest.fixture
def happens(tmp_path: Path) -> Happens:
    """Run a scene written as Python data, and return its events in words, each with its round."""

    def run(groups: dict[str, Any], rounds: int, time_step: float = 0.05, **sections: Any) -> list[str]:
        scene = {"atomsim": 1, "time_step": time_step, "rounds": rounds, "groups": groups, **sections}
        atomsim.run(atomsim.loads(to_yaml(scene)), tmp_path / "out.h5", replace=True)
        return [f"{event.round_index} {event}" for event in atomsim.events(tmp_path / "out.h5")]

    return run


def without_rounds(found: list[str]) -> list[str]:
    return [text.partition(" ")[2] for text in found]


def test_nothing_happens_to_what_nothing_touches(happens: Happens) -> None:
    assert happens({"ball": atoms_at((0, 0, 5)), "floor": FLOOR}, 200, collisions={"land": LAND}) == []


def test_each_bounce_is_one_and_begins_with_a_first_contact(happens: Happens) -> None:
    """From 4 above contact a ball falls 126 rounds, and comes again every 252 rounds and some for the contact."""
    found = happens(
        {"ball": atoms_at((0, 0, 6)), "floor": FLOOR},
        1130,
        record_every=5,
        collisions={"land": LAND},
        forces={"weight": WEIGHT, "ground": HELD},
    )
    assert without_rounds(found) == ["ball touches floor", *["ball bounces off floor"] * 4]
    rounds = [int(text.split()[0]) for text in found]
    assert rounds[0] == 130
    assert np.diff(rounds[1:]) == pytest.approx([262] * 3, abs=10)


def test_a_hop_is_no_bounce_and_a_damped_ball_comes_to_rest(happens: Happens) -> None:
    found = happens(
        {"ball": atoms_at((0, 0, 2.4)), "floor": FLOOR},
        1500,
        collisions={"land": LAND},
        forces={"weight": WEIGHT, "air": {"kind": "damping", "acts_on": "ball", "coefficient": 0.02}, "ground": HELD},
    )
    assert without_rounds(found) == ["ball touches floor", "ball comes to rest"]


def test_what_is_lifted_does_not_bounce(happens: Happens) -> None:
    found = happens(
        {"ball": atoms_at((0, 0, 2.05)), "floor": FLOOR},
        600,
        collisions={"land": LAND},
        forces={
            "weight": WEIGHT,
            "crane": {"kind": "push", "acts_on": "ball", "impulse": [0, 0, 0.02], "from_round": 100},
            "air": {"kind": "damping", "acts_on": "ball", "coefficient": 0.05},
            "ground": HELD,
        },
    )
    assert without_rounds(found) == ["ball touches floor", "ball leaves floor"]


def test_a_ball_that_slides_over_the_edge_falls_off(happens: Happens) -> None:
    found = happens(
        {"ball": atoms_at((0, 0, 2), velocity=[0.7, 0, 0]), "floor": FLOOR},
        600,
        collisions={"land": LAND},
        forces={"weight": WEIGHT, "ground": HELD},
    )
    assert without_rounds(found) == ["ball touches floor", "ball leaves floor", "ball falls off floor"]


def test_a_ball_that_goes_through_a_hoop_falls_through(happens: Happens) -> None:
    """It meets the hoop on its inner side, from above."""
    found = happens(
        {"ball": atoms_at((2.2, 0, 4)), "floor": {"shape": "ring", "count": 12, "radius": 3}},
        1100,
        collisions={"land": LAND},
        forces={"weight": WEIGHT, "air": {"kind": "damping", "acts_on": "ball", "coefficient": 0.05}, "ground": HELD},
    )
    assert without_rounds(found) == ["ball touches floor", "ball leaves floor", "ball falls through floor"]


def push_at_the_top(impulse: float, until_round: int) -> dict[str, Any]:
    return {
        "kind": "push",
        "acts_on": "tower[0:2, 0:2, 7]",
        "impulse": [impulse, 0, 0],
        "from_round": 300,
        "until_round": until_round,
    }


@pytest.mark.parametrize(("impulse", "topples"), [(0.02, True), (0.0, False)])
def test_a_tower_that_is_pushed_topples(impulse: float, topples: bool, happens: Happens) -> None:
    found = happens(
        {"tower": TOWER, "floor": {**FLOOR, "counts": [21, 9]}},
        1500,
        bonds={"tower": {"within": "tower", "rule": "distance-threshold", "threshold": 2.5}},
        collisions={"land": {"between": ["tower", "floor"]}},
        forces={
            "weight": {**WEIGHT, "acts_on": "tower"},
            "air": {"kind": "damping", "acts_on": "tower", "coefficient": 0.01},
            "push": push_at_the_top(impulse or 1e-9, 500),
            "ground": HELD,
        },
    )
    assert ("tower topples" in without_rounds(found)) == topples
    assert "tower touches floor" in without_rounds(found)


def test_what_nothing_carries_turns_over_and_does_not_topple(happens: Happens) -> None:
    found = happens(
        {"tower": {**TOWER, "spin": {"axis": "x", "rate": 0.2}}, "floor": FLOOR},
        400,
        bonds={"tower": {"within": "tower", "rule": "all-pairs"}},
        time_step=0.02,
    )
    assert found == []


def test_a_fluid_touches_and_rests_but_does_not_bounce(happens: Happens) -> None:
    drops = {"shape": "block", "counts": [3, 3, 1], "spacing": 2.5, "centre": [0, 0, 4]}
    found = happens(
        {"ball": drops, "floor": FLOOR}, 600, collisions={"land": LAND}, forces={"weight": WEIGHT, "ground": HELD}
    )
    assert without_rounds(found) == ["ball touches floor"]


def test_two_pucks_bounce_and_part(happens: Happens) -> None:
    found = happens(
        {"left": atoms_at((-5, 0, 0), velocity=[1, 0, 0]), "right": atoms_at((5, 0.5, 0), velocity=[-1, 0, 0])},
        300,
        collisions={"hit": {"between": ["left", "right"]}},
    )
    assert without_rounds(found) == ["left touches right", "left bounces off right", "left leaves right"]


def test_parts_of_one_body_and_held_parts_do_not_meet() -> None:
    loaded = atomsim.loads(
        to_yaml(
            {
                "atomsim": 1,
                "time_step": 0.05,
                "rounds": 1,
                "groups": {
                    "wall": atoms_at((7.5, 0, 0)),
                    "left": atoms_at((0, 0, 0), (2.5, 0, 0)),
                    "right": atoms_at((5, 0, 0)),
                    "free": {"shape": "string", "count": 3, "step": [0, 3, 0], "centre": [0, 20, 0]},
                },
                "bonds": {
                    "joint": {"between": ["left", "right"], "rule": "all-pairs"},
                    "free": {"within": "free", "rule": "neighbour"},
                },
                "collisions": {
                    "any": {"among": ["left", "right", "wall"]},
                    "one": {"between": [["wall", "left"], "free[0]"]},
                    "own": {"within": ["free", "left"]},
                },
                "forces": {"fixed": {"kind": "hold", "acts_on": ["right", "wall"]}},
            }
        )
    )
    model, _ = atomsim.compile(loaded)
    bond = np.concatenate([np.column_stack((table.first, table.second)) for table in model.bonds]).astype(np.int32)
    parts = parts_of(loaded.scene, bond)
    assert [part.name for part in parts if part.is_string] == ["free"]
    assert [part.name for part in parts if part.is_body] == ["left", "free"]
    assert [part.name for part in parts if part.is_held] == ["wall", "right"]
    pairs = pairs_of(loaded.scene, parts)
    assert [pair.names for pair in pairs] == [("left", "wall"), ("free", "wall"), ("left", "free")]
    assert [atoms.tolist() for atoms in pairs[1].atoms] == [[4], [0]]


def test_each_copy_of_a_group_is_a_part(happens: Happens) -> None:
    found = happens(
        {
            "ball": atoms_at((-4, 0, 3), copies={"count": 2, "step": [8, 0, 0]}),
            "floor": {**FLOOR, "centre": [-4, 0, 0]},
        },
        200,
        collisions={"land": LAND},
        forces={"weight": WEIGHT, "ground": HELD},
    )
    assert set(without_rounds(found)) >= {"ball.0 touches floor"}
    assert not any("ball.1" in text for text in found)


def test_only_the_atoms_that_may_touch_do(happens: Happens) -> None:
    """The border of the floor is left out of the collisions, and a ball falls past it."""
    found = happens(
        {"ball": atoms_at((4.5, 0, 6)), "floor": FLOOR},
        300,
        collisions={"land": {"between": ["ball", "floor[2:7, 2:7]"]}},
        forces={"weight": WEIGHT, "ground": HELD},
    )
    assert found == []


def test_the_fastest_of_many_decides_on_rest(happens: Happens) -> None:
    found = happens(
        {"pair": atoms_at((0, 0, 0), (9, 0, 0), velocity=[1, 0, 0])},
        800,
        forces={"brake": {"kind": "damping", "acts_on": "pair[0]", "coefficient": 0.1}},
    )
    assert found == []


def test_stretches_begin_and_end_by_different_thresholds() -> None:
    series = np.array([0, 5, 3, 5, 1, 0, 5, 5, 4])
    assert stretches(series > 4, series < 2) == [(1, 3, 4), (6, 7, None)]
    assert stretches(series > 9, series < 2) == []
    assert stretches(series[:1] < 1, series[:1] > 2) == [(0, 0, None)]


def test_an_event_says_what_happened() -> None:
    assert str(Event(5, "wraps", ("thread", "rod"))) == "thread wraps around rod"
    for kind, sentence in SENTENCES.items():
        names = ("a", "b")[: sentence.count("{}")]
        assert all(name in str(Event(0, kind, names)) for name in names)
