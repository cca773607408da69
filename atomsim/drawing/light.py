"""How much light falls on points of a scene, from a soft lamp and the sky, with shadows; knows no colours or pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from atomsim.core.forces import quantise
from atomsim.core.model import Floats, Indices
from atomsim.drawing.camera import Vector, cross, unit
from atomsim.drawing.trace import Grid, nearest_ball

LAMP_TOWARDS: Vector = (-0.85, 0.85, 0.3)
"""Where the lamp hangs for an upright viewer (right, up, back): left, above and a little behind him."""

_LAMP_LIGHT, _N_LAMP, _LAMP_RADIUS = 0.85, 6, 0.1
"""The lamp is a disc of this radius at distance 1, so that the edge of a shadow is the softer the farther it falls."""

_SKY_LIGHT, _N_SKY, _SKY_DEPTH = 0.65, 12, 1.15
"""The sky is a dome that reaches a little below the horizon; what sees little of it is dark, such as creases."""

_MAP_SIZE, _MAP_FRAGMENTS = 320, 1 << 19
"""Texels along the longer side of a shadow map, and how many fragments it may cost; many balls get larger texels."""

_FINEST, _COARSEST = 0.05, 1.0
"""Bounds of a texel [length]: more would not show, and less would miss balls."""

_CLEARANCE = 1e-3
"""A ball shades only what lies at least this far behind it [length], or rounding would speckle touching balls."""


@cache
def _beams() -> tuple[tuple[Vector, float], ...]:
    """Return direction (right, up, back) and strength of all beams of light; sunflower patterns fill disc and dome."""
    turn = math.pi * (3.0 - math.sqrt(5.0))
    to_lamp = unit(LAMP_TOWARDS)
    side = unit(cross(to_lamp, (0.0, 0.0, 1.0)))
    other = cross(to_lamp, side)
    beams = []
    for index in range(_N_LAMP):
        radius = _LAMP_RADIUS * math.sqrt((index + 0.5) / _N_LAMP)
        along, across = radius * math.cos(turn * index), radius * math.sin(turn * index)
        x, y, z = (to_lamp[k] + along * side[k] + across * other[k] for k in range(3))
        beams.append((unit((x, y, z)), _LAMP_LIGHT / _N_LAMP))
    for index in range(_N_SKY):
        height = 1.0 - _SKY_DEPTH * (index + 0.5) / _N_SKY
        radius = math.sqrt(1.0 - height * height)
        x, y, z = radius * math.cos(turn * index), height, radius * math.sin(turn * index)
        beams.append(((x, y, z), _SKY_LIGHT / _N_SKY))
    return tuple(((quantise(x), quantise(y), quantise(z)), strength) for (x, y, z), strength in beams)


def from_viewer(direction: Vector, vertical: Vector) -> Vector:
    """Turn (right, up, back) of an upright viewer into camera coordinates, in which `vertical` points up."""
    right = (1.0, 0.0, 0.0)
    back = cross(right, vertical)
    x, y, z = (direction[0] * right[k] + direction[1] * vertical[k] + direction[2] * back[k] for k in range(3))
    return (x, y, z)


@dataclass(frozen=True, slots=True, eq=False)
class Beam:
    """Parallel light from one direction with its shadow map, which holds the ball that the light strikes first.

    Attributes:
        right, up, back: the axes of a camera that looks along the light, in camera coordinates; back is to the light.
        strength: light on a surface that faces the beam; 1 shows a colour as it is.
        ball: centres as that camera sees them [length], (3, n) float64.
        grid: the texels of the map.
        struck: the ball for every texel, or `trace.NOTHING`, (n_rows · n_columns,) int64.
    """

    right: Vector
    up: Vector
    back: Vector
    strength: float
    ball: Floats
    grid: Grid
    struck: Indices

    @classmethod
    def of(cls, towards: Vector, strength: float, seen: Floats, lit: Indices) -> Beam:
        """Make the map that shades the balls `lit` among the balls `seen`, (3, n) float64 in camera coordinates."""
        across = (1.0, 0.0, 0.0) if abs(towards[0]) < 0.5 else (0.0, 1.0, 0.0)
        right = unit(cross(across, towards))
        up = cross(towards, right)
        ball = np.stack([_along(seen, axis) for axis in (right, up, towards)])
        grid = _grid_around(ball[0].take(lit), ball[1].take(lit), ball.shape[1])
        return cls(right, up, towards, strength, ball, grid, nearest_ball(ball, 0.0, grid).reshape(-1))

    def on(self, point: Floats, normal: Floats) -> Floats:
        """Return the light of this beam on points of balls; beyond the map there are no shadows.

        Args:
            point: places in camera coordinates [length], (3, m) float64.
            normal: outward unit normals there, (3, m) float64.

        Returns:
            Lambert's cosine times the strength, 0 in the shadow, (m,) float64.
        """
        facing = np.maximum(_along(normal, self.back), 0.0)
        return np.where(self._reaches(point), self.strength * facing, 0.0)

    def _reaches(self, point: Floats) -> NDArray[np.bool_]:
        """Tell which points are in the light.

        The map says which ball the light strikes first near a point; whether that ball is above the very point is then
        computed exactly, so no slope of a ball shades itself however coarse the map is.
        """
        x, y, z = (_along(point, axis) for axis in (self.right, self.up, self.back))
        column = np.clip((x - self.grid.left) / self.grid.pixel, 0, self.grid.n_columns - 1).astype(np.int64)
        row = np.clip((self.grid.top - y) / self.grid.pixel, 0, self.grid.n_rows - 1).astype(np.int64)
        struck = self.struck.take(row * self.grid.n_columns + column)
        offset_x, offset_y = x - self.ball[0].take(struck), y - self.ball[1].take(struck)
        inside = 1.0 - (offset_x * offset_x + offset_y * offset_y)
        surface = self.ball[2].take(struck) + np.sqrt(np.maximum(inside, 0.0))
        return np.asarray((struck < 0) | (inside <= 0.0) | (surface <= z + _CLEARANCE))


def beams_on(seen: Floats, lit: Indices, vertical: Vector) -> list[Beam]:
    """Return all light of a scene with its shadows.

    Args:
        seen: centres of the unit balls in camera coordinates [length], (3, n) float64.
        lit: the balls that show their shadows, at least one, (m,) int64.
        vertical: the direction that is up in the scene, in camera coordinates.
    """
    return [Beam.of(from_viewer(towards, vertical), strength, seen, lit) for towards, strength in _beams()]


def _grid_around(x: Floats, y: Floats, n_casting: int) -> Grid:
    """Return a shadow map around unit balls at x and y, with a rim for rounding."""
    rim = 1.01
    left, right = float(x.min()) - rim, float(x.max()) + rim
    bottom, top = float(y.min()) - rim, float(y.max()) + rim
    affordable = min(2.0 * math.sqrt(n_casting / _MAP_FRAGMENTS), _COARSEST)
    texel = max((right - left) / _MAP_SIZE, (top - bottom) / _MAP_SIZE, affordable, _FINEST)
    return Grid(left, top, texel, int((right - left) / texel) + 1, int((top - bottom) / texel) + 1)


def _along(vectors: Floats, axis: Vector) -> Floats:
    """Return the components of vectors, (3, m), along an axis, (m,); without BLAS, so always the same bits."""
    return np.asarray((vectors[0] * axis[0] + vectors[1] * axis[1]) + vectors[2] * axis[2])


def highlight_towards(vertical: Vector) -> Vector:
    """Return the direction half way between lamp and viewer, in camera coordinates: there balls shine."""
    to_lamp = unit(from_viewer(LAMP_TOWARDS, vertical))
    half = unit((to_lamp[0], to_lamp[1], to_lamp[2] + 1.0))
    return (quantise(half[0]), quantise(half[1]), quantise(half[2]))


def shine(normal: Floats, towards: Vector) -> Floats:
    """Return the 32nd power of the cosine between normals, (3, m), and a direction; 0 where they face away."""
    power = np.maximum(_along(normal, towards), 0.0)
    for _ in range(5):
        power = power * power
    return power
