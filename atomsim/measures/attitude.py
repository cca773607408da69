"""What happens to parts by themselves, and to strings: they come to rest, topple, wrap, entangle."""

from __future__ import annotations

from collections.abc import Iterator

from atomsim.core.gauges.eigen import eigen
from atomsim.core.model import Floats, Indices
from atomsim.measures.hysteresis import Stretch, stretches, swing

TOPPLED, STANDING = 60.0, 30.0
"""A part that is carried topples when it leans more than TOPPLED, until it leans less than STANDING [degrees]."""

STIFF = 0.3
"""What topples has kept its shape: it is deformed by less than this share of its outer radius."""

RESTING, WAY = 10.0, 0.1
"""A part rests when for so many swings none of its atoms is so fast that it would get this far in them [length], …"""

MOVING = 5.0
"""… and moves, before that and after, when one is faster than that by this factor."""

WRAPPED, UNWRAPPED = 360.0, 270.0
"""A string wraps around a rod when it winds about it by more than WRAPPED, until by less than UNWRAPPED [degrees]."""

STRAIGHT = 0.01
"""What is wrapped around reaches across, in the mean square, at most this share of what it reaches along; what is
entangled is not straight."""

ENTANGLED, DISENTANGLED = 2.0, 1.5
"""Strings are entangled when they cross more often than ENTANGLED, until less often than DISENTANGLED."""


def rests(round_index: Indices, fastest: Floats, time_step: float) -> Iterator[int]:
    """Yield the rounds in which a part comes to rest, having moved.

    Args:
        round_index: of each frame, (n_frames,) int64.
        fastest: the speed of its fastest atom [length/time], (n_frames,).
        time_step: τ [time].
    """
    n_rounds = RESTING * swing(time_step)
    slow = WAY / (n_rounds * time_step)
    is_moving = fastest > MOVING * slow
    for stretch in stretches(fastest < slow, is_moving):
        until = round_index[-1 if stretch.end is None else stretch.end]
        if until - round_index[stretch.begin] >= n_rounds and is_moving[: stretch.begin].any():
            yield int(round_index[stretch.begin])


def topples(round_index: Indices, tilt: Floats, deformation: Floats, radius: Floats) -> Iterator[int]:
    """Yield the rounds in which a part topples.

    Args:
        round_index: of each frame, (n_frames,) int64.
        tilt: its tilt [degrees], (n_frames,).
        deformation: its deformation [length], (n_frames,).
        radius: its outer radius [length], (n_frames,).
    """
    for stretch in stretches(tilt > TOPPLED, tilt < STANDING):
        if deformation[stretch.begin] < STIFF * radius[stretch.begin]:
            yield int(round_index[stretch.begin])


def wraps(winding: Floats) -> list[Stretch]:
    """Return the stretches of frames in which a string is wrapped, its winding given [degrees], (n_frames,)."""
    return stretches(winding > WRAPPED, winding < UNWRAPPED)


def entanglements(crossings: Floats) -> list[Stretch]:
    """Return the stretches of frames in which two strings are entangled, their crossings given, (n_frames,)."""
    return stretches(crossings > ENTANGLED, crossings < DISENTANGLED)


def is_straight(position: Floats) -> bool:
    """Tell whether atoms lie about a line, (n, 3)."""
    offset = position - position.mean(axis=0)
    along, across, _ = eigen((offset.T @ offset)[:, :, None])[0][:, 0].tolist()
    return bool(across <= STRAIGHT * along)
