"""Measures of the paper's scenes are what other formulas, written for the tests of behaviours, give of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.behaviour.balls import gap
from support.behaviour.rings import flex, on_ground, tilt, turned
from support.behaviour.runs import run
from support.behaviour.strings import EVERY, crossings, distance, winding
from support.running import SCENES

import atomsim

WINDING, CROSSINGS = "winding between right and left", "crossings between left and right"


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run of each scene that is measured here."""
    folder = tmp_path_factory.mktemp("files")
    for scene in ("balls", "rod-thread", "threads", "ring", "ring-elastic", "ring-soft"):
        atomsim.run(atomsim.load(SCENES / f"{scene}.yaml"), folder / f"{scene}.h5")
    return folder


@pytest.mark.parametrize("ball", ["ball_1", "ball_2"])
def test_gaps(files: Path, ball: str) -> None:
    measured = atomsim.measure(files / "balls.h5", f"gap between surface and {ball}")
    assert measured[f"gap between surface and {ball}"] + 2 == pytest.approx(gap(run("balls"), ball), abs=1e-11)


@pytest.mark.parametrize("scene", ["ring", "ring-elastic"])
def test_the_turning_of_rolling_rings(files: Path, scene: str) -> None:
    """The tests add up turnings from frame to frame in the plane; a ring that flexes turns a little otherwise so."""
    measured = atomsim.measure(files / f"{scene}.h5", ["turning of ring"])["turning of ring"]
    last = on_ground(run(scene)).stop - 1
    assert measured[last, 2] == pytest.approx(-np.degrees(turned(run(scene))), abs=3)
    assert np.abs(measured[:, :2]).max() < 1e-9


def test_the_tilt_of_the_ring_that_falls(files: Path) -> None:
    """The tests look at the plane that fits best, which is the plane of the ring as long as it hardly bends."""
    measured = atomsim.measure(files / "ring-soft.h5", ["tilt of ring", "deformation of ring"])
    assert measured["deformation of ring"].max() < 0.25
    assert measured["tilt of ring"] == pytest.approx(tilt(run("ring-soft")), abs=1)
    assert measured["tilt of ring"][-1] > 80


def test_a_ring_that_flexes_is_deformed(files: Path) -> None:
    """An ellipse of semi-axes R(1 ± f) is Rf/√2·√2/… away from the circle: between half of Rf and all of it."""
    measured = atomsim.measure(files / "ring-elastic.h5", "deformation of ring")["deformation of ring"]
    largest = measured[on_ground(run("ring-elastic"))].max()
    assert 0.5 < largest / (4 * flex(run("ring-elastic"))) < 1.5


def test_winding_and_crossings(files: Path) -> None:
    wound = atomsim.measure(files / "rod-thread.h5", WINDING)[WINDING]
    assert wound[::EVERY].max() == pytest.approx(np.degrees(winding(run("rod-thread"))), abs=3)
    crossed = atomsim.measure(files / "threads.h5", CROSSINGS)[CROSSINGS]
    assert crossed[::EVERY].max() == pytest.approx(crossings(run("threads")), abs=1e-9)


def test_distances(files: Path) -> None:
    measured = atomsim.measure(files / "threads.h5", "distance between left and right")
    assert measured["distance between left and right"] == pytest.approx(distance(run("threads")), abs=1e-11)
