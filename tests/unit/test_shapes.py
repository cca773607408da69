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
