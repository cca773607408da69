"""Figure 1: rods bounce apart and vibrate, a thread wraps around a rod, two threads entangle; each for its cause."""

from __future__ import annotations

import numpy as np
import pytest
from support.behaviour.runs import run
from support.behaviour.strings import crossings, distance, energy_kept, restitution, sag, swings, winding

AS_IT_IS: tuple[str, ...] = ()
NO_COLLISIONS = ("collisions.contact=null",)
RIGHT_IS_A_ROD = ("bonds.right.rule=all-pairs",)
BOTH_ARE_RODS = ("bonds.left.rule=all-pairs", *RIGHT_IS_A_ROD)

TOUCH = 200
"""Round at which the strings meet: 6 apart, closing 0.02 a round, they touch at distance 2, where they cross."""

VISIBLE = 0.1
"""A tenth of the radius of an atom [length]: a pixel, in a picture that shows a rod of 25 lengths with 250 pixels."""

OFTEN = 10
"""Swings that make a vibration: a rod that bends and springs back once changes sides at most twice."""

HALF_TURN = np.pi
"""No straight line winds further about any axis, and no rod is anything but straight, to within its sag."""

FULL_TURN = 2 * np.pi
"""Wrapped: wherever one looks out from the axis of the rod, there is thread."""

ROUNDING = 1e-9
"""Bound of the rounding errors: 4000 rounds · 70 forces · 2⁻⁵³ · coordinates of 20 is 6e-10."""


@pytest.mark.parametrize(("overrides", "bounces"), [(AS_IT_IS, True), (NO_COLLISIONS, False)])
def test_rods_bounce_apart(overrides: tuple[str, ...], bounces: bool) -> None:
    """Above a restitution of zero the strings turn back; zero is sticking together, below it one is past the other."""
    assert (restitution(run("rods", *overrides)) > 0) == bounces


def test_without_collisions_rods_pass_through_each_other_at_full_speed() -> None:
    assert restitution(run("rods", *NO_COLLISIONS)) == pytest.approx(-1, abs=ROUNDING)


def test_rods_are_parted_for_good() -> None:
    """After the last touch the distance only grows; in the last quarter of the run it does so without a pause."""
    apart = distance(run("rods"))
    assert (np.diff(apart[300:]) > 0).all()


@pytest.mark.parametrize(("overrides", "vibrates"), [(AS_IT_IS, True), (NO_COLLISIONS, False)])
@pytest.mark.parametrize("rod", ["left", "right"])
def test_rods_vibrate(rod: str, overrides: tuple[str, ...], vibrates: bool) -> None:
    assert (swings(sag(run("rods", *overrides), rod), VISIBLE) >= OFTEN) == vibrates


@pytest.mark.parametrize("rod", ["left", "right"])
def test_rods_are_straight_until_they_meet_and_stay_rods_after(rod: str) -> None:
    """Before the impact there is nothing but rounding; after it the vibrations are minute: less than an atom."""
    rods = run("rods")
    bent = np.abs(sag(rods, rod))
    assert bent[: rods.frame(TOUCH)].max() < ROUNDING
    assert bent.max() < 1


@pytest.mark.parametrize(("overrides", "wraps"), [(AS_IT_IS, True), (NO_COLLISIONS, False), (RIGHT_IS_A_ROD, False)])
def test_a_thread_wraps_around_a_rod(overrides: tuple[str, ...], wraps: bool) -> None:
    assert (winding(run("rod-thread", *overrides)) > FULL_TURN) == wraps


@pytest.mark.parametrize("overrides", [NO_COLLISIONS, RIGHT_IS_A_ROD])
def test_a_rod_winds_about_another_by_half_a_turn_at_most(overrides: tuple[str, ...]) -> None:
    assert winding(run("rod-thread", *overrides)) <= HALF_TURN + ROUNDING


@pytest.mark.parametrize(
    ("overrides", "is_inelastic"), [(AS_IT_IS, True), (NO_COLLISIONS, False), (RIGHT_IS_A_ROD, False)]
)
def test_the_collision_of_a_thread_with_a_rod_is_inelastic(overrides: tuple[str, ...], is_inelastic: bool) -> None:
    """They do not part the way they came, and have lost more of the energy of their approach than they kept."""
    strings = run("rod-thread", *overrides)
    assert (restitution(strings) <= 0 and energy_kept(strings) < 0.5) == is_inelastic


@pytest.mark.parametrize(("overrides", "entangle"), [(AS_IT_IS, True), (NO_COLLISIONS, False), (BOTH_ARE_RODS, False)])
def test_threads_entangle(overrides: tuple[str, ...], entangle: bool) -> None:
    """Two straight strings are seen to cross once at most, from any side; entangled ones twice on the average."""
    assert (crossings(run("threads", *overrides)) > 2) == entangle


@pytest.mark.parametrize("overrides", [NO_COLLISIONS, BOTH_ARE_RODS])
def test_straight_strings_cross_once_at_most(overrides: tuple[str, ...]) -> None:
    assert crossings(run("threads", *overrides)) <= 1 + ROUNDING


def test_entangled_threads_stay_near_while_rods_fly_apart() -> None:
    """Free of each other they would be 74 apart; entangled they are never further apart than a string is long."""
    length = 69 * np.sqrt(0.125)
    assert distance(run("threads")).max() < length < distance(run("rods")).max()
