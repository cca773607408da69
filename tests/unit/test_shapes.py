"""Where the atoms of every shape start and how fast."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.running import scene_of

from atomsim.compiler.shapes import count_atoms, place, unit
from atomsim.core.model import Floats


def placed(**group: Any) -> tuple[Floats, Floats]:
    shape = scene_of({"g": group}).groups["g"]
    position, velocity = place(shape)
    assert count_atoms(shape) == len(position) == len(velocity)
    return position, velocity


def test_string_is_centred_and_runs_along_its_step() -> None:
    position, velocity = placed(shape="string", count=4, step=[1, 0, -0.5], centre=[10, 0, 1], velocity=[1, 2, 3])
    assert position.tolist() == [[8.5, 0, 1.75], [9.5, 0, 1.25], [10.5, 0, 0.75], [11.5, 0, 0.25]]
    assert velocity.tolist() == [[1, 2, 3]] * 4


def test_string_from_here_to_there() -> None:
    position, _ = placed(shape="string", count=5, **{"from": [1, 2, 3], "to": [3, 2, 1]})
    assert position.tolist() == [[1, 2, 3], [1.5, 2, 2.5], [2, 2, 2], [2.5, 2, 1.5], [3, 2, 1]]
    turned, _ = placed(
        shape="string", count=5, rotate={"axis": "y", "degrees": 180}, **{"from": [1, 2, 3], "to": [3, 2, 1]}
    )
    assert turned == pytest.approx(position[::-1])


@pytest.mark.parametrize(("spacing", "n_atoms"), [(1, 5), (1.5, 4), (0.8, 6), (100, 2)])
def test_string_from_here_to_there_with_a_spacing_that_is_made_to_fit(spacing: float, n_atoms: int) -> None:
    position, _ = placed(shape="string", spacing=spacing, **{"from": [0, 0, 0], "to": [0, 0, -4]})
    assert position[:, 2].tolist() == pytest.approx(np.linspace(0, -4, n_atoms).tolist())
    assert (position[0].tolist(), position[-1].tolist()) == ([0, 0, 0], [0, 0, -4])


def test_string_that_begins_here() -> None:
    position, velocity = placed(
        shape="string", count=3, step=[0, 0, -1.5], spin={"axis": "x", "rate": 2}, **{"from": [5, 0, 9]}
    )
    assert position.tolist() == [[5, 0, 9], [5, 0, 7.5], [5, 0, 6]]
    assert velocity.tolist() == [[0, -3, 0], [0, 0, 0], [0, 3, 0]]  # about the middle


@pytest.mark.parametrize(("axis", "first", "second"), [("z", 0, 1), ("y", 0, 2), ("x", 1, 2)])
def test_ring_counts_its_angle_from_the_first_axis_of_its_plane(axis: str, first: int, second: int) -> None:
    position, _ = placed(shape="ring", count=8, radius=2, axis=axis)
    angle = np.arange(8) * math.pi / 4
    expected = np.zeros((8, 3))
    expected[:, first], expected[:, second] = 2 * np.cos(angle), 2 * np.sin(angle)
    assert np.abs(position - expected).max() <= 2.0**-41
    assert (position * 2.0**40 == np.round(position * 2.0**40)).all()


def test_polygon_divides_every_side_evenly() -> None:
    position, _ = placed(shape="polygon", corners=[[0, 0, 0], [4, 0, 0], [4, 3, 0]], spacing=0.9, centre=[1, 1, 1])
    steps = np.linalg.norm(np.roll(position, -1, axis=0) - position, axis=1)
    assert steps == pytest.approx([1] * 4 + [1] * 3 + [5 / 6] * 6)
    assert position.mean(axis=0) == pytest.approx([1, 1, 1])


def test_polygon_with_a_spacing_beyond_its_sides_keeps_its_corners() -> None:
    position, _ = placed(shape="polygon", corners=[[0, 0, 0], [3, 0, 0], [0, 3, 0]], spacing=100)
    assert position == pytest.approx(np.array([[-1, -1, 0], [2, -1, 0], [-1, 2, 0]]))


def test_plane_numbers_x_first() -> None:
    position, _ = placed(shape="plane", counts=[3, 2], step_x=[1, 0, 0], step_y=[0, 0, 2], centre=[0, 5, 0])
    assert position.tolist() == [[x, 5, z] for z in (-1, 1) for x in (-1, 0, 1)]


def test_block_numbers_x_fastest() -> None:
    position, _ = placed(shape="block", counts=[2, 3, 2], spacing=2)
    assert position.tolist() == [[x, y, z] for z in (-1, 1) for y in (-2, 0, 2) for x in (-1, 1)]


def test_atoms_stay_where_they_are_written() -> None:
    written = [[0.1, 0.2, 0.3], [5, 0, 0]]
    position, _ = placed(shape="atoms", positions=written)
    assert position.tolist() == written


def test_atoms_move_to_their_centre_if_they_have_one() -> None:
    position, _ = placed(shape="atoms", positions=[[0, 0, 0], [2, 0, 0]], centre=[0, 7, 0])
    assert position.tolist() == [[-1, 7, 0], [1, 7, 0]]


def test_atoms_turn_about_their_own_centroid() -> None:
    turn = {"axis": "z", "degrees": 90}
    position, _ = placed(shape="atoms", positions=[[4, 0, 0], [6, 0, 0]], rotate=turn)
    assert position == pytest.approx(np.array([[5, -1, 0], [5, 1, 0]]))


def test_turns_follow_one_another_and_are_right_handed() -> None:
    turns = [{"axis": "z", "degrees": 90}, {"axis": "x", "degrees": 90}]
    position, _ = placed(shape="string", count=2, step=[2, 0, 0], rotate=turns, centre=[0, 0, 10])
    assert position == pytest.approx(np.array([[0, 0, 9], [0, 0, 11]]))  # x to y to z


def test_a_turn_keeps_distances_about_any_axis() -> None:
    position, _ = placed(shape="string", count=3, step=[1, 2, 3], rotate={"axis": [1, -2, 0.5], "degrees": 33})
    assert np.linalg.norm(position[2] - position[0]) == pytest.approx(2 * math.sqrt(14))


def test_spin_is_axis_cross_offset_besides_the_velocity() -> None:
    _, velocity = placed(
        shape="string",
        count=2,
        step=[2, 0, 0],
        centre=[9, 9, 9],
        spin={"axis": [0, 0, 5], "rate": 3},
        velocity=[0, 0, 1],
    )
    assert velocity.tolist() == [[0, -3, 1], [0, 3, 1]]


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_unit_needs_no_particular_length(scale: float) -> None:
    assert unit((0.0, 3 * scale, -4 * scale)) == pytest.approx([0, 0.6, -0.8])


def nearest(position: Floats) -> Floats:
    """Return how far each atom is from the one nearest to it."""
    apart = np.linalg.norm(position[:, None] - position, axis=2)
    np.fill_diagonal(apart, np.inf)
    return np.min(apart, axis=1)


@pytest.mark.parametrize(("radius", "spacing"), [(2, 1), (4, 2), (3, 0.7), (6.1, 1.9)])
def test_hollow_ball_is_evenly_covered_on_its_surface(radius: float, spacing: float) -> None:
    position, _ = placed(shape="ball", radius=radius, spacing=spacing, hollow=True, centre=[1, 2, 3])
    offset = position - [1, 2, 3]
    assert np.linalg.norm(offset, axis=1) == pytest.approx(np.full(len(offset), radius))
    assert np.abs(offset.mean(axis=0)).max() < 1e-11
    assert 0.8 * spacing < nearest(position).min() <= nearest(position).max() < 1.2 * spacing
    per_area = len(offset) * spacing**2 / (4 * math.pi * radius**2)
    assert 0.9 < per_area < 1.15
    assert (offset[0].tolist(), offset[-1].tolist()) == ([0, 0, -radius], [0, 0, radius])


def test_solid_ball_is_a_point_and_balls_around_it() -> None:
    position, _ = placed(shape="ball", radius=3, spacing=1)
    shells = [placed(shape="ball", radius=radius, spacing=1, hollow=True)[0] for radius in (1, 2, 3)]
    assert position.tolist() == np.concatenate([np.zeros((1, 3)), *shells]).tolist()
    assert 0.8 < nearest(position).min() <= nearest(position).max() < 1.2
    per_volume = len(position) / (4 * math.pi / 3 * 3.5**3)
    assert 0.9 < per_volume < 1.1


def test_a_ball_smaller_than_its_spacing_is_still_round() -> None:
    position, _ = placed(shape="ball", radius=0.5, spacing=9)
    assert len(position) == 6  # a point, two poles, a triangle
    assert np.linalg.norm(position[1:], axis=1) == pytest.approx(np.full(5, 0.5))


@pytest.mark.parametrize(
    ("radius", "spacing", "hollow"),
    [(1e6, 1.0, False), (1e6, 1.0, True), (1e300, 1e-300, True), (1e308, 1e-9, False), (1e300, 1e300, False)],
)
def test_absurd_balls_are_counted_at_once(radius: float, spacing: float, hollow: bool) -> None:
    shape = scene_of({"g": {"shape": "ball", "radius": radius, "spacing": spacing, "hollow": hollow}}).groups["g"]
    assert (count_atoms(shape) > 10**9) == (radius / spacing > 1)


def test_copies_along_a_line() -> None:
    position, velocity = placed(
        shape="string", count=2, step=[1, 0, 0], velocity=[0, 1, 0], copies={"count": 3, "step": [0, 0, 5]}
    )
    assert position.tolist() == [[x, 0, z] for z in (0, 5, 10) for x in (-0.5, 0.5)]
    assert velocity.tolist() == [[0, 1, 0]] * 6


def test_copies_about_an_axis_are_turned_and_so_is_how_they_move() -> None:
    position, velocity = placed(
        shape="string",
        count=2,
        velocity=[1, 0, 2],
        copies={"count": 4, "axis": "z"},
        **{"from": [3, 0, 1], "to": [5, 0, 1]},
    )
    directions = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    assert position[:, :2] == pytest.approx(np.concatenate([[3 * way, 5 * way] for way in directions]))
    assert position[:, 2].tolist() == [1] * 8
    assert velocity[:, :2] == pytest.approx(np.repeat(directions, 2, axis=0))
    assert velocity[:, 2].tolist() == [2] * 8


def test_copies_about_an_axis_through_a_point_by_an_angle() -> None:
    position, _ = placed(
        shape="atoms",
        positions=[[3, 1, 7]],
        copies={"count": 3, "axis": [0, 0, 2], "through": [1, 1, 0], "degrees": -90},
    )
    assert position == pytest.approx(np.array([[3, 1, 7], [1, -1, 7], [-1, 1, 7]]))


def test_copies_of_copies_are_numbered_the_first_fastest() -> None:
    position, _ = placed(
        shape="atoms", positions=[[0, 0, 0]], copies=[{"count": 2, "step": [1, 0, 0]}, {"count": 3, "step": [0, 9, 0]}]
    )
    assert position.tolist() == [[x, y, 0] for y in (0, 9, 18) for x in (0, 1)]


def test_the_first_copy_is_where_it_is_written() -> None:
    keys = {"shape": "ring", "count": 7, "radius": 1.1, "centre": [0.1, 0.2, 0.3]}
    alone, _ = placed(**keys)
    for copies in ({"count": 1, "axis": "y"}, {"count": 5, "axis": [1, 2, 3], "through": [9, 9, 9]}):
        assert placed(**keys, copies=copies)[0][:7].tolist() == alone.tolist()
