"""Measures resolved against a scene: of which atoms, bonds and collisions; and what is said where it makes no sense."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest
from support.running import atoms_at, scene_of

from atomsim.compiler import compile_scene
from atomsim.compiler.gauges import MeasureError, Subject, gauge_of
from atomsim.compiler.selections import SelectionError
from atomsim.core.gauges.block import Block
from atomsim.core.gauges.meter import Meter
from atomsim.core.observables import Observer
from atomsim.core.simulation import frame_of
from atomsim.scene import LoadedScene
from atomsim.scene.language.measures import QUANTITIES, QuantityName, parse_measure

SCENE = scene_of(
    {
        "ring": {"shape": "ring", "count": 8, "radius": 4, "centre": [1, 2, 3], "velocity": [0, 3, 4]},
        "floor": {"shape": "plane", "counts": [3, 2], "step_x": [3, 0, 0], "step_y": [0, 0, 3], "centre": [0, -1, 1.5]},
        "ball": atoms_at((0, 0.5, 3)),
    },
    bonds={
        "ring": {"within": "ring", "rule": "neighbour", "rest": 2},
        "cross": {"within": "ring", "rule": "pairs", "pairs": [[0, 4]], "rest": 0},
    },
    collisions={"land": {"between": ["ring", "floor"]}, "hit": {"between": ["ball", ["ring", "floor"]]}},
    render={"camera": {"up": "y"}},
)
MODEL, STATE = compile_scene(LoadedScene(SCENE))
SUBJECT = Subject.compiled(SCENE, MODEL, STATE)


def value(text: str) -> list[float]:
    measure = parse_measure(text)
    gauge = gauge_of(measure, SUBJECT)
    assert gauge.n_columns == len(measure.columns)
    block = Block.of_frame(frame_of(MODEL, STATE, Observer(MODEL).observe(STATE)))
    return Meter([gauge]).take(block)[0].tolist()


SIDE = 8 * math.sin(math.pi / 8)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("centroid of ring", [1, 2, 3]),
        ("x of ring", [1]),
        ("height of ring", [2]),
        ("height of [ring, ball]", [(8 * 2 + 0.5) / 9]),
        ("z of floor[:, -1]", [3]),
        ("lowest of ring", [-2]),
        ("highest", [6]),
        ("extent of ring", [8, 8, 0]),
        ("z of extent of floor", [3]),
        ("inner radius of ring", [4]),
        ("outer radius of floor", [math.sqrt(3**2 + 1.5**2)]),
        ("velocity of ring", [0, 3, 4]),
        ("speed of ring[3]", [5]),
        ("speed of all", [8 * 5 / 15]),
        ("speed", [8 * 5 / 15]),
        ("fastest", [5]),
        ("turning of ring", [0, 0, 0]),
        ("tilt of ring", [0]),
        ("deformation of floor", [0]),
        ("max strain of bonds.ring", [SIDE / 2 - 1]),
        ("mean strain of ring", [SIDE / 2 - 1]),
        ("min strain", [SIDE / 2 - 1]),
        ("contacts", [5]),
        ("contacts of ball", [1]),
        ("contacts of collisions.land", [4]),
        ("contacts between floor and ball", [1]),
        ("contacts between ball and ring", [0]),
        ("kinetic energy of ring", [0.5 * 8 * 25]),
        ("momentum of ring", [0, 24, 32]),
        ("x of angular momentum of ring[0:4]", None),
        ("distance between ring and floor", [math.sqrt(1 + 9 + 1.5**2)]),
        ("gap between ball and ring", [math.hypot(math.sqrt(8) - 1, math.sqrt(8) - 1.5) - 2]),
        ("overlap between ball and floor", [0.5]),
        ("relative velocity between ring and ball", [0, -3, -4]),
        ("closing speed between floor and ring", None),
        ("winding between ring and floor", None),
        ("crossings between ring and floor[0, :]", None),
        ("gap between ring and ring", [SIDE - 2]),
        ("bond energy", None),
        ("contact energy", None),
        ("energy", None),
    ],
)
def test_values(text: str, expected: list[float] | None) -> None:
    found = value(text)
    assert np.isfinite(found).all()
    assert expected is None or found == pytest.approx(expected, abs=1e-11)


def test_energies_are_those_of_the_frame() -> None:
    observed = Observer(MODEL).observe(STATE)
    parts = [observed.kinetic_energy, observed.potential_energy_bonds, observed.potential_energy_collisions]
    assert [*value("bond energy"), *value("contact energy"), *value("energy")] == [*parts[1:], sum(parts)]
    assert value("kinetic energy") == pytest.approx([parts[0]])
    assert value("contacts") == [observed.contacts]


def test_every_quantity_is_in_the_vocabulary_once() -> None:
    assert set(QUANTITIES) == set(get_args(QuantityName))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("height of rung", "there is no group `rung`; did you mean `ring`?"),
        ("gap between ring and water", "there is no group `water`; the groups are ring, floor, ball"),
        ("height of ring[8]", "`ring[8]` is out of range: ring has 8 there, 0 to 7"),
        ("height of floor[0, 0, 0]", "`floor[0, 0, 0]` has 3 indices, but floor is 3 × 2 atoms"),
    ],
)
def test_selections_that_name_no_atoms(text: str, message: str) -> None:
    with pytest.raises(SelectionError) as error:
        gauge_of(parse_measure(text), SUBJECT)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("max strain of bonds.rong", "there is no `bonds.rong`; did you mean `ring`?"),
        ("contacts of collisions.x", "there is no `collisions.x`; the collisions are land, hit"),
        ("max strain of ball", "there are no bonds of a length above zero here"),
        ("max strain of bonds.cross", "there are no bonds of a length above zero here"),
        ("tilt of ball", "`ball[0]` is a single atom, which has no attitude, and so no tilt"),
        ("turning of ring[3]", "`ring[3]` is a single atom, which has no attitude, and so no turning"),
        ("gap between ball and ball", "both selections are the same single atom"),
        ("distance between ring and ring[0:8]", "both selections are the same atoms"),
        ("x of relative velocity between ball and ball", "both selections are the same atoms"),
        ("winding between ring and ring", "both selections are the same atoms"),
        ("crossings between ring and ring", "both selections are the same atoms"),
        ("crossings between ring and ball", "`ball[0]` is a single atom, which crosses nothing"),
        ("winding between ball and ring", "`ball[0]` is a single atom, which cannot wind about anything"),
        ("winding between ring and ball", "`ball[0]` is a single atom, which has no axis to wind about"),
    ],
)
def test_measures_that_make_no_sense_of_what_they_name(text: str, message: str) -> None:
    with pytest.raises(MeasureError) as error:
        gauge_of(parse_measure(text), SUBJECT)
    assert str(error.value) == message


def test_nothing_is_compiled_for_what_positions_tell() -> None:
    def fail() -> None:
        raise AssertionError("was asked for")

    subject = Subject.of(SCENE, fail, fail)  # type: ignore[arg-type]
    for text in ("height of ring", "gap between ring and ball", "energy"):
        gauge_of(parse_measure(text), subject)
    with pytest.raises(AssertionError):
        gauge_of(parse_measure("contacts"), subject)
