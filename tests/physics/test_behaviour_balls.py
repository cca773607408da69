"""Figure 2: balls bounce, ripples cross the surface, it caves in, balls slide and fall off; each for its cause."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from support.behaviour.balls import (
    CONTACT,
    arrival,
    column,
    depth_under,
    downhill,
    fell_off,
    first_touch,
    gap,
    rims,
    rise,
    slide,
)
from support.behaviour.runs import run

AS_IT_IS: tuple[str, ...] = ()
NO_COLLISIONS = ("collisions.bounce=null",)
NO_BONDS = ("bonds.surface=null",)
HARD_SURFACE = ("forces.floor={kind: hold, acts_on: surface}",)
HELD_RIM = ("forces.rim={kind: hold, acts_on: ['surface[0, :]', 'surface[-1, :]', 'surface[:, 0]', 'surface[:, -1]']}",)

BALLS = ["ball_1", "ball_2"]

RADIUS = 1.0
"""Of every atom: a ball that rises by more is plainly in the air."""

VISIBLE = 0.1
"""A tenth of the radius. The surface is flat and at rest before the impact, so anything above zero is a ripple."""

HOLLOW = CONTACT - np.sqrt(CONTACT**2 - 0.5)
"""How much deeper a ball lies between four atoms, √½ from each, than on top of one: the surface's own roughness."""

AT_REST = 450
"""From this round on `ball_2` rests on the surface (the paper's picture)."""

OFF_BY = 1150
"""By this round both balls have fallen off."""


@pytest.mark.parametrize(("ball", "height"), [("ball_1", 8), ("ball_2", 14)])
def test_balls_touch_when_gravity_says(ball: str, height: float) -> None:
    """From rest a ball falls τ·g·n(n + 1)/2 in n rounds; it touches the atom below it at distance 2."""
    fall = 2 * (height - CONTACT) / (0.05 * 0.01)
    touch = (np.sqrt(1 + 4 * fall) - 1) / 2
    assert first_touch(run("balls"), ball) == 10 * np.ceil(touch / 10)


@pytest.mark.parametrize(("overrides", "bounces"), [(AS_IT_IS, True), (NO_COLLISIONS, False)])
@pytest.mark.parametrize("ball", BALLS)
def test_both_balls_bounce(ball: str, overrides: tuple[str, ...], bounces: bool) -> None:
    assert (rise(run("balls", *overrides), ball) > RADIUS) == bounces


@pytest.mark.parametrize(("ball", "drop"), [("ball_1", 6), ("ball_2", 12)])
def test_the_surface_takes_energy_from_a_bounce_and_a_hard_one_takes_none(ball: str, drop: float) -> None:
    """On held atoms a ball comes back to where it was let go, to within its way in half a record of ten rounds."""
    speed = np.sqrt(2 * drop * 0.01 / 0.05)
    assert rise(run("balls"), ball) < drop / 2
    assert rise(run("balls", *HARD_SURFACE), ball) == pytest.approx(drop, abs=5 * 0.05 * speed)


@pytest.mark.parametrize(
    ("overrides", "ripples"), [(AS_IT_IS, True), (NO_COLLISIONS, False), (NO_BONDS, False), (HARD_SURFACE, False)]
)
def test_ripples_run_over_the_whole_surface(overrides: tuple[str, ...], ripples: bool) -> None:
    """From the column that the first ball hits to the farthest rim, column after column leaves its level in turn."""
    balls = run("balls", *overrides)
    arrivals = [arrival(balls, column(balls, x), VISIBLE) for x in range(6, -13, -1)]
    in_turn = None not in arrivals and all(near < far for near, far in pairwise(arrivals))
    assert in_turn == ripples


def test_no_ripple_outruns_the_bonds() -> None:
    """What happens to an atom is felt by its neighbours one round later: a column per round is the utmost speed."""
    balls = run("balls")
    for x in range(6, -13, -1):
        assert arrival(balls, column(balls, x), 0.0) >= 154 + (6 - x)


def test_ripples_reach_the_nearest_rim_first_and_the_farthest_last() -> None:
    """The rim x = 12 is 4 and 6 from the two impacts, y = ±12 are 9 to 15, and x = −12 is 18 and 20 away."""
    balls = run("balls")
    reached = {name: arrival(balls, atoms, VISIBLE) for name, atoms in rims(balls).items()}
    assert reached["x+"] < min(reached["y+"], reached["y-"])
    assert reached["x-"] > max(reached["y+"], reached["y-"])


@pytest.mark.parametrize(("overrides", "caves_in"), [(AS_IT_IS, True), (NO_COLLISIONS, False), (HARD_SURFACE, False)])
@pytest.mark.parametrize("round_index", [450, 700])
def test_the_surface_caves_in_under_a_resting_ball(
    round_index: int, overrides: tuple[str, ...], caves_in: bool
) -> None:
    """The ball rests: no further from the surface than its roughness allows; and sits deeper than that roughness."""
    balls = run("balls", *overrides)
    rests = gap(balls, "ball_2")[balls.frame(round_index)] < CONTACT + HOLLOW
    assert (rests and depth_under(balls, "ball_2", round_index) > HOLLOW) == caves_in


def test_the_cave_deepens() -> None:
    balls = run("balls")
    assert depth_under(balls, "ball_2", 700) > depth_under(balls, "ball_2", 450)


@pytest.mark.parametrize(("overrides", "slides"), [(AS_IT_IS, True), (NO_COLLISIONS, False), (HARD_SURFACE, False)])
@pytest.mark.parametrize("ball", BALLS)
def test_balls_slide_down_the_tilting_surface(ball: str, overrides: tuple[str, ...], slides: bool) -> None:
    """A ball that lies still stays in its hollow; one that slides passes into the next, an atom's spacing downhill."""
    balls = run("balls", *overrides)
    slope = downhill(balls, 700)
    steepness = np.linalg.norm(slope)
    way = slide(balls, ball, AT_REST, CONTACT + HOLLOW) @ slope
    assert (way > steepness) == slides


@pytest.mark.parametrize(("overrides", "tilts"), [(AS_IT_IS, True), (HELD_RIM, False), (HARD_SURFACE, False)])
def test_the_surface_tilts(overrides: tuple[str, ...], tilts: bool) -> None:
    """Across its 24 lengths the surface descends towards the balls by more than an atom is thick."""
    towards_balls = downhill(run("balls", *overrides), OFF_BY)[0]
    assert (24 * towards_balls > 2 * RADIUS) == tilts


@pytest.mark.parametrize(("overrides", "falls"), [(AS_IT_IS, True), (HELD_RIM, False), (HARD_SURFACE, False)])
@pytest.mark.parametrize("ball", BALLS)
def test_balls_fall_off(ball: str, overrides: tuple[str, ...], falls: bool) -> None:
    """Beside the surface and below all of it; a surface with its rim held caves in but cannot tilt."""
    fell = fell_off(run("balls", *overrides), ball)
    assert (fell is not None and fell <= OFF_BY) == falls
