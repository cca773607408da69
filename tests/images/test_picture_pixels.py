"""The pixels of one picture: sizes, places, colours and the very bytes."""

import colorsys
import sys
import textwrap

import numpy as np
import pytest
from numpy._core._multiarray_umath import __cpu_dispatch__
from support.process import finish

from atomsim.drawing.camera import Camera, View
from atomsim.drawing.picture import draw

STEELBLUE, FIREBRICK = (70 / 255, 130 / 255, 180 / 255), (178 / 255, 34 / 255, 34 / 255)
GRAY = (245 / 255, 245 / 255, 247 / 255)
FRONT = View(0.0, 0.0)


def picture(position, color=STEELBLUE, width=10.0, size=(200, 150), view=FRONT, background=GRAY):
    atoms = np.array(position, dtype=float).reshape(-1, 3)
    colors = np.broadcast_to(np.array(color, dtype=float), atoms.shape)
    return draw(atoms, colors, Camera.of(view, (0.0, 0.0, 0.0), width), size, background)


def is_ball(pixels):
    return (pixels != np.array([245, 245, 247])).any(axis=2)


def test_a_ball_is_a_disc_of_the_right_size_in_the_right_place():
    disc = is_ball(picture([0.0, 2.0, -1.0]))
    row, column = np.nonzero(disc)
    # The eye is 50 away, so the sphere appears as wide as a disc of radius 50/√(50² − 1) at its centre, 20 pixels each.
    radius = 20 * 50 / np.sqrt(50**2 - 1)
    assert (row.min() + row.max() + 1) / 2 == pytest.approx(75 + 20, abs=0.5)
    assert (column.min() + column.max() + 1) / 2 == pytest.approx(100 + 40, abs=0.5)
    assert disc.sum() == pytest.approx(np.pi * (radius + 0.35) ** 2, rel=0.02)


def test_what_is_nearer_is_larger():
    areas = [is_ball(picture([x, 0.0, 0.0])).sum() for x in (-20.0, 0.0, 20.0)]
    assert areas[0] < areas[1] < areas[2]
    assert areas[2] / areas[1] == pytest.approx((50 / 30) ** 2, rel=0.05)


def test_the_outline_is_symmetric():
    disc = is_ball(picture([[0.0, 0.0, 0.0], [0.0, 1.2, 0.0], [0.0, -1.2, 0.0]]))
    assert (disc == disc[::-1]).all()
    assert (disc == disc[:, ::-1]).all()


def test_the_nearer_ball_hides_the_farther_whatever_their_order():
    atoms, colors = np.array([[3.0, 0, 0], [-3.0, 0, 0]]), np.array([FIREBRICK, STEELBLUE])
    camera = Camera.of(FRONT, (0.0, 0.0, 0.0), 10.0)
    one = draw(atoms, colors, camera, (200, 150), GRAY)
    other = draw(atoms[::-1], colors[::-1], camera, (200, 150), GRAY)
    assert (one == other).all()
    red, _, blue = one[75, 100].astype(int)
    assert red > blue


@pytest.mark.parametrize("level", range(0, 256, 5))
def test_the_background_is_exact(level):
    pixels = picture(np.empty((0, 3)), size=(16, 16), background=(level / 255, 0.0, 1.0))
    assert (pixels == np.array([level, 0, 255])).all()


@pytest.mark.parametrize("color", [STEELBLUE, FIREBRICK, (1.0, 140 / 255, 0.0), (46 / 255, 139 / 255, 87 / 255)])
def test_colors_look_like_themselves(color):
    pixels = picture([0.0, 0.0, 0.0], color, width=3.0, view=View(0.0, 20.0)) / 255
    hue, _, saturation = colorsys.rgb_to_hls(*color)
    shades = pixels[60:90, 85:115].reshape(-1, 3)
    for shade in shades[::37]:
        hue_seen, _, saturation_seen = colorsys.rgb_to_hls(*shade)
        assert hue_seen == pytest.approx(hue, abs=0.02)
        assert saturation_seen > 0.7 * saturation
    assert abs(shades.mean(axis=0) - color).max() < 0.13


def test_without_a_background_only_balls_are_opaque_and_their_edges_have_no_fringe():
    pixels = picture([[0.0, 0.0, 0.0], [0.5, 1.5, 0.0]], FIREBRICK, background=None)
    assert pixels.shape == (150, 200, 4)
    color, opacity = pixels[:, :, :3].astype(int), pixels[:, :, 3]
    on_gray = picture([[0.0, 0.0, 0.0], [0.5, 1.5, 0.0]], FIREBRICK).astype(int)
    assert ((opacity > 0) == is_ball(on_gray)).all()
    assert set(np.unique(opacity)) == {0, 64, 128, 191, 255}  # four samples a pixel
    assert (color[opacity == 255] == on_gray[opacity == 255]).all()
    edge = color[(opacity > 0) & (opacity < 255)]
    assert (edge[:, 0] > 2 * edge[:, 2]).all()  # as red as the balls, whatever lies behind


def test_rays_may_be_parallel():
    view = View(0.0, 0.0, field_of_view=0.0)
    areas = {is_ball(picture([x, 0.0, 0.0], view=view)).sum() for x in (-200.0, 0.0, 2000.0)}
    assert len(areas) == 1


def test_a_wide_angle_shows_what_is_near_much_larger():
    areas = [is_ball(picture([x, 0.0, 0.0], view=View(0.0, 0.0, field_of_view=90.0))).sum() for x in (-2.0, 2.0)]
    assert areas[1] / areas[0] == pytest.approx((7 / 3) ** 2, rel=0.15)  # the eye is 5 before the middle


def test_the_lamp_hangs_on_the_left():
    pixels = picture([0.0, 0.0, 0.0], width=3.0).astype(int).sum(axis=2)
    assert pixels[75, 60] > pixels[75, 140]
    assert pixels[45, 100] > pixels[105, 100]


def test_a_ball_above_a_surface_throws_a_shadow_that_softens_with_height():
    column, row = np.meshgrid(np.arange(-12.0, 13.0), np.arange(-12.0, 13.0))
    surface = np.stack([column.ravel(), row.ravel(), np.zeros(625)], axis=1)
    view = View(0.0, 60.0)
    plain = picture(surface, view=view, width=30.0).astype(int)

    def darkest(height):
        ball = np.array([[0.0, -4.0, height]])
        with_ball = picture(np.concatenate([surface, ball]), view=view, width=30.0).astype(int)
        is_surface = (is_ball(plain)) & ~(is_ball(picture(ball, view=view, width=30.0)))
        return (plain - with_ball)[is_surface].sum(axis=1).max()

    assert darkest(2.5) > darkest(9.0) > 20


def test_a_speck_far_away_takes_no_shadow_from_the_others():
    stack = np.array([[0.0, 0.0, 2.2], [0.2, 0.3, 0.0], [0.5, 1.5, 0.0], [1.0, 3.0, -1.0]])
    above = View(0.0, 90.0)
    plain, with_speck = picture(stack, view=above), picture([*stack, [30.0, 30.0, -600.0]], view=above)
    assert (plain != with_speck).any()
    np.testing.assert_array_equal(with_speck[is_ball(plain)], plain[is_ball(plain)])


def test_atoms_without_a_place_are_left_out():
    good = [[0.0, 0.0, 0.0], [0.0, 1.0, 1.0]]
    bad = [[np.nan, 0.0, 0.0], *good, [0.0, np.inf, 0.0], [0.0, 0.0, -1e300]]
    assert (picture(bad) == picture(good)).all()


def test_a_camera_inside_a_crowd_draws_what_is_before_it():
    atoms = np.random.default_rng(9).uniform(-40, 40, size=(500, 3))
    assert is_ball(picture(atoms, width=2.0)).any()


def test_bands_leave_no_seam(monkeypatch):
    atoms = np.random.default_rng(10).uniform(-4, 4, size=(60, 3))
    whole = picture(atoms)
    monkeypatch.setattr("atomsim.drawing.picture._BAND", 4000)
    assert (picture(atoms) == whole).all()


DIGEST = textwrap.dedent(
    """
    import hashlib
    import numpy as np
    from atomsim.drawing.camera import View
    from atomsim.drawing.framing import fit
    from atomsim.drawing.picture import draw

    place = np.arange(300.0)
    position = np.stack([place % 17 - 8, (place * place) % 13 - 6, (place * 7) % 11 - 5], axis=1)
    color = np.stack([place % 5 / 4, place % 7 / 6, place % 3 / 2], axis=1)
    camera = fit(View(25.0, 35.0, "y"), [position], (160, 120))
    print(hashlib.sha256(draw(position, color, camera, (160, 120)).tobytes()).hexdigest())
    """
)

# Regenerate on purpose only, after looking at pictures of all shipped scenes: print what DIGEST prints.
GOLDEN = "86422a680f94dd6a9a58e5ab333c201c387d879d73e2ab012383f3b5c8af6342"


@pytest.mark.parametrize(
    "environment",
    [
        {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2"},
        {"NPY_DISABLE_CPU_FEATURES": " ".join(__cpu_dispatch__)},
    ],
)
def test_the_bytes_are_the_same_for_any_threads_and_any_processor(environment):
    run = finish(program=(sys.executable, "-W", "ignore", "-c", DIGEST), **environment)
    assert (run.stdout.strip(), run.stderr) == (GOLDEN, "")
