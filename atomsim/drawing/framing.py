"""What of the chosen rounds a row of pictures has to show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats, Indices
from atomsim.drawing.camera import CLOSEST_WIDE_EYE, FARTHEST, Camera, View, is_before_eye, outline
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


def centred(position: Floats, atoms: Indices) -> Floats:
    """Return positions moved so that the centroid of some atoms is at the origin, (n_atoms, 3) float64.

    Atoms that cannot be drawn do not count; if none can, nothing is moved.
    """
    middle = position[atoms]
    middle = middle[is_drawable(middle)]
    return position - middle.mean(axis=0) if len(middle) else position


def fit(
    view: View,
    shown: Sequence[Floats],
    size: tuple[int, int],
    start: Floats | None = None,
    scenery: NDArray[np.bool_] | None = None,
) -> Camera:
    """Return the camera that frames all pictures of a row.

    What the view leaves open is chosen so that the whole balls of all atoms that matter fit. An atom matters unless
    it has *left*: it is farther outside the box of the scene at its start than the longest side of that box.
    It fell off or flew away, and showing it would turn the rest into dots. If most atoms have left, the scene as a
    whole has moved or spread: then the box of the middle eight tenths of the atoms shown takes the place of the start.
    Nor does scenery matter, as long as that is not the case.

    Args:
        view: what is asked for.
        shown: positions in the rounds of the row [length], each (n_atoms, 3) float64; taken one at a time, so that
            they need not be in memory together.
        size: width and height of a picture [pixels]; only their ratio matters.
        start: positions at the start of the trajectory [length]; by default the first of `shown`.
        scenery: atoms that need not be seen, (n_atoms,) bool; by default none.
    """
    origin = Camera.of(view, view.look_at or (0.0, 0.0, 0.0), 1.0)
    seen = _outermost(origin, shown, shown[0] if start is None else start, scenery)
    low, high = seen.min(axis=1), seen.max(axis=1)
    middle = np.zeros(3) if view.look_at else (low + high) / 2
    if view.field_of_view and not view.width:
        return _fit_angle(view, seen, middle, origin, size)
    nearest_width = 2 * float((seen[2] - middle[2]).max()) / view.eye_distance
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


def _fit_angle(view: View, seen: Floats, middle: Floats, origin: Camera, size: tuple[int, int]) -> Camera:
    """Return the camera whose eye is as near as balls allow that have to be in its field of view.

    A unit ball at (x, z) is to the left of the plane through the eye at height d, with slope t, if x is at most
    t·(d − z) − √(1 + t²); so each ball asks for some d, and what asks for most decides.
    """
    slope = 0.5 / view.eye_distance / MARGIN
    distance = float(seen[2].max()) + CLOSEST_WIDE_EYE / 2
    for axis, t in ((0, slope), (1, slope * size[1] / size[0])):
        right, left = (float((side * seen[axis] / t + seen[2]).max()) for side in (1.0, -1.0))
        if not view.look_at:
            middle[axis] = (right - left) * t / 2
        distance = max(distance, right - middle[axis] / t + _spare(t), left + middle[axis] / t + _spare(t))
    width = max(distance - middle[2], CLOSEST_WIDE_EYE) / view.eye_distance
    return Camera.of(view, origin.place((float(middle[0]), float(middle[1]), float(middle[2]))), width)


def _spare(slope: float) -> float:
    """Return how far before the centre of a ball an eye has to be on its rim, between planes of a slope."""
    return math.sqrt(1.0 + slope * slope) / slope


def _extent(seen: Floats, convergence: float) -> tuple[Floats, Floats]:
    """Return the bottom left and the top right corner of all that the balls cover, each (2,) float64."""
    before = seen[:, is_before_eye(seen, convergence)]
    if not before.size:
        return -np.ones(2), np.ones(2)
    left, right, bottom, top = outline(before, convergence)
    return np.array([left.min(), bottom.min()]), np.array([right.max(), top.max()])


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """A box of balls with as much space around it as its longest side."""

    low: Floats
    high: Floats

    @classmethod
    def of(cls, low: Floats, high: Floats) -> Box:
        """Return the box around balls whose centres lie between two corners, each (3,) float64."""
        reach = float((high - low).max()) + 3.0  # from the centres; the balls have a radius of 1
        return cls(low - reach, high + reach)

    @classmethod
    def around(cls, position: Floats) -> Box:
        """Return the box around those of some atoms that can be drawn; without any, one around the origin."""
        atoms = position[is_drawable(position)]
        return cls.of(atoms.min(axis=0), atoms.max(axis=0)) if len(atoms) else cls.of(np.zeros(3), np.zeros(3))

    def holds(self, position: Floats) -> NDArray[np.bool_]:
        """Tell which atoms are in the box, (n,) bool."""
        return np.asarray(((position >= self.low) & (position <= self.high)).all(axis=1))

    def clip(self, position: Floats) -> Floats:
        """Return atoms with those that are outside moved to its sides, (n, 3) float64; NaN becomes the middle."""
        middle = (self.low + self.high) / 2
        return np.clip(np.where(np.isnan(position), middle, position), self.low, self.high)


def is_scenery(low: Floats, high: Floats) -> NDArray[np.bool_]:
    """Tell which atoms stay where they are, far from all that moves, (n_atoms,) bool.

    Args:
        low, high: the least and greatest coordinates of every atom in a run [length], (n_atoms, 3) float64.
    """
    moves: NDArray[np.bool_] = (high - low).max(axis=1) > 1.0
    if not moves.any():
        return moves
    box = Box.of(low[moves].min(axis=0), high[moves].max(axis=0))
    return np.asarray(~(box.holds(low) | moves))


def _outermost(camera: Camera, shown: Sequence[Floats], start: Floats, scenery: NDArray[np.bool_] | None) -> Floats:
    """Return the atoms to frame, of all rounds together, in camera coordinates: (3, n) float64; at least one."""
    n_shown, n_near, seen = _hull_in(Box.around(start), camera, shown, scenery)
    if 2 * n_near >= n_shown > 0 and seen.size:
        return seen
    places = _sample(shown)
    if not len(places):
        return camera.see(np.zeros((1, 3)))
    tenth = len(places) // 10
    in_order = np.sort(places, axis=0)
    return _hull_in(Box.of(in_order[tenth], in_order[-1 - tenth]), camera, shown, None)[2]


def _hull_in(
    box: Box, camera: Camera, shown: Sequence[Floats], scenery: NDArray[np.bool_] | None
) -> tuple[int, int, Floats]:
    """Return how many atoms are shown in all rounds, how many of them in a box, and the outermost of these.

    The outermost are those on the hull, seen from above and from the side: however the rays of sight converge, no
    other atom reaches farther. All others, and the scenery, go at once.
    """
    n_shown = n_near = 0
    outermost = np.empty((3, 0))
    for position in shown:
        is_shown = is_drawable(position)
        is_near = is_shown & box.holds(position)
        n_shown, n_near = n_shown + int(is_shown.sum()), n_near + int(is_near.sum())
        atoms = position[is_near if scenery is None else is_near & ~scenery]
        seen = np.concatenate((outermost, camera.see(atoms)), axis=1)
        outermost = seen[:, np.union1d(hull(seen[0], seen[2]), hull(seen[1], seen[2]))]
    return n_shown, n_near, outermost


def _sample(shown: Sequence[Floats]) -> Floats:
    """Return the drawable atoms of as many rounds, evenly spread, as are not too many together, (n, 3) float64."""
    step = -(-len(shown) * len(shown[0]) // _SAMPLE) or 1
    taken = (shown[index] for index in range(0, len(shown), step))
    return np.concatenate([position[is_drawable(position)] for position in taken])
