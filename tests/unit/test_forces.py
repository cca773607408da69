"""Every kind of external force against its formula."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.running import after, atoms_at, compiled

from atomsim.core.forces import acting, held_atoms, law, quantise
from atomsim.core.model import Floats

PLACES: list[tuple[float, float, float]] = [(1, 0, 0), (0, 2, 0.5), (-1, -1, 3)]


def impulse(round_index: int = 0, velocity: Floats | None = None, **force: Any) -> Floats:
    """Return what a force adds to three atoms in a round, (3, 3), one row per atom."""
    model, state = compiled({"a": atoms_at(*PLACES)}, forces={"f": force})
    (force_on_them,) = acting(model.forces)
    total = np.zeros((3, 3))
    law(force_on_them)(
        round_index, state.position.T.copy(), np.zeros((3, 3)) if velocity is None else velocity.T.copy(), total
    )
    return total.T


def test_damping_takes_its_share_of_the_velocity() -> None:
    velocity = np.array([[1.0, 2, 3], [4, 5, 6], [7, 8, 9]])
    found = impulse(kind="damping", acts_on="a[:2]", coefficient=0.25, velocity=velocity)
    assert found.tolist() == [[-0.25, -0.5, -0.75], [-1, -1.25, -1.5], [0, 0, 0]]


def test_damping_slows_down_geometrically() -> None:
    model, state = compiled(
        {"a": atoms_at((0, 0, 0), velocity=[1, 0, -2])}, forces={"f": {"kind": "damping", "coefficient": 0.5}}
    )
    assert after(model, state, 10).velocity.tolist() == [[2.0**-10, 0, -(2.0**-9)]]


def test_gravity_is_the_same_in_every_round() -> None:
    for round_index in (0, 10**9):
        found = impulse(round_index, kind="gravity", acts_on=["a[0]", "a[2]"], impulse=[0.5, 0, -1])
        assert found.tolist() == [[0.5, 0, -1], [0, 0, 0], [0.5, 0, -1]]


def test_gravity_falls_as_calculated() -> None:
    """v(n) = n·g and c(n) = τ·g·n(n + 1)/2: positions move by the new velocity."""
    model, state = compiled(
        {"a": atoms_at((0, 0, 0))}, time_step=0.5, forces={"f": {"kind": "gravity", "impulse": [0, 0, -1]}}
    )
    end = after(model, state, 20)
    assert end.velocity.tolist() == [[0, 0, -20]]
    assert end.position.tolist() == [[0, 0, -0.5 * 20 * 21 / 2]]


@pytest.mark.parametrize(("round_index", "pushes"), [(0, False), (4, False), (5, True), (7, True), (8, False)])
def test_push_lasts_from_its_first_round_to_before_its_last(round_index: int, pushes: bool) -> None:
    found = impulse(round_index, kind="push", impulse=[1, 2, 3], from_round=5, until_round=8)
    assert found.tolist() == [[1, 2, 3] if pushes else [0, 0, 0]] * 3


def test_push_without_an_end_goes_on() -> None:
    assert impulse(10**12, kind="push", impulse=[1, 2, 3], from_round=5).tolist() == [[1, 2, 3]] * 3


def test_oscillate_swings_with_its_period_and_phase() -> None:
    for round_index, expected in [(0, 0.5), (2, 1.0), (5, 0.0), (8, -1.0), (12, 0.5)]:
        found = impulse(round_index, kind="oscillate", impulse=[0, 2, 0], period=12, phase=math.pi / 6)
        assert found[:, 1] == pytest.approx([2 * expected] * 3, abs=1e-11)
        assert not found[:, [0, 2]].any()


@pytest.mark.parametrize("axis", ["x", "z", [1, -2, 0.5]])
def test_torque_adds_up_to_its_magnitude_and_pushes_nowhere(axis: Any) -> None:
    found = impulse(kind="torque", axis=axis, magnitude=0.7)
    direction = np.array({"x": [1, 0, 0], "z": [0, 0, 1]}[axis] if isinstance(axis, str) else axis, dtype=float)
    direction /= np.linalg.norm(direction)
    arm = np.array(PLACES) - np.mean(PLACES, axis=0)
    assert np.cross(arm, found).sum(axis=0) @ direction == pytest.approx(0.7)
    assert found.sum(axis=0) == pytest.approx([0, 0, 0], abs=1e-15)
    assert found @ direction == pytest.approx([0, 0, 0], abs=1e-15)


def test_torque_about_other_atoms_takes_their_centroid() -> None:
    """z × (c − centre) is (2, 1, 0) for c − centre = (1, −2, −0.5), and its square 5."""
    found = impulse(kind="torque", acts_on="a[0]", axis="z", magnitude=3, about="a[1]")
    assert found == pytest.approx(np.array([[6 / 5, 3 / 5, 0], [0, 0, 0], [0, 0, 0]]))


def test_torque_on_its_own_axis_does_nothing() -> None:
    assert not impulse(kind="torque", acts_on="a[0]", axis="z", magnitude=3).any()


@pytest.mark.parametrize("rest", ["initial", 0, 1.5])
def test_tether_is_a_bond_to_its_target(rest: Any) -> None:
    found = impulse(kind="tether", target=[1, 1, 1], rest=rest)
    for row, place in zip(found, PLACES, strict=True):
        difference = np.array([1.0, 1, 1]) - place
        squared = difference @ difference
        rest_squared = squared if rest == "initial" else rest**2
        assert row == pytest.approx(difference * (1 - rest_squared / squared), abs=1e-15)


def test_tether_does_nothing_at_its_target() -> None:
    assert not impulse(kind="tether", acts_on="a[0]", target=[1, 0, 0], rest=2).any()


def test_hold_is_last_wherever_it_is_declared() -> None:
    model, state = compiled(
        {"a": atoms_at((0, 0, 0), (1, 0, 0), velocity=[0, 3, 0])},
        bonds={"b": {"within": "a", "rule": "all-pairs", "rest": 4}},
        forces={"h": {"kind": "hold", "acts_on": "a[0]"}, "g": {"kind": "gravity", "impulse": [1, 1, 1]}},
    )
    end = after(model, state, 7)
    assert end.velocity[0].tolist() == [0, 3, 0], "a conveyor keeps its velocity"
    assert end.velocity[1].tolist() != [0, 3, 0]
    assert end.position[0] == pytest.approx([0, 7 * 0.05 * 3, 0])
    assert held_atoms(model.forces).tolist() == [0]


def test_forces_add_up_in_their_order() -> None:
    """(0.1 + 0.2) + 0.3 is not 0.1 + (0.2 + 0.3)."""
    pushes = {f"f{number}": {"kind": "gravity", "impulse": [number / 10, 0, 0]} for number in (1, 2, 3)}
    model, state = compiled({"a": atoms_at((0, 0, 0))}, forces=pushes)
    assert after(model, state, 1).velocity[0, 0] == (0.1 + 0.2) + 0.3 != 0.1 + (0.2 + 0.3)


def test_quantise_leaves_what_is_beyond_its_grain() -> None:
    assert quantise(1 / 3) == round(2**40 / 3) / 2**40
    for value in (2.0**12, -(2.0**50), 1e300, math.inf, -math.inf):
        assert quantise(value) == value
