"""What of the chosen rounds a row of pictures has to show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats
from atomsim.drawing.camera import EYE_DISTANCE, FARTHEST, Camera, View, is_before_eye, outline
from atomsim.drawing.hull import hull

MARGIN = 1.06
"""The picture is wider than what it shows by this factor."""

_FITTING_STEPS = 12
"""Where balls appear depends, through the perspective, on middle and width; each step is ten times nearer to both."""

_SAMPLE = 1 << 21
"""Atoms, of all rounds together, that are looked at to say where most of them are."""


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
        shown: positions in the rounds of the row [length], each (n_atoms, 3) float64; taken one at a time, so that
            they need not be in memory together.
        size: width and height of a picture [pixels]; only their ratio matters.
        start: positions at the start of the trajectory [length]; by default the first of `shown`.
    """
    origin = Camera.of(view, view.look_at or (0.0, 0.0, 0.0), 1.0)
    seen = _outermost(origin, shown, shown[0] if start is None else start)
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


@dataclass(frozen=True, slots=True, eq=False)
class _Box:
    """A box of balls with the space around it that is half as wide as its longest side."""

    low: Floats
    high: Floats

    @classmethod
    def of(cls, low: Floats, high: Floats) -> _Box:
        """Return the box around balls whose centres lie between two corners, each (3,) float64."""
        reach = (float((high - low).max()) + 2.0) / 2 + 1.0
        return cls(low - reach, high + reach)

    def near(self, atoms: Floats) -> Floats:
        """Return those of some atoms that are in the box, (n, 3) float64."""
        return atoms[((atoms >= self.low) & (atoms <= self.high)).all(axis=1)]


def _outermost(camera: Camera, shown: Sequence[Floats], start: Floats) -> Floats:
    """Return the atoms to frame, of all rounds together, in camera coordinates: (3, n) float64; at least one.

    All but those on the hull, seen from above and from the side, go at once: however the camera turns its rays
    together, no other atom can reach farther to a side.
    """
    begun = start[is_drawable(start)]
    if len(begun):
        n_shown, n_near, seen = _hull_of_near(camera, shown, _Box.of(begun.min(axis=0), begun.max(axis=0)))
        if 2 * n_near >= n_shown > 0:
            return seen
    places = _sample(shown)
    if not len(places):
        return camera.see(np.zeros((1, 3)))
    tenth = len(places) // 10
    in_order = np.sort(places, axis=0)
    return _hull_of_near(camera, shown, _Box.of(in_order[tenth], in_order[-1 - tenth]))[2]


def _hull_of_near(camera: Camera, shown: Sequence[Floats], box: _Box) -> tuple[int, int, Floats]:
    """Return how many atoms are shown, how many of them are in a box, and of those the outermost."""
    n_shown = n_near = 0
    outermost = np.empty((3, 0))
    for position in shown:
        atoms = position[is_drawable(position)]
        near = box.near(atoms)
        n_shown, n_near = n_shown + len(atoms), n_near + len(near)
        seen = np.concatenate((outermost, camera.see(near)), axis=1)
        outermost = seen[:, np.union1d(hull(seen[0], seen[2]), hull(seen[1], seen[2]))]
    return n_shown, n_near, outermost


def _sample(shown: Sequence[Floats]) -> Floats:
    """Return the drawable atoms of as many rounds, evenly spread, as are not too many together, (n, 3) float64."""
    step = -(-len(shown) * len(shown[0]) // _SAMPLE) or 1
    taken = (shown[index] for index in range(0, len(shown), step))
    return np.concatenate([position[is_drawable(position)] for position in taken])
