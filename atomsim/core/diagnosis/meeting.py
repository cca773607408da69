"""Meetings: when and where a body on its flight first comes near other atoms."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from atomsim.core.diagnosis.flight import Path
from atomsim.core.model import Floats
from atomsim.core.pairs.near import near_pairs

FINEST = 0.3
"""A flight is looked at at least this often [length]."""

LOOKAHEAD = 3.0
"""How much farther than the distance asked for is looked for the nearest atom [length]."""

MOST_LOOKS = 2000
"""So often a flight is looked at, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Meeting:
    """Two atoms that come near each other.

    Attributes:
        round_index: when; a flight is known between rounds, too.
        one: index of the atom among those that move.
        other: index of the atom among those that are met.
        distance: of the two centres at that moment [length].
        way: how far the one has come by then, as the other sees it [length], (3,).
        speed: relative velocity at that moment [length per unit of time], (3,).
    """

    round_index: float
    one: int
    other: int
    distance: float
    way: Floats
    speed: Floats


def first_meeting(path: Path, moving: Floats, met: Floats, near: float, last: float) -> Meeting | None:
    """Return the first meeting of atoms on a path with others, or None up to the last round.

    The path is walked in steps that are too short to come near: the distance to the nearest atom shrinks by no more
    than the way. Steps are never shorter than FINEST, so that a graze of no more may be overlooked.

    Args:
        path: how the moving atoms move as seen by those that are met.
        moving: positions at the start [length], (3, n_moving).
        met: positions [length], (3, n_met).
        near: how near is a meeting [length].
        last: the last round to look at.
    """
    round_index = 0.0
    for _ in range(MOST_LOOKS):
        way, speed = path.at(round_index)
        distance, one, other = _nearest(moving + way[:, None], met, near + LOOKAHEAD)
        if distance < near:
            return Meeting(round_index, one, other, distance, way, speed)
        if round_index >= last:
            return None
        round_index = _after(path, round_index, max(distance - near, FINEST), last)
    return None


def _after(path: Path, begin: float, way: float, last: float) -> float:
    """Return a round until which a path is at most so long, as late a one as is easily found.

    Between bends the speed is largest at one of the ends, or nearly so: it only grows towards a final speed, or turns.
    """
    end = min([last, *(bend for bend in path.bends if bend > begin)])
    (_, speed) = path.at(begin)
    for _ in range(64):
        fastest = math.sqrt(max(float(speed @ speed), float(np.square(path.at(end)[1]).sum())))
        if fastest * path.time_step * (end - begin) <= way:
            break
        end = begin + 0.5 * (end - begin)
    return max(end, begin + 1e-6)


def _nearest(moving: Floats, met: Floats, farthest: float) -> tuple[float, int, int]:
    """Return the smallest distance, or `farthest` if nothing is nearer, and the two atoms."""
    low, high = moving.min(axis=1), moving.max(axis=1)
    apart = np.maximum(0.0, np.maximum(met - high[:, None], low[:, None] - met))
    is_close = (apart * apart).sum(axis=0) < farthest * farthest
    if not is_close.any():
        gap = math.sqrt(float((apart * apart).sum(axis=0).min()))
        return gap, -1, -1
    close = np.flatnonzero(is_close)
    low, high = met[:, close].min(axis=1) - farthest, met[:, close].max(axis=1) + farthest
    inside = np.flatnonzero(((moving >= low[:, None]) & (moving <= high[:, None])).all(axis=0))
    if not inside.size:
        return farthest, -1, -1
    first, second = near_pairs(moving[:, inside], met[:, close], farthest)
    if not first.size:
        return farthest, -1, -1
    squared = ((moving[:, inside[first]] - met[:, close[second]]) ** 2).sum(axis=0)
    place = int(squared.argmin())
    return math.sqrt(float(squared[place])), int(inside[first[place]]), int(close[second[place]])
