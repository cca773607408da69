"""The atoms of a ball: spheres one inside the other, each made of rings from pole to pole."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.forces import quantise
from atomsim.core.model import Floats
from atomsim.scene.language import BallGroup

FINEST_BALL, FINEST_SHELL = 1000, 10_000
"""Radii in so many spacings have more atoms than fit into any memory: they are not counted."""


def count_in_ball(ball: BallGroup) -> int:
    """Return the number of atoms of a ball without making them."""
    fineness = ball.radius / ball.spacing
    if fineness > (FINEST_SHELL if ball.hollow else FINEST_BALL):
        return int(min(fineness, 1e100) ** (2 if ball.hollow else 3))
    return sum(n_atoms for _, _, n_atoms in _rings(ball))


def ball_offsets(ball: BallGroup) -> Floats:
    """Return the atoms of a ball relative to its centre, (n_atoms, 3)."""
    offset = [
        (quantise(radius * math.cos(angle)), quantise(radius * math.sin(angle)), height)
        for radius, height, n_atoms in _rings(ball)
        for angle in (2.0 * math.pi * atom / n_atoms for atom in range(n_atoms))
    ]
    return np.array(offset)


def _rings(ball: BallGroup) -> Iterator[tuple[float, float, int]]:
    """Yield radius, height and number of atoms of every ring, from the middle outwards, from below to above.

    Spheres are about one spacing apart, and so are the rings of a sphere along a meridian; whatever comes from cos and
    sin is quantised before anything is counted with it.
    """
    n_spheres = max(1, round(ball.radius / ball.spacing))
    if not ball.hollow:
        yield 0.0, 0.0, 1
    for number in range(n_spheres if ball.hollow else 1, n_spheres + 1):
        sphere = ball.radius * (number / n_spheres)
        n_steps = max(2, round(math.pi * (sphere / ball.spacing)))
        yield 0.0, -sphere, 1
        for step in range(1, n_steps):
            angle = math.pi * step / n_steps
            radius, height = quantise(sphere * math.sin(angle)), quantise(-sphere * math.cos(angle))
            yield radius, height, max(3, round(2.0 * math.pi * (radius / ball.spacing)))
        yield 0.0, sphere, 1
