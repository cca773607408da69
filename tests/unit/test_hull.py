"""Corners of convex hulls: none is lost, and nothing else is kept."""

import math

import numpy as np
import pytest

from atomsim.drawing.hull import hull

TURNS = [2 * math.pi * number / 90 for number in range(90)]


def test_no_point_reaches_farther_than_a_corner_and_none_is_kept_in_vain():
    rng = np.random.default_rng(11)
    for _ in range(200):
        x, y = rng.integers(-4, 5, size=(2, rng.integers(1, 40))).astype(float)
        corners = hull(x, y)
        for turn in TURNS:
            reach = math.cos(turn) * x + math.sin(turn) * y
            assert reach[corners].max() == pytest.approx(reach.max(), abs=1e-12)
        for corner in corners if len(corners) > 2 else ():
            others = [other for other in corners if other != corner]
            assert any(
                math.cos(turn) * x[corner] + math.sin(turn) * y[corner]
                > (math.cos(turn) * x[others] + math.sin(turn) * y[others]).max() - 0.02
                for turn in TURNS
            )


def test_of_a_grid_four_corners_are_left():
    x, y = (part.ravel() for part in np.meshgrid(np.arange(30.0), np.arange(20.0)))
    assert hull(x, y).tolist() == [0, 29, 570, 599]


@pytest.mark.parametrize(
    ("x", "y", "corners"),
    [
        ([], [], []),
        ([3.0], [4.0], [0]),
        ([1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [0]),
        ([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.0], [0, 3]),
        ([5.0, 5.0, 5.0], [1.0, 9.0, 4.0], [0, 1]),
    ],
)
def test_degenerate_points(x, y, corners):
    found = hull(np.array(x), np.array(y))
    assert {(x[point], y[point]) for point in found} == {(x[point], y[point]) for point in corners}
