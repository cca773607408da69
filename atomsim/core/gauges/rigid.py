"""How bodies have turned since a first state, by the rigid motion that fits best (Kabsch's problem)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from atomsim.core.gauges.block import Atoms, Block, Memoryless, cross, dot, length, one_row, ordered_sum
from atomsim.core.gauges.eigen import eigen
from atomsim.core.gauges.motion import mean
from atomsim.core.model import Floats

GRAIN = 2.0**40
"""Angles are rounded to multiples of 1/GRAIN degrees, so that a libm that differs in the last place changes nothing."""

COLLINEAR = 1e-4
"""A body is a line when its second moment across is at most this share of that along it: it is a hundred times as long
as wide, in the mean square, and a little jitter across tells nothing of how it turns about itself."""

ALIKE = 0.05
"""Two second moments that differ by less than this share of the largest are those of a body of revolution."""

UNTURNED = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """Some atoms and the shape they had at first.

    Attributes:
        atoms: which.
        shape: their places at first, from their centroid [length], (3, n) float64.
        line: the direction along which all of them lay, (3,) float64, or None.
        axis: the axis of revolution, about which turning cannot be seen, (3,) float64, or None: that of a ring, a
            disc, a square sheet, a rod, a tower; not of a cart, a cube or a ball.
        is_round: whether it reaches as far in all directions, in the mean square, as a ball does or a cube.
    """

    atoms: Atoms
    shape: Floats
    line: Floats | None
    axis: Floats | None
    is_round: bool

    @classmethod
    def of(cls, atoms: Atoms, position: Floats) -> Body:
        """Describe a body by its first state.

        Args:
            atoms: at least two.
            position: all atom centres at first [length], (n_atoms, 3).
        """
        place = np.ascontiguousarray(position[atoms].T)[:, :, None]
        shape = (place - mean(place)[:, None])[:, :, 0]
        moments, axes = eigen(_moments(shape[:, :, None], shape[:, :, None]))
        largest, middle, least = moments[:, 0].tolist()
        is_flat_round, is_long_round = largest - middle <= ALIKE * largest, middle - least <= ALIKE * largest
        axis = axes[:, 2, 0] if is_flat_round else axes[:, 0, 0]
        is_line = middle <= COLLINEAR * largest
        return cls(
            atoms,
            np.ascontiguousarray(shape),
            line=axes[:, 0, 0] if is_line else None,
            axis=axis if is_flat_round != is_long_round else None,
            is_round=largest - least <= ALIKE * largest,
        )

    def offsets(self, block: Block) -> Iterator[Floats]:
        """Yield how far atoms are from their centroid along x, y, z, (n, n_frames) each."""
        for places in block.position:
            along = places[self.atoms]
            yield along - mean(along)

    def direction(self, block: Block) -> Floats:
        """Return where a line points: the unit vector u that makes Σ |s u − c|² least, (3, n_frames)."""
        assert self.line is not None
        along = dot(self.line[:, None], self.shape)[:, None]
        reach = np.stack([ordered_sum(along * offset) for offset in self.offsets(block)])
        size = length(reach)
        return np.where(size == 0.0, self.line[:, None], reach / np.where(size == 0.0, 1.0, size))

    def rotation(self, block: Block) -> Floats:
        """Return the rotation R that makes Σ |R a − c|² least, as unit quaternions (4, n_frames).

        It is the first eigenvector of a matrix of four rows (Horn, J. Opt. Soc. Am. A 4 (1987) 629), never a mirror
        image. A line, about which that leaves the turning open, turns the least that takes it where it is.
        """
        if self.line is not None:
            return _least_rotation(self.line[:, None], self.direction(block))
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = _moments(self.shape[:, :, None], self.offsets(block))
        rows = [
            [xx + yy + zz, yz - zy, zx - xz, xy - yx],
            [yz - zy, xx - yy - zz, xy + yx, zx + xz],
            [zx - xz, xy + yx, yy - xx - zz, yz + zy],
            [xy - yx, zx + xz, yz + zy, zz - xx - yy],
        ]
        return eigen(np.array(rows))[1][:, 0]


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """How far a body has turned about axes fixed in space since its first state, whole turns counted.

    From frame to frame the rotations that fit best differ by one of at most half a turn: an angle times an axis. These
    vectors are summed. For a body that turns about one axis the sum is its angle; in general it is the integral of the
    angular velocity.

    Attributes:
        body: what turns.
        axes: about which axes.
    """

    body: Body
    axes: tuple[int, ...] = (0, 1, 2)

    @property
    def n_columns(self) -> int:
        return len(self.axes)

    def begin(self) -> Floats:
        """Return no turning, and the attitude at first: a quaternion, or the direction of a line."""
        attitude = UNTURNED if self.body.line is None else self.body.line.tolist()
        return np.array([0.0, 0.0, 0.0, *attitude])

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the sums [degrees]."""
        attitude = self.body.rotation(block) if self.body.line is None else self.body.direction(block)
        before = np.concatenate([memory[3:, None], attitude[:, :-1]], axis=1)
        step = _relative(before, attitude) if self.body.line is None else _least_rotation(before, attitude)
        summed = np.add.accumulate(np.concatenate([memory[:3, None], rotation_vector(step)], axis=1), axis=1)[:, 1:]
        memory[:3], memory[3:] = summed[:, -1], attitude[:, -1]
        return summed[list(self.axes)]


@dataclass(frozen=True, slots=True, eq=False)
class Tilt(Memoryless):
    """The angle by which what was up in a body at first leans away from up.

    A body of revolution may turn about its axis without leaning: of all such turnings the one counts that leans least,
    which makes the tilt | ∠(R a, up) − ∠(a, up) |, a being the axis.
    """

    body: Body
    up: int
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the angle [degrees], from 0 to 180."""
        up = np.zeros((3, 1))
        up[self.up] = 1.0
        axis = up if self.body.axis is None else self.body.axis[:, None]
        leans = angle_between(rotate(self.body.rotation(block), axis), up)
        return one_row(grained(np.abs(leans - angle_between(axis, up))))


@dataclass(frozen=True, slots=True, eq=False)
class Deformation(Memoryless):
    """How far the atoms of a body are, in the mean square, from where a rigid body would have them."""

    body: Body
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return √(Σ |R a − c|² / n) [length]."""
        rotation = self.body.rotation(block)
        columns = [rotate(rotation, np.eye(3)[:, [axis]]) for axis in range(3)]
        squared = np.zeros((self.body.shape.shape[1], block.n_frames))
        for axis, offset in enumerate(self.body.offsets(block)):
            rigid = sum(columns[k][axis] * self.body.shape[k][:, None] for k in range(3))
            squared += (rigid - offset) ** 2
        return one_row(np.sqrt(mean(squared)))


def rotate(quaternion: Floats, vector: Floats) -> Floats:
    """Turn vectors (3, m) by unit quaternions (4, m): v + 2 w (u × v) + 2 u × (u × v)."""
    scalar, axis = quaternion[0], quaternion[1:]
    once = 2.0 * cross(axis, np.broadcast_to(vector, axis.shape))
    return np.asarray(vector + scalar * once + cross(axis, once))


def rotation_vector(quaternion: Floats) -> Floats:
    """Return the angle times the axis [degrees] of rotations by at most half a turn, (4, m) becomes (3, m)."""
    sign = np.where(quaternion[0] < 0.0, -1.0, 1.0)
    size = length(quaternion[1:])
    angle = 2.0 * np.degrees(np.arctan2(size, sign * quaternion[0]))
    return grained(sign * angle / np.where(size == 0.0, 1.0, size) * quaternion[1:])


def angle_between(one: Floats, other: Floats) -> Floats:
    """Return the angle between vectors (3, m) [degrees]; accurate also where it is tiny or nearly 180."""
    return np.asarray(np.degrees(np.arctan2(length(cross(one, other)), dot(one, other))))


def grained(degrees: Floats) -> Floats:
    """Return angles without what a libm may round differently."""
    return np.asarray(np.round(degrees * GRAIN) / GRAIN)


def _moments(one: Floats, others: Iterable[Floats]) -> Floats:
    """Return Σ a bᵀ over atoms; (3, n, 1) and (n, m) for each axis become (3, 3, m)."""
    columns = [[ordered_sum(row * other) for row in one] for other in others]
    return np.array(columns).swapaxes(0, 1)


def _relative(before: Floats, after: Floats) -> Floats:
    """Return the rotations that come after others to make new ones: after · before*, quaternions (4, m)."""
    scalar = dot(before[1:], after[1:]) + before[0] * after[0]
    vector = before[0] * after[1:] - after[0] * before[1:] + cross(before[1:], after[1:])
    return np.concatenate([scalar[None], vector])


def _least_rotation(before: Floats, after: Floats) -> Floats:
    """Return the least rotations from unit vectors to unit vectors (3, m), as unit quaternions (4, m).

    Opposite vectors leave the axis open; any at right angles will do.
    """
    before = np.broadcast_to(before, after.shape)
    scalar = dot(before, after) + 1.0
    vector = cross(before, after)
    size = np.sqrt(scalar * scalar + dot(vector, vector))
    is_opposite = size < 1e-9
    aside = cross(before, np.where(np.abs(before).argmin(axis=0) == np.arange(3)[:, None], 1.0, 0.0))
    aside = aside / length(aside)
    safe = np.where(is_opposite, 1.0, size)
    return np.concatenate(
        [np.where(is_opposite, 0.0, scalar / safe)[None], np.where(is_opposite, aside, vector / safe)]
    )
