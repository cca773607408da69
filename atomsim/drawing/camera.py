"""How positions turn into places on a picture; knows no colours, no light and no files."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, assert_never

import numpy as np
from numpy.typing import NDArray

from atomsim.core.forces import quantise
from atomsim.core.model import Floats
from atomsim.errors import InputError

Vector: TypeAlias = tuple[float, float, float]

AZIMUTH, ELEVATION = 30.0, 20.0
"""Where the viewer stands where nobody said and nothing speaks for another place [degrees]."""

EYE_DISTANCE = 5.0
"""Distance of the eye in widths of the picture, where no field of view is asked for: near enough to tell front from
back, far enough to keep balls round."""

CLOSEST_EYE, CLOSEST_WIDE_EYE = 10.0, 3.0
"""The eye is never nearer to the middle of the picture than this [length], so a close-up does not enter its ball; nor
nearer than the second where a field of view is asked for."""

WIDEST = 120.0
"""No picture has a wider field of view than this [degrees]."""

FARTHEST = 1e9
"""A coordinate beyond this is no place in a scene any more [length]."""

NARROWEST = 1e-3
"""No picture shows less than this [length]."""


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product of two vectors."""
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product of two vectors."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a: Vector) -> Vector:
    """Return the direction of a vector that is not zero."""
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length)


@dataclass(frozen=True, slots=True)
class View:
    """From where and how large a scene is looked at; `fit` finds what is None.

    Attributes:
        azimuth: direction of the viewer about the up axis [degrees]. At 0 the viewer stands on the axis that follows
            `up` in the cycle x, y, z, x; the angle grows towards the one after that. So with z up, 0 is a viewer on
            +x and 90 one on +y; with y up, 0 is a viewer on +z who has +x to the right.
        elevation: height of the viewer above the horizontal [degrees].
        up: the axis that points up in the picture.
        look_at: the point in the middle of the picture [length].
        width: the width that the picture shows at `look_at` [length].
        field_of_view: the angle that the width takes [degrees]; 0 for parallel rays, None for slight perspective.

    Raises:
        InputError: a number is not finite or beyond all scenes.
    """

    azimuth: float = AZIMUTH
    elevation: float = ELEVATION
    up: Literal["x", "y", "z"] = "z"
    look_at: Vector | None = None
    width: float | None = None
    field_of_view: float | None = None

    def __post_init__(self) -> None:
        for name, angle in (("azimuth", self.azimuth), ("elevation", self.elevation)):
            if not math.isfinite(angle):
                raise InputError(f"camera: {name} must be a finite number of degrees (got {angle:g})")
        if self.look_at is not None and not all(abs(coordinate) <= FARTHEST for coordinate in self.look_at):
            raise InputError(f"camera: look_at must be within ±{FARTHEST:g} (got {list(self.look_at)})")
        if self.width is not None and not NARROWEST <= self.width <= FARTHEST:
            raise InputError(f"camera: width must be from {NARROWEST:g} to {FARTHEST:g} (got {self.width:g})")

        if self.field_of_view is not None and not 0.0 <= self.field_of_view <= WIDEST:
            raise InputError(f"camera: field_of_view must be from 0 to {WIDEST:g} (got {self.field_of_view:g})")

    @property
    def eye_distance(self) -> float:
        """Distance of the eye in widths of the picture; infinite where rays are parallel."""
        if self.field_of_view is None:
            return EYE_DISTANCE
        half = quantise(math.tan(math.radians(self.field_of_view) / 2))
        return 0.5 / half if half else math.inf

    def axes(self) -> tuple[Vector, Vector, Vector]:
        """Return the directions right and up in the picture and back to the viewer, as unit vectors in space."""
        cos_azimuth, sin_azimuth = _turn(self.azimuth)
        cos_elevation, sin_elevation = _turn(self.elevation)
        vertical = "xyz".index(self.up)

        def in_space(first: float, second: float, height: float) -> Vector:
            at = {(vertical + 1) % 3: first, (vertical + 2) % 3: second, vertical: height}
            return (at[0], at[1], at[2])

        right = in_space(-sin_azimuth, cos_azimuth, 0.0)
        up = in_space(-sin_elevation * cos_azimuth, -sin_elevation * sin_azimuth, cos_elevation)
        back = in_space(cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation)
        return right, up, back

    @property
    def vertical(self) -> Vector:
        """The up axis of the scene as a unit vector."""
        return (float(self.up == "x"), float(self.up == "y"), float(self.up == "z"))


def direction_of(
    name: Literal["front", "side", "top"] | None,
    azimuth: float | None,
    elevation: float | None,
    up: Literal["x", "y", "z"],
) -> tuple[float, float]:
    """Return azimuth and elevation of a direction by name, or else these, as usual where they are None [degrees].

    From the front, x points right (y, if x is up); from the side, the viewer stands where that points; from the top,
    right is as from the front.
    """
    front = 0.0 if up == "y" else -90.0
    match name:
        case "front":
            return front, 0.0
        case "side":
            return front + 90.0, 0.0
        case "top":
            return front, 90.0
        case None:
            return AZIMUTH if azimuth is None else azimuth, ELEVATION if elevation is None else elevation
        case _:
            assert_never(name)


def _turn(degrees: float) -> tuple[float, float]:
    angle = math.radians(math.remainder(degrees, 360.0))
    return quantise(math.cos(angle)), quantise(math.sin(angle))


@dataclass(frozen=True, slots=True)
class Camera:
    """A view with nothing left open.

    Camera coordinates have their origin at `centre`; x points right, y up and z to the viewer. The ray of sight
    through the point (x, y, 0) passes (x·(1 − s·z), y·(1 − s·z), z), where s is `convergence`. With s = 0 the rays
    are parallel; otherwise they meet in the eye at z = 1/s. So one formula serves both kinds of projection.

    Attributes:
        centre: the point in the middle of the picture [length].
        right, up, back: unit vectors in space.
        vertical: the up axis of the scene, where the light comes from, as a unit vector in space.
        width: what the picture shows at `centre` [length].
        convergence: s [1/length].
    """

    centre: Vector
    right: Vector
    up: Vector
    back: Vector
    vertical: Vector
    width: float
    convergence: float

    @classmethod
    def of(cls, view: View, centre: Vector, width: float) -> Camera:
        """Return the camera of a view that has `centre` in the middle and shows `width` there [length]."""
        closest = CLOSEST_EYE if view.field_of_view is None else CLOSEST_WIDE_EYE
        return cls(centre, *view.axes(), view.vertical, width, 1.0 / max(view.eye_distance * width, closest))

    def see(self, position: Floats) -> Floats:
        """Return positions in camera coordinates.

        Args:
            position: points in space [length], (n, 3) float64.

        Returns:
            x, y and z as rows, (3, n) float64. No BLAS is involved, so every machine gives the same bits.
        """
        x, y, z = (position[:, axis] - self.centre[axis] for axis in range(3))
        return np.stack([(x * axis[0] + y * axis[1]) + z * axis[2] for axis in (self.right, self.up, self.back)])

    def place(self, seen: Vector) -> Vector:
        """Return the point in space of a point in camera coordinates."""
        x, y, z = (
            self.centre[axis] + dot(seen, (self.right[axis], self.up[axis], self.back[axis])) for axis in range(3)
        )
        return (x, y, z)

    def direction(self, towards: Vector) -> Vector:
        """Return a direction in space in camera coordinates."""
        return (dot(towards, self.right), dot(towards, self.up), dot(towards, self.back))


def is_before_eye(seen: Floats, convergence: float) -> NDArray[np.bool_]:
    """Tell which unit balls lie wholly before the eye, (n,) bool; no others can be drawn."""
    return np.asarray(1.0 - convergence * seen[2] > 1.5 * convergence)


def outline(seen: Floats, convergence: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Return what every unit ball covers of the picture plane: lowest x, highest x, lowest y, highest y.

    A ray through x touches the ball, seen from above, where (x·k − cx)² = 1 + s²·x² with k = 1 − s·cz; the roots
    of this quadratic are the bounds, likewise for y.

    Args:
        seen: centres in camera coordinates, in front of the eye, (3, n) float64.
        convergence: s of the camera.
    """
    nearness = 1.0 - convergence * seen[2]
    divisor = nearness * nearness - convergence * convergence
    bounds = []
    for along in (seen[0], seen[1]):
        middle = nearness * along
        half = np.sqrt(divisor + (convergence * along) * (convergence * along))
        bounds += [(middle - half) / divisor, (middle + half) / divisor]
    return bounds[0], bounds[1], bounds[2], bounds[3]
