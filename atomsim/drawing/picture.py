"""One picture of unit balls as an array of pixels; knows no text, no files and no matplotlib."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats, Indices
from atomsim.drawing.camera import Camera
from atomsim.drawing.framing import is_drawable
from atomsim.drawing.light import Beam, beams_on, highlight_towards, shine
from atomsim.drawing.trace import NOTHING, Coverage, Grid, nearest_ball, normals

SUPERSAMPLING = 2
"""Each pixel is the mean of this many times as many along either side."""

_BAND = 1 << 18
"""Supersampled pixels worked on at a time, which bounds the memory of a picture of any size."""

_FILL = (0.03, 0.13)
"""Light that reaches every shadow: everywhere, and on what faces the viewer."""

_RIM, _GLOSS = 0.6, 0.14
"""How much darker a ball is at its outline, which tells it from its neighbours; and how bright its highlight is."""

Pixels: TypeAlias = NDArray[np.uint8]
"""A picture, (height, width, 3 or 4): row 0 at the top; red, green, blue, and how opaque it is."""


def draw(
    position: Floats,
    color: Floats,
    camera: Camera,
    size: tuple[int, int],
    background: tuple[float, float, float] | None = (0.96, 0.96, 0.97),
) -> Pixels:
    """Draw atoms as unit balls: exact per pixel also where they intersect, with soft light and shadows on one another.

    Atoms with coordinates that are not finite or beyond all scenes are left out. Only + − × ÷ and √ of IEEE-754
    make a pixel, in a fixed order, so the same input gives the same bytes everywhere.

    Limitations: a ball is lost between the samples where it appears smaller than half a pixel.

    Args:
        position: atom centres [length], (n_atoms, 3) float64.
        color: red, green and blue of every atom from 0 to 1, (n_atoms, 3) float64.
        camera: from where and how large.
        size: width and height [pixels].
        background: red, green and blue from 0 to 1; None for none, so that the picture can be laid over others.

    Returns:
        (height, width, 3) uint8, without a background (height, width, 4).
    """
    drawable = is_drawable(position)
    seen = camera.see(position[drawable])
    n_columns, n_rows = SUPERSAMPLING * size[0], SUPERSAMPLING * size[1]
    pixel = camera.width / n_columns
    grid = Grid(-camera.width / 2, n_rows * pixel / 2, pixel, n_columns, n_rows)
    lit = _lit(seen, camera, grid)
    beams = beams_on(seen, lit, camera.direction(camera.vertical)) if len(lit) else []
    scene = _Lit(seen, color[drawable] * color[drawable], camera, beams, background)
    band = SUPERSAMPLING * max(_BAND // (n_columns * SUPERSAMPLING), 1)
    return np.concatenate([scene.paint(grid.band(first, band)) for first in range(0, n_rows, band)])


def _lit(seen: Floats, camera: Camera, grid: Grid) -> Indices:
    """Return the balls that have to show their shadows: those in the picture, but not specks far away.

    The shadow maps cover these balls, so a speck in the distance would make them too coarse for all others.
    """
    visible = Coverage.of(seen, camera.convergence, grid).ball
    near = visible[(np.abs(seen.take(visible, axis=1)) <= 2.0 * camera.width).all(axis=0)]
    return near if len(near) else visible


def _mean_of_samples(light: Floats) -> Floats:
    """Return the means of the samples of every pixel: (m, 2·n_rows, 2·n_columns) to (m, n_rows, n_columns)."""
    return (light[:, 0::2, 0::2] + light[:, 0::2, 1::2] + light[:, 1::2, 0::2] + light[:, 1::2, 1::2]) / 4.0


@dataclass(frozen=True, slots=True, eq=False)
class _Lit:
    """A scene ready to be painted band by band.

    Colours are squared here: as screens square them (nearly), light adds up in squares, and the root comes last.
    """

    seen: Floats
    color: Floats
    camera: Camera
    beams: list[Beam]
    background: tuple[float, float, float] | None

    def paint(self, grid: Grid) -> Pixels:
        """Return the pixels of a band."""
        owner = nearest_ball(self.seen, self.camera.convergence, grid)
        is_ball = owner != NOTHING
        row, column = np.nonzero(is_ball)
        light = np.zeros((3, grid.n_rows, grid.n_columns))
        if self.background is not None:
            light[:] = np.square(np.array(self.background))[:, np.newaxis, np.newaxis]
        light[:, row, column] = self._shade(owner[row, column], grid.x().take(column), grid.y().take(row))
        mean = _mean_of_samples(light)
        if self.background is None:  # the colour is that of the balls alone, so that no edge has a fringe
            opacity = _mean_of_samples(is_ball[np.newaxis].astype(np.float64))
            mean = np.concatenate((mean / np.maximum(opacity, 0.25), np.square(opacity)))
        return np.moveaxis(np.sqrt(mean) * 255.0 + 0.5, 0, 2).astype(np.uint8)

    def _shade(self, ball: Indices, ray_x: Floats, ray_y: Floats) -> Floats:
        """Return what colour the balls show where rays of sight strike them, (3, m)."""
        normal = normals(self.seen, ball, ray_x, ray_y, self.camera.convergence)
        point = self.seen.take(ball, axis=1) + normal
        fallen = np.zeros(len(ball))
        for beam in self.beams:
            fallen += beam.on(point, normal)
        tilt = 1.0 - normal[2]
        light = (fallen + _FILL[0] + _FILL[1] * normal[2]) * (1.0 - _RIM * tilt * tilt)
        gloss = _GLOSS * fallen * shine(normal, highlight_towards(self.camera.direction(self.camera.vertical)))
        return np.asarray(np.minimum(self.color.take(ball, axis=0).T * light + gloss, 1.0))
