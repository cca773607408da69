"""Turning, tilt, deformation and winding of bodies that were turned by known angles, and against NumPy's own SVD."""

from __future__ import annotations

import numpy as np
import pytest

from atomsim.core.gauges.block import Block
from atomsim.core.gauges.eigen import eigen
from atomsim.core.gauges.rigid import Body, Deformation, Tilt, Turning, angle_between, rotate
from atomsim.core.gauges.strings import Winding
from atomsim.core.model import Floats

RING = np.array([[4 * np.cos(a), 4 * np.sin(a), 0.0] for a in 2 * np.pi * np.arange(20) / 20])
ROD = np.outer(np.linspace(-5, 5, 11), [1.0, 0.0, 0.0])
CART = np.array([[x, y, z] for x in range(6) for y in range(4) for z in range(2)], dtype=float)
CUBE = np.array([[x, y, z] for x in range(3) for y in range(3) for z in range(3)], dtype=float)
X, Y, Z = np.eye(3)


def turned(shape: Floats, axis: Floats, degrees: Floats) -> Floats:
    """Return frames of a shape turned about an axis by Rodrigues' formula, and moved away, (n_frames, n, 3)."""
    axis = axis / np.linalg.norm(axis)
    frames = []
    for angle in np.radians(degrees):
        along = np.outer(shape @ axis, axis)
        frames.append(along + np.cos(angle) * (shape - along) + np.sin(angle) * np.cross(axis, shape) + [3, -1, 7])
    return np.array(frames)


def block_of(frames: Floats) -> Block:
    position = np.ascontiguousarray(frames.transpose(2, 1, 0))
    return Block(position, np.zeros_like(position), {})


def turning(shape: Floats, frames: Floats) -> Floats:
    """Return the turning of frames, (n_frames, 3)."""
    gauge = Turning(Body.of(slice(0, len(shape)), shape))
    return gauge.measure(block_of(frames), gauge.begin()).T


def tilt(shape: Floats, frames: Floats, up: int = 2) -> Floats:
    return Tilt(Body.of(slice(0, len(shape)), shape), up).measure(block_of(frames), np.empty(0))[0]


@pytest.mark.parametrize("axis", [X, Y, Z, np.array([1.0, -2.0, 0.5])])
@pytest.mark.parametrize("shape", [RING, CART, CUBE], ids=["ring", "cart", "cube"])
def test_whole_turns_are_counted(shape: Floats, axis: Floats) -> None:
    degrees = np.linspace(0, -1000, 30)
    expected = degrees[:, None] * axis / np.linalg.norm(axis)
    assert turning(shape, turned(shape, axis, degrees)) == pytest.approx(expected, abs=1e-9)


def test_a_rod_turns_across_itself_and_never_about_itself() -> None:
    degrees = np.linspace(0, 720, 30)
    assert turning(ROD, turned(ROD, Z, degrees))[-1] == pytest.approx([0, 0, 720], abs=1e-9)
    assert turning(ROD, turned(ROD, X, degrees)) == pytest.approx(np.zeros((30, 3)), abs=1e-9)


def test_a_rod_that_is_turned_round_within_one_frame_turns_half_a_turn() -> None:
    vector = turning(ROD, np.array([ROD, -ROD]))[1]
    assert np.linalg.norm(vector) == pytest.approx(180)
    assert vector @ X == pytest.approx(0)


def test_a_body_that_only_flexes_does_not_turn() -> None:
    squeezed = np.array([RING * [1 + s, 1 - s, 1] for s in (0, 0.1, 0.3, 0)])
    assert turning(RING, squeezed) == pytest.approx(np.zeros((4, 3)), abs=1e-9)
    assert Deformation(Body.of(slice(0, 20), RING)).measure(block_of(squeezed), np.empty(0))[0] == pytest.approx(
        [0, 0.4, 1.2, 0], abs=1e-9
    )


def test_a_mirror_image_is_no_rotation() -> None:
    gauge = Deformation(Body.of(slice(0, len(CART)), CART))
    assert gauge.measure(block_of((CART * [1, 1, -1])[None]), np.empty(0))[0, 0] > 0.1


@pytest.mark.parametrize(
    ("shape", "axis", "leans"),
    [
        (RING, X, True),  # lies, and gets up
        (RING, Z, False),  # lies, and spins
        (RING @ np.array([X, Z, Y]), Y, False),  # stands, and rolls
        (RING @ np.array([X, Z, Y]), X, True),  # stands, and falls over
        (RING @ np.array([X, Z, Y]), Z, False),  # stands, and turns about the vertical
        (ROD @ np.array([Z, Y, X]), X, True),  # stands, and falls over
        (ROD, X, False),  # lies, and rolls
        (CART, X, True),  # falls on its side
        (CART, Z, False),  # drives round a bend
        (CUBE, Y, True),
    ],
)
def test_tilt_is_leaning_and_neither_rolling_nor_turning(shape: Floats, axis: Floats, leans: bool) -> None:
    degrees = np.array([0.0, 20, 45, 60, 90])
    assert tilt(shape, turned(shape, axis, degrees)) == pytest.approx(degrees if leans else 0 * degrees, abs=1e-9)


def test_tilt_of_what_lands_on_its_head() -> None:
    assert tilt(CART, turned(CART, X, np.array([0.0, 180.0])))[1] == pytest.approx(180)
    assert tilt(RING, turned(RING, X, np.array([0.0, 180.0])))[1] == pytest.approx(180)


def test_the_axis_of_height_may_be_another() -> None:
    assert tilt(CART, turned(CART, Z, np.array([30.0])), up=1)[0] == pytest.approx(30)


def test_the_rotation_is_the_one_of_kabsch() -> None:
    """Kabsch, Acta Cryst. A 32 (1976) 922: with H = Σ a cᵀ = U S Vᵀ, R = V diag(1, 1, ±1) Uᵀ."""
    random = np.random.default_rng(5)
    shape = random.normal(size=(9, 3))
    frames = shape + random.normal(size=(40, 9, 3)) * 0.7
    body = Body.of(slice(0, 9), shape)
    ours = body.rotation(block_of(frames))
    for number, frame in enumerate(frames):
        u, _, vt = np.linalg.svd((shape - shape.mean(axis=0)).T @ (frame - frame.mean(axis=0)))
        sign = np.sign(np.linalg.det(u @ vt))
        expected = vt.T @ np.diag([1, 1, sign]) @ u.T
        columns = [rotate(ours[:, [number]], axis[:, None])[:, 0] for axis in np.eye(3)]
        assert pytest.approx(expected, abs=1e-9) == np.array(columns).T


def test_known_answers_of_others() -> None:
    """The least distances of two sets of four points, and of mirror images, which programs have got wrong.

    The first is 0.695, and 0.52 only if mirror images are taken for rotations.
    """
    shape = np.array([[-1.0, 0, 0], [0, 2, 0], [0, 1, 0], [0, 1, 1]])
    other = np.array([[0.0, -1, -1], [0, -1, 0], [0, 0, 0], [-1, 0, 0]])
    fit = Deformation(Body.of(slice(0, 4), shape)).measure(block_of(other[None]), np.empty(0))[0, 0]
    assert fit == pytest.approx(0.695, abs=5e-4)


def test_a_line_turned_askew_is_found_again() -> None:
    """Three points on a line, turned by 0.9 about (1, 2, 3): a fit by eigenvectors alone may stay where it was."""
    line = np.outer([0.0, 1, 2], X)
    frames = turned(line, np.array([1.0, 2, 3]), np.degrees([0.0, 0.9]))
    assert Deformation(Body.of(slice(0, 3), line)).measure(block_of(frames), np.empty(0))[0] == pytest.approx(
        0, abs=1e-9
    )


def test_jitter_across_a_rod_does_not_make_it_turn_about_itself() -> None:
    random = np.random.default_rng(3)
    rod = ROD + 1e-3 * random.normal(size=ROD.shape)
    frames = turned(rod, Z, np.linspace(0, 360, 20))
    frames += 1e-2 * random.normal(size=frames.shape)
    assert np.abs(turning(rod, frames)[:, :2]).max() < 1
    assert turning(rod, frames)[-1, 2] == pytest.approx(360, abs=1)


def test_a_body_shrunk_to_a_point_does_not_turn() -> None:
    assert turning(CART, np.zeros((2, len(CART), 3))).tolist() == [[0, 0, 0], [0, 0, 0]]
    assert turning(ROD, np.zeros((2, len(ROD), 3))).tolist() == [[0, 0, 0], [0, 0, 0]]


def test_eigenvalues_and_vectors_are_those_of_lapack() -> None:
    matrices = np.random.default_rng(1).normal(size=(4, 4, 30))
    matrices = matrices + matrices.transpose(1, 0, 2)
    matrices[:, :, 0] = 0
    matrices[:, :, 1] = np.diag([2.0, 2.0, -1.0, 2.0])
    values, vectors = eigen(matrices)
    assert pytest.approx(np.linalg.eigvalsh(matrices.transpose(2, 0, 1)), abs=1e-12) == values[::-1].T
    for matrix, value, vector in zip(matrices.T, values.T, vectors.transpose(2, 0, 1), strict=True):
        assert matrix @ vector == pytest.approx(vector * value, abs=1e-12)
        assert vector.T @ vector == pytest.approx(np.eye(4), abs=1e-12)


def test_angles_are_accurate_where_a_cosine_is_not() -> None:
    tiny = np.array([[1.0], [1e-9], [0.0]])
    assert angle_between(tiny, X[:, None])[0] == pytest.approx(np.degrees(1e-9), rel=1e-9)


@pytest.mark.parametrize("turns", [0.4, 1.0, 3.25])
def test_a_helix_winds_about_the_axis_of_a_rod(turns: float) -> None:
    angle = np.linspace(0, 2 * np.pi * turns, 60)
    helix = np.column_stack([np.linspace(-4, 4, 60), 2 * np.cos(angle), 2 * np.sin(angle)])
    frames = turned(np.concatenate([ROD, helix]), np.array([1.0, 1.0, 1.0]), np.array([0.0, 77.0]))
    gauge = Winding(slice(11, 71), slice(0, 11))
    assert gauge.measure(block_of(frames), np.empty(0))[0] == pytest.approx([360 * turns] * 2, abs=1e-6)


def test_a_straight_string_winds_by_less_than_half_a_turn() -> None:
    string = np.column_stack([np.zeros(50), np.full(50, 0.01), np.linspace(-50, 50, 50)])
    gauge = Winding(slice(11, 61), slice(0, 11))
    assert 179 < gauge.measure(block_of(np.concatenate([ROD, string])[None]), np.empty(0))[0, 0] <= 180
