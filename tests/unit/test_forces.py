"""Every kind of external force against its formula."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.running import after, atoms_at, compiled

from atomsim.core.diagnosis.stiffness import largest_stiffness
from atomsim.core.forces import acting, held_atoms, law, quantise
from atomsim.core.model import Floats, State

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


def test_push_towards_a_point_has_its_magnitude_in_every_distance() -> None:
    found = impulse(kind="push", towards=[0, 0, 0], magnitude=0.5)
    for pushed, place in zip(found, PLACES, strict=True):
        assert pushed == pytest.approx(-0.5 * np.array(place) / math.hypot(*place))
    assert impulse(kind="push", towards=[0, 0, 0], magnitude=-0.5).tolist() == (-found).tolist()


def test_push_towards_atoms_goes_to_their_centroid_and_nowhere_from_there() -> None:
    found = impulse(kind="push", towards=["a[0]", "a[1]"], acts_on="a[:2]", magnitude=math.sqrt(5.25) / 2)
    assert found == pytest.approx(np.array([[-0.5, 1, 0.25], [0.5, -1, -0.25], [0, 0, 0]]))
    assert impulse(kind="push", towards="a[2]", acts_on="a[2]", magnitude=1).tolist() == np.zeros((3, 3)).tolist()


@pytest.mark.parametrize(("round_index", "pushes"), [(4, False), (5, True), (7, True), (8, False)])
def test_push_towards_lasts_as_any_push(round_index: int, pushes: bool) -> None:
    found = impulse(round_index, kind="push", towards=[9, 9, 9], magnitude=1, from_round=5, until_round=8)
    assert found.any() == pushes


def test_push_towards_follows_what_moves() -> None:
    groups = {"dog": atoms_at((0, 0, 0)), "cat": atoms_at((3, 0, 0), velocity=[0, 1, 0])}
    chase = {"kind": "push", "acts_on": "dog", "towards": "cat", "magnitude": 1e-3}
    model, state = compiled(groups, time_step=0.5, forces={"f": chase})
    later = after(model, state, 12)  # the cat is at (3, 6, 0)
    dog = after(model, later, 1).velocity[0] - later.velocity[0]
    assert dog == pytest.approx(1e-3 * np.array([3, 6, 0]) / math.hypot(3, 6), rel=0.02)


def test_push_towards_copies_draws_each_to_its_own() -> None:
    groups = {
        "a": {**atoms_at((1, 0, 0)), "copies": {"count": 3, "step": [0, 9, 0]}},
        "b": {**atoms_at((0, 0, 0)), "copies": {"count": 3, "step": [0, 9, 0]}},
    }
    force = {"kind": "push", "acts_on": "a", "towards": "b", "magnitude": 0.25}
    assert after(*compiled(groups, forces={"f": force}), 1).velocity[:3].tolist() == [[-0.25, 0, 0]] * 3


def test_tether_to_where_each_atom_starts_is_a_spring_of_stiffness_one() -> None:
    model, state = compiled({"a": atoms_at(*PLACES)}, forces={"f": {"kind": "tether", "target": "initial"}})
    assert after(model, state, 100).position.tolist() == state.position.tolist()
    moved = State(0, state.position + np.array([0.5, -0.25, 0]), state.velocity)
    assert after(model, moved, 1).velocity.tolist() == [[-0.5, 0.25, 0]] * 3
    assert largest_stiffness(model, moved) == pytest.approx(1)


def test_tether_to_where_each_atom_starts_counts_from_before_jitter() -> None:
    groups, forces = {"a": atoms_at(*PLACES)}, {"f": {"kind": "tether", "target": "initial"}}
    model, state = compiled(groups, jitter={"amplitude": 0.1, "seed": 3}, forces=forces)
    assert after(model, state, 1).velocity == pytest.approx(np.array(PLACES) - state.position)
