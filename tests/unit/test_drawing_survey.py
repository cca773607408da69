"""Which rounds tell most, and from where motion is seen: on runs whose motion is known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
import pytest

from atomsim.core.model import Frame, GroupSpan, Observables, Origin, State
from atomsim.drawing.survey import MOST_FRAMES, Motion, survey, telling
from atomsim.errors import InputError

NOTHING = Observables(0.0, 0.0, 0.0, np.zeros(3), np.zeros(3), 0)
FLOOR = np.array([[x, y, 0.0] for x in range(-9, 10, 3) for y in range(-9, 10, 3)])
ORIGIN = Origin("groups", "any", "s.yaml", 1)


class Run(Sequence[Frame]):
    """A held floor and balls, each where a function of the round puts it."""

    def __init__(self, n_frames: int, *balls: Callable[[int], tuple[float, float, float]]) -> None:
        self._n_frames, self._balls = n_frames, balls
        starts = [0, *(len(FLOOR) + number for number in range(len(balls) + 1))]
        self.groups = [
            GroupSpan(f"group_{number}", start, stop, *(["#000000"] if "color" in GroupSpan.__slots__ else []), ORIGIN)
            for number, (start, stop) in enumerate(pairwise(starts))
        ]
        self.read: list[int] = []

    def __len__(self) -> int:
        return self._n_frames

    def __getitem__(self, index: int) -> Frame:  # type: ignore[override]
        if not 0 <= index < self._n_frames:
            raise IndexError
        self.read.append(index)
        before, now, later = (
            np.array([ball(number) for ball in self._balls]) for number in (index - 1, index, index + 1)
        )
        position = np.concatenate([FLOOR, now])
        velocity = np.concatenate([np.zeros_like(FLOOR), np.nan_to_num(later - before) / 2])
        return Frame(State(index, position, velocity), float(index), "", NOTHING)

    def telling(self, n_frames: int = 6) -> list[int]:
        return telling([survey(self, self.groups)], n_frames).tolist()

    def azimuth(self, up: str = "z") -> float:
        return survey(self, self.groups).motion.azimuth(up)


def still(_: int) -> tuple[float, float, float]:
    return (0.0, 0.0, 3.0)


def test_where_nothing_happens_the_rounds_are_evenly_spread():
    assert Run(11, still).telling() == [0, 2, 4, 6, 8, 10]
    assert Run(101, lambda number: (0.1 * number, 0.0, 3.0)).telling() == [0, 20, 40, 60, 80, 100]


@pytest.mark.parametrize("n_frames", [1, 2, 3, 5])
def test_of_few_rounds_all_are_shown(n_frames):
    assert Run(n_frames, still).telling() == list(range(n_frames))


def test_a_blow_late_in_a_run_is_shown_from_before_to_after():
    """Two rounds of two hundred, in which a slow ball is thrown back."""
    run = Run(200, lambda number: (-4 + 0.02 * min(number, 360 - number), 0.0, 3.0))
    shown = run.telling()
    assert [place for place in shown if 170 <= place < 180]
    assert [place for place in shown if 180 <= place < 190]
    assert shown[0] == 0
    assert shown[-1] == 199


def test_what_moves_in_a_moment_is_shown_although_all_else_of_the_run_is_rest():
    run = Run(200, lambda number: (0.0, 0.4 * min(max(number - 100, 0), 10), 3.0))
    assert len([place for place in run.telling() if 98 <= place <= 112]) >= 3


def test_shaking_is_no_blow():
    """A ball that trembles from the start does not hide the blow that another gets."""

    def trembling(number: int) -> tuple[float, float, float]:
        return (3.0, 3.0, 3.0 + 0.3 * (-1) ** number)

    run = Run(400, lambda number: (-4 + 0.02 * min(number, 600 - number), 0.0, 3.0), trembling)
    assert len([place for place in run.telling() if 280 <= place <= 320]) >= 2


def test_what_has_left_the_scene_has_no_say():
    def falling(number: int) -> tuple[float, float, float]:
        return (0.0, 0.0, 3.0 - 0.05 * number**2)

    assert len([place for place in Run(200, falling).telling() if place < 40]) >= 4
    assert Run(200, falling, lambda number: (0.0, 4 - 0.04 * number, 5.0)).azimuth() == 160


def test_runs_side_by_side_show_the_same_rounds():
    left, right = Run(200, still), Run(200, lambda number: (-4 + 0.02 * min(number, 360 - number), 0.0, 3.0))
    surveys = [survey(run, run.groups) for run in (left, right)]
    together = telling(surveys, 6).tolist()
    assert [place for place in together if 170 <= place < 190]


def test_of_a_long_run_few_frames_are_read_and_damaged_ones_are_left_out():
    run = Run(5000, still)
    assert telling([survey(run, run.groups)], 6).tolist()[::5] == [0, 4999]
    assert len(run.read) <= MOST_FRAMES + 1

    class Damaged(Run):
        def __getitem__(self, index: int) -> Frame:
            if index == 4:
                raise InputError("damaged")
            return super().__getitem__(index)

    assert Damaged(11, still).telling(11) == [0, 1, 2, 3, 5, 6, 7, 8, 9, 10]


def test_numbers_that_are_none_do_no_harm():
    run = Run(20, lambda number: (np.nan if number == 7 else 0.0, 1e300 if number > 9 else 0.0, 3.0))
    assert len(run.telling()) == 6
    assert run.azimuth() == 30.0


@pytest.mark.parametrize(
    ("way", "up", "azimuth"),
    [
        ((0.0, 1.0, 0.0), "z", 30.0),  # the viewer on +x has +y to the right, and stands a little aside as usual
        ((0.0, -1.0, 0.0), "z", 160.0),
        ((1.0, 0.0, 0.0), "z", -70.0),
        ((-1.0, 0.0, 0.0), "z", 70.0),
        ((0.7, 0.7, 0.0), "z", -25.0),
        ((1.0, 0.0, 0.0), "y", 30.0),
        ((0.0, 0.0, 1.0), "y", -70.0),
        ((0.0, 0.0, 1.0), "z", 30.0),  # straight up
        ((0.1, 0.0, 1.0), "z", 30.0),  # nearly
        ((0.05, 0.0, 0.0), "z", 30.0),  # next to nothing
    ],
)
def test_the_main_motion_crosses_the_picture_from_left_to_right(way, up, azimuth):
    run = Run(100, lambda number: tuple(0.05 * number * part for part in way))  # type: ignore[arg-type, return-value]
    assert run.azimuth(up) == azimuth
    from atomsim.drawing.camera import View

    right, _, back = View(azimuth, 0.0, up).axes()
    if azimuth != 30.0:
        assert np.dot(right, way) > 0.8 * np.linalg.norm(way)
        assert abs(np.dot(back, way)) < 0.5 * np.linalg.norm(way)


def test_motion_to_and_fro_and_motion_apart_are_seen_across_but_no_motion_of_parts():
    assert Run(100, lambda number: (5 * np.sin(number), 0.0, 3.0)).azimuth() == 70.0
    assert (
        Run(100, lambda number: (0.05 * number, 0.0, 3.0), lambda number: (-0.05 * number, 1.0, 3.0)).azimuth() == 70.0
    )
    assert Run(100, lambda number: (5 * np.cos(number), 5 * np.sin(number), 3.0)).azimuth() == 30.0


def test_the_motion_of_several_runs_is_one():
    along_x, along_y = (Motion(np.eye(3)[axis] * 9, np.outer(np.eye(3)[axis], np.eye(3)[axis]) * 81) for axis in (0, 1))
    assert Motion.total([along_x, along_x]).azimuth("z") == along_x.azimuth("z") == -70.0
    assert Motion.total([along_x, along_y]).azimuth("z") == 30.0
