"""Which unit ball is nearest at every pixel of a grid; knows no colours, no light and no space but the camera's."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from atomsim.core.model import Floats, Indices
from atomsim.drawing.camera import is_before_eye, outline

NOTHING = -1
"""The owner of a pixel that no ball covers."""

_BATCH = 1 << 17
"""Fragments worked on at a time: few enough to stay in the processor's cache and to bound the memory."""

_UNTOUCHED = np.iinfo(np.int64).max


@dataclass(frozen=True, slots=True)
class Grid:
    """Square pixels on the picture plane; row 0 is at the top.

    Attributes:
        left, top: the corner where pixel (0, 0) begins [length].
        pixel: side of a pixel [length].
        n_columns, n_rows: how many there are.
    """

    left: float
    top: float
    pixel: float
    n_columns: int
    n_rows: int

    def x(self) -> Floats:
        """Return the middles of the columns, (n_columns,) float64."""
        return self.left + (np.arange(self.n_columns, dtype=np.float64) + 0.5) * self.pixel

    def y(self) -> Floats:
        """Return the middles of the rows, (n_rows,) float64."""
        return self.top - (np.arange(self.n_rows, dtype=np.float64) + 0.5) * self.pixel

    def band(self, first: int, n_rows: int) -> Grid:
        """Return consecutive rows from `first` on, at most as many as there are."""
        top = self.top - first * self.pixel
        return Grid(self.left, top, self.pixel, self.n_columns, min(n_rows, self.n_rows - first))


def nearest_ball(seen: Floats, convergence: float, grid: Grid) -> Indices:
    """Return the ball that is nearest to the viewer at every pixel, or `NOTHING`.

    Every ball is spread into fragments, one for each pixel that it may cover. A fragment is one integer: the distance
    as float32 bits, which for numbers above zero are in the order of the numbers, in the high half, and the ball in
    the low half. The smallest integer of a pixel wins, so where balls intersect each pixel gets the right one.

    Args:
        seen: centres in camera coordinates [length], (3, n) float64, n < 2³².
        convergence: s of the camera [1/length].
        grid: the pixels.

    Returns:
        Indices into the second axis of `seen`, (n_rows, n_columns) int64.
    """
    best = np.full(grid.n_rows * grid.n_columns, _UNTOUCHED)
    covered = Coverage.of(seen, convergence, grid)
    farther = float(seen[2].take(covered.ball).max(initial=-np.inf)) + 2.0
    x, y = grid.x(), grid.y()
    for ball, column, row in covered.fragments():
        centre_z = seen[2].take(ball)
        nearness = 1.0 - convergence * centre_z
        ray_x, ray_y = x.take(column), y.take(row)
        offset_x, offset_y = ray_x * nearness - seen[0].take(ball), ray_y * nearness - seen[1].take(ball)
        square, half, discriminant = _quadratic(offset_x, offset_y, ray_x, ray_y, convergence)
        hit = np.flatnonzero(discriminant > 0.0)
        height = (half.take(hit) + np.sqrt(discriminant.take(hit))) / square.take(hit)
        distance = (farther - (centre_z.take(hit) + height)).astype(np.float32)
        pixel = (row * grid.n_columns + column).take(hit)
        np.minimum.at(best, pixel, (distance.view(np.int32).astype(np.int64) << 32) | ball.take(hit))
    owner = np.where(best == _UNTOUCHED, NOTHING, best & 0xFFFFFFFF)
    return owner.reshape(grid.n_rows, grid.n_columns)


def normals(seen: Floats, ball: Indices, ray_x: Floats, ray_y: Floats, convergence: float) -> Floats:
    """Return the outward unit normals where rays of sight strike balls: the point struck minus the centre.

    Args:
        seen: centres in camera coordinates [length], (3, n) float64.
        ball: the ball that each ray strikes, (m,) int64.
        ray_x, ray_y: where each ray crosses the picture plane [length], (m,) float64.
        convergence: s of the camera [1/length].

    Returns:
        x, y and z of the normals in camera coordinates as rows, (3, m) float64.
    """
    nearness = 1.0 - convergence * seen[2].take(ball)
    offset_x, offset_y = ray_x * nearness - seen[0].take(ball), ray_y * nearness - seen[1].take(ball)
    square, half, discriminant = _quadratic(offset_x, offset_y, ray_x, ray_y, convergence)
    height = (half + np.sqrt(discriminant)) / square
    return np.stack([offset_x - convergence * ray_x * height, offset_y - convergence * ray_y * height, height])


def _quadratic(
    offset_x: Floats, offset_y: Floats, ray_x: Floats, ray_y: Floats, convergence: float
) -> tuple[Floats, Floats, Floats]:
    """Return A, B and B² − A·C of A·h² − 2·B·h + C = 0, whose larger root is where a ray meets a unit ball.

    h is the height of the point above the centre of the ball, towards the viewer; the offset is that of the ray from
    the centre at h = 0. On the ray, (offset − s·ray·h)² + h² = 1.
    """
    square = 1.0 + convergence * convergence * (ray_x * ray_x + ray_y * ray_y)
    half = convergence * (offset_x * ray_x + offset_y * ray_y)
    rest = (offset_x * offset_x + offset_y * offset_y) - 1.0
    return square, half, half * half - square * rest


@dataclass(frozen=True, slots=True, eq=False)
class Coverage:
    """The rectangle of pixels that each ball may cover, for those balls that may cover any; arrays are (m,) int64."""

    ball: Indices
    first_column: Indices
    n_columns: Indices
    first_row: Indices
    n_rows: Indices

    @classmethod
    def of(cls, seen: Floats, convergence: float, grid: Grid) -> Coverage:
        """Find the rectangles of unit balls at `seen`, (3, n) float64 in camera coordinates."""
        ball = np.flatnonzero(is_before_eye(seen, convergence))
        left, right, bottom, top = outline(seen.take(ball, axis=1), convergence)
        first_column, n_columns = _span(left - grid.left, right - grid.left, grid.pixel, grid.n_columns)
        first_row, n_rows = _span(grid.top - top, grid.top - bottom, grid.pixel, grid.n_rows)
        kept = np.flatnonzero((n_columns > 0) & (n_rows > 0))
        return cls(*(array.take(kept) for array in (ball, first_column, n_columns, first_row, n_rows)))

    def fragments(self) -> Iterator[tuple[Indices, Indices, Indices]]:
        """Yield ball, column and row of every pixel of every rectangle, each (k,) int64, in batches of balls."""
        total = np.cumsum(self.n_columns * self.n_rows)
        start = 0
        while start < len(self.ball):
            done = int(total[start - 1]) if start else 0
            stop = max(int(np.searchsorted(total, done + _BATCH, side="right")), start + 1)
            part = slice(start, stop)
            height = self.n_rows[part]
            width = np.repeat(self.n_columns[part], height)
            row = np.repeat(_count_from(self.first_row[part], height), width)
            column = _count_from(np.repeat(self.first_column[part], height), width)
            yield np.repeat(np.repeat(self.ball[part], height), width), column, row
            start = stop


def _span(low: Floats, high: Floats, pixel: float, n_pixels: int) -> tuple[Indices, Indices]:
    """Return the first pixel with its middle between `low` and `high`, and how many there are (below 1: none)."""
    first = np.clip(np.ceil(low / pixel - 0.5), 0, n_pixels).astype(np.int64)
    last = np.clip(np.floor(high / pixel - 0.5), -1, n_pixels - 1).astype(np.int64)
    return first, last - first + 1


def _count_from(first: Indices, count: Indices) -> Indices:
    """Return first, first + 1, …, `count` numbers for every entry, one entry after the other."""
    end = np.cumsum(count)
    return np.arange(end[-1]) - np.repeat(end - count - first, count)
