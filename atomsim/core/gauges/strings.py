"""How two strings are entwined: winding about an axis, and crossings; a string is known by the order of its atoms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from atomsim.core.gauges.block import Atoms, Block, Memoryless, cross, dot, length, one_row, ordered_sum
from atomsim.core.gauges.eigen import eigen
from atomsim.core.gauges.motion import mean
from atomsim.core.gauges.rigid import grained
from atomsim.core.model import Floats

PIECES_AT_A_TIME = 1 << 15
"""Pairs of straight pieces looked at together, times frames: what the cache of one core holds."""


@dataclass(frozen=True, slots=True, eq=False)
class Winding(Memoryless):
    """The angle through which a string winds about the long axis of a body.

    The axis goes through the centroid, along the direction in which the body reaches farthest in the mean square. The
    polar angle about it is followed from atom to atom, each time by at most half a turn; its range is the winding.

    Attributes:
        string: what winds.
        body: about what.
    """

    string: Atoms
    body: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the range of the polar angle [degrees]."""
        around = block.position[:, self.body]
        centre = mean(around)
        offset = around - centre[:, None]
        moments = np.stack([ordered_sum(row * offset) for row in offset])
        axes = eigen(moments)[1]
        place = block.position[:, self.string] - centre[:, None]
        angle = grained(np.degrees(np.arctan2(dot(axes[:, 2, None], place), dot(axes[:, 1, None], place))))
        step = np.diff(angle, axis=0)
        step -= 360.0 * np.round(step / 360.0)
        followed = np.add.accumulate(np.concatenate([np.zeros((1, block.n_frames)), step]), axis=0)
        return one_row(followed.max(axis=0) - followed.min(axis=0))


@dataclass(frozen=True, slots=True, eq=False)
class Crossings(Memoryless):
    """How often two strings cross as seen from one side, in the mean over all sides.

    That is the unsigned Gauss integral, here of the straight pieces between neighbours (Klenin and Langowski,
    Biopolymers 54 (2000) 307, method 1a). Straight strings cross once at most from any side.

    Attributes:
        left: one string, at least two atoms.
        right: the other, at least two atoms.
    """

    left: Atoms
    right: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return Σ |Ω| / 2π over pairs of pieces, each of which crosses from the directions in solid angles ±Ω."""
        left, right = block.position[:, self.left], block.position[:, self.right]
        total = np.zeros((1, block.n_frames))
        step = max(1, PIECES_AT_A_TIME // (right.shape[1] * block.n_frames))
        for start in range(0, left.shape[1] - 1, step):
            angles = _solid_angles(left[:, start : start + step + 1], right)
            total = ordered_sum(np.concatenate([total, angles.reshape(-1, block.n_frames)])).reshape(1, -1)
        return total / (2.0 * np.pi)


def _solid_angles(left: Floats, right: Floats) -> Floats:
    """Return |Ω| of all pairs of pieces, (n_left − 1, n_right − 1, n_frames)."""
    start, stop = left[:, :-1, None], left[:, 1:, None]
    corners = [right[:, None, :-1] - start, right[:, None, 1:] - start]
    corners += [right[:, None, 1:] - stop, right[:, None, :-1] - stop]
    normals = [_unit(cross(one, other)) for one, other in zip(corners, corners[1:] + corners[:1], strict=True)]
    cosines = [dot(one, other).clip(-1.0, 1.0) for one, other in zip(normals, normals[1:] + normals[:1], strict=True)]
    first, second, third, fourth = (np.arcsin(cosine) for cosine in cosines)
    return grained(np.abs((first + second) + (third + fourth)))


def _unit(vectors: Floats) -> Floats:
    """Scale to length one; a zero vector (two pieces in one plane) stays zero and counts for nothing."""
    size = length(vectors)
    return np.asarray(vectors / np.where(size == 0.0, 1.0, size))
