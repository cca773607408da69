"""Where the camera stands, and where positions appear in its picture."""

import itertools

import numpy as np
import pytest

from atomsim.drawing.camera import (
    CLOSEST_EYE,
    CLOSEST_WIDE_EYE,
    EYE_DISTANCE,
    Camera,
    View,
    cross,
    direction_of,
    dot,
    is_before_eye,
    outline,
)
from atomsim.errors import InputError

ANGLES = list(itertools.product((0.0, 30.0, -90.0, 200.0, 1e6), (0.0, 20.0, 90.0, -35.0), "xyz"))


@pytest.mark.parametrize(("azimuth", "elevation", "up"), ANGLES)
def test_axes_are_orthonormal_and_right_handed(azimuth, elevation, up):
    right, above, back = View(azimuth, elevation, up).axes()
    for one, other in itertools.combinations((right, above, back), 2):
        assert dot(one, other) == pytest.approx(0.0, abs=1e-11)
    assert cross(right, above) == pytest.approx(back, abs=1e-11)
    assert dot(back, back) == pytest.approx(1.0, abs=1e-11)


@pytest.mark.parametrize(
    ("azimuth", "up", "right", "back"),
    [
        (0.0, "z", (0, 1, 0), (1, 0, 0)),
        (90.0, "z", (-1, 0, 0), (0, 1, 0)),
        (-90.0, "z", (1, 0, 0), (0, -1, 0)),
        (0.0, "y", (1, 0, 0), (0, 0, 1)),
        (90.0, "y", (0, 0, -1), (1, 0, 0)),
        (0.0, "x", (0, 0, 1), (0, 1, 0)),
    ],
)
def test_azimuth_counts_from_the_axis_after_up(azimuth, up, right, back):
    view = View(azimuth, 0.0, up)
    assert view.axes()[0] == pytest.approx(right, abs=1e-11)
    assert view.axes()[1] == pytest.approx(view.vertical, abs=1e-11)
    assert view.axes()[2] == pytest.approx(back, abs=1e-11)


def test_elevation_lifts_the_viewer():
    assert View(0.0, 90.0).axes()[2] == pytest.approx((0, 0, 1), abs=1e-11)


@pytest.mark.parametrize(
    ("name", "up", "right", "back"),
    [
        ("front", "z", (1, 0, 0), (0, -1, 0)),
        ("side", "z", (0, 1, 0), (1, 0, 0)),
        ("top", "z", (1, 0, 0), (0, 0, 1)),
        ("front", "y", (1, 0, 0), (0, 0, 1)),
        ("side", "y", (0, 0, -1), (1, 0, 0)),
        ("top", "y", (1, 0, 0), (0, 1, 0)),
        ("front", "x", (0, 1, 0), (0, 0, -1)),
        ("side", "x", (0, 0, 1), (0, 1, 0)),
        ("top", "x", (0, 1, 0), (1, 0, 0)),
    ],
)
def test_directions_by_name(name, up, right, back):
    axes = View(*direction_of(name, None, None, up), up).axes()
    assert axes[0] == pytest.approx(right, abs=1e-11)
    assert axes[2] == pytest.approx(back, abs=1e-11)


def test_directions_without_a_name_are_as_said_or_as_usual():
    assert direction_of(None, None, None, "z") == (30.0, 20.0)
    assert direction_of(None, 70.0, None, "y") == (70.0, 20.0)
    assert direction_of(None, None, -5.0, "x") == (30.0, -5.0)


def test_see_and_place_are_inverse():
    camera = Camera.of(View(33.0, 12.0, "y"), (1.0, -2.0, 3.0), 20.0)
    points = np.random.default_rng(1).normal(size=(20, 3)) * 10
    seen = camera.see(points)
    assert seen.shape == (3, 20)
    assert [camera.place(tuple(column)) for column in seen.T.tolist()] == pytest.approx(points, abs=1e-10)


def test_the_eye_keeps_its_distance():
    assert Camera.of(View(), (0, 0, 0), 40.0).convergence == 1 / (40.0 * EYE_DISTANCE)
    assert Camera.of(View(), (0, 0, 0), 0.1).convergence == 1 / CLOSEST_EYE


def test_the_field_of_view_is_the_angle_of_the_width():
    for angle in (5.0, 40.0, 90.0, 120.0):
        camera = Camera.of(View(field_of_view=angle), (0, 0, 0), 40.0)
        assert 2 * np.degrees(np.arctan(20.0 * camera.convergence)) == pytest.approx(angle)
    assert Camera.of(View(field_of_view=0.0), (0, 0, 0), 40.0).convergence == 0.0
    assert Camera.of(View(field_of_view=120.0), (0, 0, 0), 0.1).convergence == 1 / CLOSEST_WIDE_EYE


@pytest.mark.parametrize("convergence", [0.0, 0.02, 0.07])
def test_outline_is_that_of_the_projected_sphere(convergence):
    seen = np.random.default_rng(2).normal(size=(3, 30)) * 4
    assert is_before_eye(seen, convergence).all()
    turn, lift = np.meshgrid(np.linspace(0, 2 * np.pi, 200), np.linspace(-np.pi / 2, np.pi / 2, 100))
    sphere = np.stack([np.cos(turn) * np.cos(lift), np.sin(turn) * np.cos(lift), np.sin(lift)]).reshape(3, 1, -1)
    points = seen[:, :, np.newaxis] + sphere
    projected = points[:2] / (1 - convergence * points[2])
    left, right, bottom, top = outline(seen, convergence)
    np.testing.assert_allclose(left, projected[0].min(axis=1), atol=2e-3)
    np.testing.assert_allclose(right, projected[0].max(axis=1), atol=2e-3)
    np.testing.assert_allclose(bottom, projected[1].min(axis=1), atol=2e-3)
    np.testing.assert_allclose(top, projected[1].max(axis=1), atol=2e-3)
    assert (left <= projected[0].min(axis=1) + 1e-12).all()
    assert (top >= projected[1].max(axis=1) - 1e-12).all()


def test_balls_at_and_behind_the_eye_are_not_before_it():
    seen = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [8.0, 10.0, 12.0]])
    assert is_before_eye(seen, 0.1).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        ({"azimuth": float("nan")}, "camera: azimuth must be a finite number of degrees (got nan)"),
        ({"elevation": float("inf")}, "camera: elevation must be a finite number of degrees (got inf)"),
        ({"look_at": (0.0, 2e9, 0.0)}, "camera: look_at must be within ±1e+09 (got [0.0, 2000000000.0, 0.0])"),
        ({"width": 0.0}, "camera: width must be from 0.001 to 1e+09 (got 0)"),
        ({"field_of_view": 121.0}, "camera: field_of_view must be from 0 to 120 (got 121)"),
        ({"field_of_view": float("nan")}, "camera: field_of_view must be from 0 to 120 (got nan)"),
        ({"width": float("nan")}, "camera: width must be from 0.001 to 1e+09 (got nan)"),
    ],
)
def test_impossible_views_are_refused(wish, message):
    with pytest.raises(InputError) as caught:
        View(**wish)
    assert str(caught.value) == message
