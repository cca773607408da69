"""Stretches of a series in which something is so, begun by one threshold and ended by another."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Truths = NDArray[np.bool_]


class Stretch(NamedTuple):
    """Frames from the first in which something is so, over the last, to the first in which it has ended, if it has."""

    begin: int
    last: int
    end: int | None


def stretches(is_so: Truths, is_over: Truths) -> list[Stretch]:
    """Find the stretches of a series; with two thresholds a number that trembles about one begins only one.

    Args:
        is_so: whether each frame begins a stretch, or keeps it, (n_frames,).
        is_over: whether each frame ends it, (n_frames,).
    """
    found = []
    frame = 0
    while frame < is_so.size and is_so[frame:].any():
        begin = frame + int(is_so[frame:].argmax())
        ends = np.flatnonzero(is_over[begin:])
        end = begin + int(ends[0]) if ends.size else None
        last = begin + int(np.flatnonzero(is_so[begin:end])[-1])
        found.append(Stretch(begin, last, end))
        frame = is_so.size if end is None else end
    return found


def swing(time_step: float) -> float:
    """Return how many rounds one swing of two atoms lasts whose contact pushes back, or whose bond pulls: 2π / √(2τ).

    That is the scale on which contacts begin and end, whatever τ is.
    """
    return 2.0 * math.pi / math.sqrt(2.0 * time_step)
