"""The nearest ball of every pixel, against a ray caster that takes one pixel and one ball at a time."""

import math

import numpy as np
import pytest

from atomsim.drawing import trace
from atomsim.drawing.trace import NOTHING, Coverage, Grid, nearest_ball, normals

GRID = Grid(-6.0, 4.5, 0.3, 40, 30)


def cast(seen, convergence, x, y):
    """Return ball and normal that the ray through (x, y, 0) strikes first, by vectors from the eye."""
    best = (math.inf, NOTHING, None)
    for ball, centre in enumerate(seen.T):
        if convergence:
            start, towards = np.array([0, 0, 1 / convergence]), np.array([x, y, -1 / convergence])
        else:
            start, towards = np.array([x, y, 1000.0]), np.array([0.0, 0.0, -1.0])
        towards = towards / math.sqrt(towards @ towards)
        along = (centre - start) @ towards
        short = (centre - start) @ (centre - start) - along * along
        if short < 1 and along - math.sqrt(1 - short) < best[0]:
            distance = along - math.sqrt(1 - short)
            best = (distance, ball, start + distance * towards - centre)
    return best[1:]


@pytest.mark.parametrize("convergence", [0.0, 0.015, 0.06])
def test_every_pixel_shows_the_nearest_ball_and_its_normal(convergence):
    seen = np.random.default_rng(4).uniform(-5, 5, size=(3, 40))
    owner = nearest_ball(seen, convergence, GRID)
    assert owner.shape == (30, 40)
    assert 0.2 < (owner == NOTHING).mean() < 0.8
    for row, y in enumerate(GRID.y()):
        for column, x in enumerate(GRID.x()):
            ball, normal = cast(seen, convergence, x, y)
            assert owner[row, column] == ball
            if ball != NOTHING:
                ours = normals(seen, np.array([ball]), np.array([x]), np.array([y]), convergence)
                np.testing.assert_allclose(ours[:, 0], normal, atol=1e-6)


def test_intersecting_balls_meet_on_the_plane_between_them():
    seen = np.array([[-0.5, 0.5], [0.0, 0.0], [0.0, 0.0]])
    owner = nearest_ball(seen, 0.0, Grid(-1.5, 1.0, 0.02, 150, 100))
    assert (owner[:, :75] != 1).all()
    assert (owner[:, 75:] != 0).all()
    assert (owner[:, ::-1] == np.array([1, 0, NOTHING])[owner]).all()


def test_the_size_of_a_batch_does_not_matter(monkeypatch):
    seen = np.random.default_rng(5).uniform(-5, 5, size=(3, 60))
    whole = nearest_ball(seen, 0.02, GRID)
    monkeypatch.setattr(trace, "_BATCH", 100)
    assert len(list(Coverage.of(seen, 0.02, GRID).fragments())) > 10
    assert (nearest_ball(seen, 0.02, GRID) == whole).all()


def test_bands_make_up_the_grid():
    seen = np.random.default_rng(6).uniform(-5, 5, size=(3, 60))
    bands = [GRID.band(first, 8) for first in range(0, 30, 8)]
    assert [band.n_rows for band in bands] == [8, 8, 8, 6]
    parts = [nearest_ball(seen, 0.02, band) for band in bands]
    assert (np.concatenate(parts) == nearest_ball(seen, 0.02, GRID)).all()


def test_what_is_outside_or_behind_the_eye_costs_nothing():
    seen = np.array([[0.0, 50.0, 0.0, 0.0], [0.0, 0.0, -50.0, 0.0], [0.0, 0.0, 0.0, 60.0]])
    assert Coverage.of(seen, 0.02, GRID).ball.tolist() == [0]


def test_a_ball_larger_than_the_picture_fills_it():
    tiny = Grid(-0.1, 0.1, 0.02, 10, 10)
    assert (nearest_ball(np.zeros((3, 1)), 0.0, tiny) == 0).all()


def test_no_balls_leave_the_picture_empty():
    assert (nearest_ball(np.empty((3, 0)), 0.02, GRID) == NOTHING).all()
