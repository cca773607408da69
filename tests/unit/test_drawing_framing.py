"""What a row of pictures shows: everything that matters, and not what has left."""

from collections.abc import Sequence

import numpy as np
import pytest

from atomsim.drawing.camera import View, outline
from atomsim.drawing.framing import MARGIN, centred, fit, is_drawable, is_scenery

SIZE = (400, 300)


def grid_with_two_balls(height: float) -> np.ndarray:
    column, row = np.meshgrid(np.arange(25.0) - 12, np.arange(25.0) - 12)
    surface = np.stack([column.ravel(), row.ravel(), np.zeros(625)], axis=1)
    return np.vstack([surface, [[6, 2, height], [8, -3, height]]])


def reach(camera, atoms):
    """How far the balls extend from the middle of the picture, in halves of its width and of its height."""
    left, right, bottom, top = outline(camera.see(atoms), camera.convergence)
    half = camera.width / 2
    return max(right.max(), -left.min()) / half, max(top.max(), -bottom.min()) / (half * SIZE[1] / SIZE[0])


@pytest.mark.parametrize("view", [View(), View(0, 0), View(77, 50, "x"), View(-140, -20, "y"), View(0, 90)])
def test_whole_balls_fit_and_fill_the_picture(view):
    rng = np.random.default_rng(3)
    rounds = [rng.normal(size=(50, 3)) * [9, 4, 2] + [100, 0, k] for k in range(3)]
    camera = fit(view, rounds, SIZE)
    horizontal, vertical = reach(camera, np.concatenate(rounds))
    assert max(horizontal, vertical) == pytest.approx(1 / MARGIN, rel=1e-3)


@pytest.mark.parametrize("angle", [0.0, 30.0, 60.0, 90.0, 120.0])
def test_all_fits_whatever_the_field_of_view(angle):
    atoms = np.random.default_rng(3).normal(size=(200, 3)) * [9, 4, 2] + [5, -3, 1]
    camera = fit(View(40, 25, field_of_view=angle), [atoms], SIZE)
    assert max(reach(camera, atoms)) == pytest.approx(1 / MARGIN, rel=0.02)
    around = fit(View(40, 25, field_of_view=angle, look_at=(6.0, -2.0, 1.0)), [atoms], SIZE)
    assert around.centre == (6.0, -2.0, 1.0)
    assert max(reach(around, atoms)) == pytest.approx(1 / MARGIN, rel=0.02)


def test_one_atom_is_large_and_in_the_middle():
    camera = fit(View(), [np.array([[5.0, 6.0, 7.0]])], SIZE)
    assert camera.centre == pytest.approx((5, 6, 7))
    assert reach(camera, np.array([[5.0, 6.0, 7.0]]))[1] == pytest.approx(1 / MARGIN, rel=1e-3)


def test_what_fell_far_away_does_not_shrink_the_rest():
    start = grid_with_two_balls(8)
    without = fit(View(), [start[:625]], SIZE, start)
    after = fit(View(), [grid_with_two_balls(-500)], SIZE, start)
    assert after.width == without.width
    assert after.centre == without.centre


def test_what_is_leaving_is_still_shown():
    start = grid_with_two_balls(8)
    camera = fit(View(), [start, grid_with_two_balls(-8), grid_with_two_balls(-900)], SIZE)
    assert max(reach(camera, start)) <= 1
    assert max(reach(camera, grid_with_two_balls(-8))) <= 1


def test_a_scene_that_has_moved_as_a_whole_is_followed():
    start = grid_with_two_balls(8)
    moved = start + np.array([0.0, 300.0, 0.0])
    camera = fit(View(), [moved], SIZE, start)
    assert max(reach(camera, moved)) == pytest.approx(1 / MARGIN, rel=1e-3)


def test_two_halves_that_fly_apart_are_both_shown():
    string = np.stack([np.zeros(70), np.arange(70) * 0.25, np.zeros(70)], axis=1)
    aside = np.array([1.0, 0.0, 0.0])
    start = np.vstack([string - 3 * aside, string + 3 * aside])
    apart = np.vstack([string - 60 * aside, string + 60 * aside])
    assert max(reach(fit(View(), [apart], SIZE, start), apart)) <= 1


def floor_and_ball(height):
    column, row = np.meshgrid(np.arange(200.0) - 100, np.arange(200.0) - 100)
    floor = np.stack([column.ravel(), row.ravel(), np.zeros(column.size)], axis=1)
    return np.concatenate([floor, [[3.0, 4.0, height]]])


def test_scenery_is_what_stays_far_from_all_that_moves():
    low, high = floor_and_ball(2.0), floor_and_ball(12.0)
    scenery = is_scenery(low, high)
    far = np.abs(low[:, :2] - [3.0, 4.0]).max(axis=1) > 13
    assert (scenery == far).all()
    assert not is_scenery(low, low).any()  # where nothing moves, nothing is scenery
    assert not is_scenery(low[:1], high[:1]).any()


def test_scenery_does_not_shrink_the_rest():
    shown = [floor_and_ball(12.0), floor_and_ball(2.0)]
    scenery = is_scenery(shown[1], shown[0])
    camera = fit(View(), shown, SIZE, scenery=scenery)
    near = np.concatenate([atoms[~scenery] for atoms in shown])
    assert max(reach(camera, near)) == pytest.approx(1 / MARGIN, rel=1e-3)
    assert fit(View(), shown, SIZE).width > 4 * camera.width
    everything = np.ones(len(scenery), dtype=bool)
    assert fit(View(), shown, SIZE, scenery=everything) == fit(View(), shown, SIZE)


def test_rounds_are_taken_one_at_a_time_and_framed_as_if_all_were_there():
    """The outermost atoms of each round are enough."""

    class Shown(Sequence):
        def __len__(self):
            return 7

        def __getitem__(self, index):
            return np.random.default_rng(range(7)[index]).normal(size=(500, 3)) * [5, 3, 2]

    whole = np.concatenate(list(Shown()))
    for view in (View(), View(70, 40, "x"), View(look_at=(1.0, 2.0, 3.0)), View(width=9.0)):
        streamed = fit(view, Shown(), SIZE)
        at_once = fit(view, [whole], SIZE, Shown()[0])
        assert (streamed.centre, streamed.width) == (pytest.approx(at_once.centre), pytest.approx(at_once.width))


def test_positions_are_centred_on_some_atoms():
    atoms = np.array([[1.0, 2.0, 3.0], [3.0, 2.0, 1.0], [9.0, 9.0, 9.0], [np.nan, 0.0, 0.0]])
    moved = centred(atoms, np.array([0, 1, 3]))
    np.testing.assert_array_equal(moved[:3], [[-1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [7.0, 7.0, 7.0]])
    np.testing.assert_array_equal(centred(atoms, np.array([3])), atoms)


def test_width_and_look_at_are_obeyed():
    atoms = grid_with_two_balls(8)
    camera = fit(View(look_at=(1.0, 2.0, 3.0), width=12.5), [atoms], SIZE)
    assert (camera.centre, camera.width) == ((1.0, 2.0, 3.0), 12.5)
    assert fit(View(width=12.5), [atoms], SIZE).width == 12.5
    around = fit(View(look_at=(1.0, 2.0, 3.0)), [atoms], SIZE)
    assert around.centre == (1.0, 2.0, 3.0)
    assert max(reach(around, atoms)) == pytest.approx(1 / MARGIN, rel=1e-3)


def test_a_string_seen_from_its_end_stays_before_the_eye():
    string = np.stack([np.arange(200.0), np.zeros(200), np.zeros(200)], axis=1)
    camera = fit(View(0, 0), [string], SIZE)
    assert (camera.see(string)[2] * camera.convergence < 0.75).all()


def test_only_places_that_can_be_drawn_count():
    atoms = np.array([[0.0, 0, 0], [np.nan, 0, 0], [0, np.inf, 0], [0, 0, -2e9], [3, 0, 0]])
    assert is_drawable(atoms).tolist() == [True, False, False, False, True]
    assert fit(View(), [atoms], SIZE) == fit(View(), [atoms[[0, 4]]], SIZE)


@pytest.mark.parametrize("atoms", [np.empty((0, 3)), np.full((4, 3), np.nan), np.eye(3) * 1e9, np.full((2, 3), 1e308)])
def test_hopeless_positions_still_give_a_camera(atoms):
    camera = fit(View(), [atoms], SIZE)
    assert np.isfinite([*camera.centre, camera.width, camera.convergence]).all()
