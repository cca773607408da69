"""What of the chosen rounds a row of pictures has to show; knows no pixels and no light."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats
from atomsim.drawing.camera import EYE_DISTANCE, FARTHEST, Camera, View, is_before_eye, outline

MARGIN = 1.06
"""The picture is wider than what it shows by this factor."""

_FITTING_STEPS = 12
"""Where balls appear depends, through the perspective, on middle and width; each step is ten times nearer to both."""


def is_drawable(position: Floats) -> NDArray[np.bool_]:
    """Tell which atoms have a place that can be drawn: finite and within `FARTHEST`, (n_atoms,) bool."""
    return np.asarray((np.abs(position) <= FARTHEST).all(axis=1))


def fit(view: View, shown: Sequence[Floats], size: tuple[int, int], start: Floats | None = None) -> Camera:
    """Return the camera that frames all pictures of a row.

    What the view leaves open is chosen so that the whole balls of all atoms that matter fit. An atom matters unless
    it has *left*: it is farther outside the box of the scene at its start than half the longest side of that box.
    It fell off or flew away, and showing it would turn the rest into dots. If most atoms have left, the scene as a
    whole has moved or spread: then the box of the middle eight tenths of the atoms shown takes the place of the start.

    Args:
        view: what is asked for.
        shown: positions in the rounds of the row [length], each (n_atoms, 3) float64.
        size: width and height of a picture [pixels]; only their ratio matters.
        start: positions at the start of the trajectory [length]; by default the first of `shown`.
    """
    origin = Camera.of(view, view.look_at or (0.0, 0.0, 0.0), 1.0)
    seen = origin.see(_atoms_that_matter(shown, shown[0] if start is None else start))
    low, high = seen.min(axis=1), seen.max(axis=1)
    middle = np.zeros(3) if view.look_at else (low + high) / 2
    nearest_width = 2 * float((seen[2] - middle[2]).max()) / EYE_DISTANCE
    width = view.width or max(float((high - low).max()), 2.0)
    for _ in range(_FITTING_STEPS):
        bottom_left, top_right = _extent(
            seen - middle[:, np.newaxis], Camera.of(view, origin.centre, width).convergence
        )
        if not view.look_at:
            shift = (bottom_left + top_right) / 2
            middle[:2] += shift
            bottom_left, top_right = bottom_left - shift, top_right - shift
        if not view.width:
            half_width, half_height = np.maximum(top_right, -bottom_left).tolist()
            width = max(2 * MARGIN * max(half_width, half_height * size[0] / size[1]), nearest_width)
    return Camera.of(view, origin.place((float(middle[0]), float(middle[1]), float(middle[2]))), width)


def _extent(seen: Floats, convergence: float) -> tuple[Floats, Floats]:
    """Return the bottom left and the top right corner of all that the balls cover, each (2,) float64."""
    before = seen[:, is_before_eye(seen, convergence)]
    if not before.size:
        return -np.ones(2), np.ones(2)
    left, right, bottom, top = outline(before, convergence)
    return np.array([left.min(), bottom.min()]), np.array([right.max(), top.max()])


def _atoms_that_matter(shown: Sequence[Floats], start: Floats) -> Floats:
    """Return the positions to frame, of all rounds together, (n, 3) float64; at least one."""
    atoms = np.concatenate([position[is_drawable(position)] for position in shown])
    if not len(atoms):
        return np.zeros((1, 3))
    begun = start[is_drawable(start)]
    near = _is_near(atoms, begun.min(axis=0), begun.max(axis=0)) if len(begun) else np.zeros(len(atoms), dtype=bool)
    if 2 * int(near.sum()) < len(atoms):
        tenth = len(atoms) // 10
        in_order = np.sort(atoms, axis=0)
        near = _is_near(atoms, in_order[tenth], in_order[-1 - tenth])
    return atoms[near]


def _is_near(atoms: Floats, low: Floats, high: Floats) -> NDArray[np.bool_]:
    """Tell which atoms are in the box of balls from `low` to `high` or outside it by at most half its longest side."""
    reach = (float((high - low).max()) + 2.0) / 2 + 1.0
    return np.asarray(((atoms >= low - reach) & (atoms <= high + reach)).all(axis=1))
