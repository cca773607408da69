"""What two colliding strings `left` and `right` do: bounce, vibrate, wrap, entangle; knows no expected number."""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Floats
from support.behaviour.runs import Run

EVERY = 5
"""Windings and crossings are measured in every fifth frame: they change slowly and cost most."""


def restitution(run: Run) -> float:
    """Return e = −(velocity apart at the end) / (velocity together at the start), along the line of approach.

    1 is a perfectly elastic collision, 0 a perfectly inelastic one, −1 no collision at all: the strings pass on.
    """
    apart = run.drift("right") - run.drift("left")
    return -float(apart[-1] @ apart[0] / (apart[0] @ apart[0]))


def energy_kept(run: Run) -> float:
    """Return how much of the kinetic energy of the approach is left in the motion of the two centres at the end."""
    apart = run.drift("right") - run.drift("left")
    return float(apart[-1] @ apart[-1] / (apart[0] @ apart[0]))


def distance(run: Run) -> Floats:
    """Return the distance of the two centroids, (n_frames,)."""
    return np.linalg.norm(run.centre("right") - run.centre("left"), axis=1)


def sag(run: Run, group: str) -> Floats:
    """Return how far the middle of a string stands off the chord between its ends, with its sign, (n_frames,).

    The sign is taken along a direction that starts as x, the direction of the impact, and turns with the string:
    from frame to frame it is made perpendicular to the chord again. A rigid motion leaves the sag at zero.
    """
    string = run.path(group)
    middle = string.shape[1] // 2
    chord = string[:, -1] - string[:, 0]
    offset = string[:, middle - 1 : middle + 1].mean(axis=1) - (string[:, 0] + string[:, -1]) / 2
    side = np.array([1.0, 0.0, 0.0])
    signed = np.empty(len(string))
    for frame, along in enumerate(chord / np.linalg.norm(chord, axis=1, keepdims=True)):
        side = side - (side @ along) * along
        side = side / np.linalg.norm(side)
        signed[frame] = offset[frame] @ side
    return signed


def swings(signed: Floats, least: float) -> int:
    """Return how many times a signal goes from beyond ±`least` on one side to beyond it on the other."""
    side = np.sign(signed[np.abs(signed) > least])
    return int((side[1:] != side[:-1]).sum())


def winding(run: Run) -> float:
    """Return the largest angle [radians] that `right` winds about the axis of `left` at any time.

    It is the range of the polar angle about the axis, followed continuously from atom to atom.
    """
    return max(
        _angle_about(left, right)
        for left, right in zip(run.path("left")[::EVERY], run.path("right")[::EVERY], strict=True)
    )


def _angle_about(rod: Floats, thread: Floats) -> float:
    across = np.linalg.svd(rod[-1:] - rod[:1])[2][1:]
    first, second = across @ (thread - rod.mean(axis=0)).T
    return float(np.ptp(np.unwrap(np.arctan2(second, first))))


def crossings(run: Run) -> float:
    """Return the largest average crossing number of the two strings at any time.

    Seen from some direction the two strings cross so many times; this is the mean over all directions, the unsigned
    Gauss integral, summed over pairs of straight pieces (Klenin and Langowski, Biopolymers 54 (2000) 307, method 1a).
    """
    return max(
        _mean_crossings(left, right)
        for left, right in zip(run.path("left")[::EVERY], run.path("right")[::EVERY], strict=True)
    )


def _mean_crossings(left: Floats, right: Floats) -> float:
    """Return Σ |Ω| / 2π: of all directions, a pair of pieces crosses in those within the solid angles ±Ω."""
    start, stop = left[:-1, None], left[1:, None]
    corners = [right[:-1] - start, right[1:] - start, right[1:] - stop, right[:-1] - stop]
    normals = [_unit(np.cross(one, other)) for one, other in zip(corners, corners[1:] + corners[:1], strict=True)]
    cosines = [
        (one * other).sum(axis=-1).clip(-1, 1) for one, other in zip(normals, normals[1:] + normals[:1], strict=True)
    ]
    solid_angle = sum(np.arcsin(cosine) for cosine in cosines)
    return float(np.abs(solid_angle).sum() / (2 * np.pi))


def _unit(vectors: Floats) -> Floats:
    """Scale to length one; a zero vector (two pieces in one plane) stays zero and counts for nothing."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length == 0, 1, length)
