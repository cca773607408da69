"""What `ball_1` and `ball_2` do on `surface`, and it under them; knows no expected number."""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Floats, Indices
from support.behaviour.runs import Run
from support.behaviour.surfaces import best_plane, depth_below_rim

CONTACT = 2.0
"""Two atoms touch below this distance: the sum of their radii."""


def gap(run: Run, ball: str) -> Floats:
    """Return the distance of a ball's centre to the nearest centre of the surface, (n_frames,)."""
    return _distances(run, ball).min(axis=1)


def first_touch(run: Run, ball: str) -> int | None:
    """Return the first recorded round in which a ball touches the surface."""
    touching = np.flatnonzero(gap(run, ball) < CONTACT)
    return int(run.round[touching[0]]) if touching.size else None


def rise(run: Run, ball: str) -> float:
    """Return how far a ball rises again after its first touch: from its first low to the next high."""
    height = run.path(ball)[:, 0, 2]
    is_rising = np.diff(height) > 0
    if not is_rising.any():
        return 0.0
    low = int(np.argmax(is_rising))
    falls_again = np.flatnonzero(~is_rising[low:])
    high = low + int(falls_again[0]) if falls_again.size else len(is_rising)
    return float(height[high] - height[low])


def arrival(run: Run, atoms: Indices, least: float) -> int | None:
    """Return the first recorded round in which one of these atoms of the surface has left its level by `least`."""
    moved = np.abs(run.path("surface")[:, atoms, 2]).max(axis=1) > least
    return int(run.round[np.argmax(moved)]) if moved.any() else None


def column(run: Run, x: int) -> Indices:
    """Return the atoms of the surface that started at some x."""
    return np.flatnonzero(run.path("surface")[0, :, 0] == x)


def rims(run: Run) -> dict[str, Indices]:
    """Return the four rims of a 25 × 25 surface."""
    x, y, _ = run.path("surface")[0].T
    return {"x+": x == x.max(), "y+": y == y.max(), "y-": y == y.min(), "x-": x == x.min()}


def depth_under(run: Run, ball: str, round_index: int) -> float:
    """Return how far the surface under a ball lies below the plane that fits its four rims best."""
    surface, frame = run.path("surface"), run.frame(round_index)
    return float(depth_below_rim(surface[0], surface[frame], up=2)[_nearest(run, ball)[frame]])


def slide(run: Run, ball: str, from_round: int, touching: float) -> Floats:
    """Return the way of a ball along the surface, from its first touch after a round to its last, (x, y).

    It is told in places of the surface: where the atom nearest to the ball started. A ball touches when its gap is
    below `touching`; a ball that never does has no way.
    """
    frames = np.flatnonzero((run.round >= from_round) & (gap(run, ball) < touching))
    if not frames.size:
        return np.zeros(2)
    place = run.path("surface")[0, _nearest(run, ball), :2]
    return place[frames[-1]] - place[frames[0]]


def downhill(run: Run, round_index: int) -> Floats:
    """Return the direction (x, y) in which the surface as a whole descends, with its slope as length."""
    return -best_plane(run.path("surface")[run.frame(round_index)], up=2)[:2]


def fell_off(run: Run, ball: str) -> int | None:
    """Return the first recorded round in which a ball is outside the outline of the surface, and below all of it."""
    surface, place = run.path("surface"), run.path(ball)[:, 0]
    is_outside = ((place < surface.min(axis=1)) | (place > surface.max(axis=1)))[:, :2].any(axis=1)
    is_below = place[:, 2] < surface[:, :, 2].min(axis=1)
    is_off = is_outside & is_below
    return int(run.round[np.argmax(is_off)]) if is_off.any() else None


def _nearest(run: Run, ball: str) -> Indices:
    """Return which atom of the surface is nearest to a ball, (n_frames,)."""
    return _distances(run, ball).argmin(axis=1)


def _distances(run: Run, ball: str) -> Floats:
    return np.linalg.norm(run.path("surface") - run.path(ball), axis=2)
