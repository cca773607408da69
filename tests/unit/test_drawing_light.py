"""Light and shadow on points of unit balls."""

import numpy as np
import pytest

from atomsim.drawing.light import LAMP_TOWARDS, Beam, beams_on, from_viewer, highlight_towards, shine

UP = (0.0, 1.0, 0.0)
DOWN_BEAM = (0.0, 1.0, 0.0)


def beam_on(seen, towards=DOWN_BEAM):
    return Beam.of(towards, 1.0, seen, np.arange(seen.shape[1]))


def sphere_normals(n=2000):
    normal = np.random.default_rng(7).normal(size=(3, n))
    return normal / np.sqrt((normal * normal).sum(axis=0))


def test_a_lone_ball_has_lamberts_light_and_no_shadow_on_itself():
    seen, normal = np.array([[3.0], [-2.0], [5.0]]), sphere_normals()
    light = beam_on(seen).on(seen + normal, normal)
    np.testing.assert_array_equal(light, np.maximum(normal[1], 0.0))


def test_balls_in_a_row_across_the_light_do_not_speckle_each_other():
    seen = np.stack([np.arange(40) * 0.35, np.zeros(40), np.zeros(40)])
    normal = np.tile(np.array([[0.0], [1.0], [0.0]]), 40)
    assert (beam_on(seen).on(seen + normal, normal) == 1.0).all()


def test_a_ball_shades_what_lies_below_it():
    seen = np.array([[0.0, 0.0, 2.5], [0.0, 6.0, 0.0], [0.0, 0.0, 0.0]])
    top = np.array([[0.0], [1.0], [0.0]]) * np.ones(3)
    assert beam_on(seen).on(seen + top, top).tolist() == [0.0, 1.0, 1.0]


def test_the_shadow_is_a_disc_as_wide_as_the_ball():
    # The lower balls make a floor of points; the upper one at the origin shades those within 1 of the axis.
    across = np.linspace(-2, 2, 401)
    floor = np.stack([across, np.full(401, -50.0), np.zeros(401)])
    seen = np.concatenate([np.zeros((3, 1)), floor], axis=1)
    normal = np.tile(np.array([[0.0], [1.0], [0.0]]), 401)
    light = Beam.of(DOWN_BEAM, 1.0, seen, np.arange(402)).on(floor + normal, normal)
    np.testing.assert_array_equal(light[abs(across) < 0.95], 0.0)
    np.testing.assert_array_equal(light[abs(across) > 1.05], 1.0)


def test_many_balls_get_a_coarser_map():
    seen = np.random.default_rng(8).uniform(0, 30, size=(3, 50_000))
    lit = np.arange(50_000)
    assert (
        Beam.of(DOWN_BEAM, 1.0, seen, lit).grid.pixel > 2 * Beam.of(DOWN_BEAM, 1.0, seen[:, :90], lit[:90]).grid.pixel
    )


@pytest.mark.parametrize("vertical", [UP, (0.0, 0.8, 0.6), (0.0, 0.0, 1.0), (0.0, 0.6, -0.8)])
def test_light_comes_from_above_and_from_the_left(vertical):
    total = np.sum(
        [np.array(beam.back) * beam.strength for beam in beams_on(np.zeros((3, 1)), np.array([0]), vertical)], 0
    )
    assert np.dot(total, vertical) > 0.7
    assert total[0] < -0.3


def test_no_light_is_lost_or_made_by_the_number_of_beams():
    beams = beams_on(np.zeros((3, 1)), np.array([0]), UP)
    assert sum(beam.strength for beam in beams) == pytest.approx(1.5)
    for beam in beams:
        assert np.dot(beam.back, beam.back) == pytest.approx(1.0)


def test_the_highlight_lies_between_lamp_and_viewer():
    towards = highlight_towards(UP)
    lamp = np.array(from_viewer(LAMP_TOWARDS, UP)) / np.sqrt(np.dot(LAMP_TOWARDS, LAMP_TOWARDS))
    assert np.dot(towards, lamp) == pytest.approx(towards[2])
    assert shine(np.array(towards).reshape(3, 1), towards) == pytest.approx([1.0])
    assert shine(-np.array(towards).reshape(3, 1), towards) == [0.0]
