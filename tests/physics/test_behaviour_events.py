"""The events of the scenes of the paper are what must emerge in them, and not what they show without its cause."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.behaviour.balls import fell_off, first_touch
from support.behaviour.rings import tilt
from support.behaviour.runs import run
from support.running import SCENES

import atomsim
from atomsim.measures.attitude import TOPPLED
from atomsim.measures.events import Event

NO_COLLISIONS = "collisions.contact=null"
BALLS = ["ball_1", "ball_2"]
ROUNDS_OF_A_FRAME = 10


def events(folder: Path, scene: str, *overrides: str) -> list[Event]:
    """Return what happens in one of the paper's scenes, as it is or with changes."""
    out = folder / "out.h5"
    atomsim.run(atomsim.load(SCENES / f"{scene}.yaml", overrides), out, replace=True)
    return atomsim.events(out)


def told(found: list[Event]) -> list[str]:
    return [str(event) for event in found]


@pytest.fixture(scope="module")
def balls(tmp_path_factory: pytest.TempPathFactory) -> list[Event]:
    return events(tmp_path_factory.mktemp("balls"), "balls")


@pytest.mark.parametrize("ball", BALLS)
def test_balls_touch_bounce_leave_and_fall_off(balls: list[Event], ball: str) -> None:
    of_ball = [event for event in balls if event.names == (ball, "surface")]
    kinds = [event.kind for event in of_ball]
    assert kinds[:2] == ["first contact", "bounce"]
    assert kinds[-2:] == ["separation", "falls off"]
    assert of_ball[0].round_index == first_touch(run("balls"), ball)
    assert abs(of_ball[-1].round_index - fell_off(run("balls"), ball)) <= 2 * ROUNDS_OF_A_FRAME


def test_one_bounce_is_one_bounce(balls: list[Event]) -> None:
    """The first ball is seen to rise twice from the surface, the second once."""
    bounces = [event.names for event in balls if event.kind == "bounce"]
    assert (bounces.count(("ball_1", "surface")), bounces.count(("ball_2", "surface"))) == (2, 1)


def test_contacts_between_frames_are_found(balls: list[Event], tmp_path: Path) -> None:
    """The balls touch for seven rounds that no frame shows; recording every round shows no other events."""
    every = events(tmp_path, "balls", "record_every=1", "rounds=1300")
    some = [event for event in balls if event.round_index <= 1300]
    assert told(every) == told(some)
    assert "ball_1 touches ball_2" in told(some)
    assert all(0 <= one.round_index - other.round_index <= 20 for one, other in zip(some, every, strict=True))


def test_balls_on_a_held_surface_bounce_on_and_on(tmp_path: Path) -> None:
    found = told(events(tmp_path, "balls", "forces.floor={kind: hold, acts_on: surface}", "collisions.balls=null"))
    assert {text for text in found if "leaves" in text or "falls" in text} == set()
    assert found.count("ball_1 bounces off surface") >= 5


def test_without_collisions_nothing_happens(tmp_path: Path) -> None:
    assert events(tmp_path, "balls", "collisions.bounce=null", "collisions.balls=null", "rounds=1000") == []


def test_rods_bounce_apart(tmp_path: Path) -> None:
    assert told(events(tmp_path, "rods")) == [
        "left touches right",
        "left bounces off right",
        "left leaves right",
    ]
    assert events(tmp_path, "rods", NO_COLLISIONS, "rounds=1000") == []


def test_a_thread_sticks_to_a_rod_and_wraps_around_it(tmp_path: Path) -> None:
    found = told(events(tmp_path, "rod-thread"))
    assert found[:3] == ["left touches right", "left sticks to right", "right wraps around left"]
    assert not any("bounces" in text or "entangle" in text for text in found)


def test_threads_entangle(tmp_path: Path) -> None:
    assert told(events(tmp_path, "threads")) == ["left touches right", "left and right entangle"]


def test_a_ring_on_hard_ground_rolls_without_bouncing_or_toppling(tmp_path: Path) -> None:
    assert told(events(tmp_path, "ring", "rounds=3000")) == ["ring touches surface"]


def test_the_elastic_ring_rolls_off_the_end(tmp_path: Path) -> None:
    assert told(events(tmp_path, "ring-elastic")) == [
        "ring touches surface",
        "ring leaves surface",
        "ring falls off surface",
    ]


def test_on_soft_ground_the_ring_topples(tmp_path: Path) -> None:
    """When it does so is told by the plane that fits the ring best, frame by frame."""
    found = events(tmp_path, "ring-soft", "rounds=2000")
    assert told(found) == ["ring touches surface", "ring topples"]
    leaning = run("ring-soft").round[tilt(run("ring-soft")) > TOPPLED]
    assert abs(found[1].round_index - leaning[0]) <= ROUNDS_OF_A_FRAME
