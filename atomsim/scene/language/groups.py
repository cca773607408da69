"""Groups: what there is. One class per shape; knows no bonds, collisions or forces."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from atomsim.scene.language.base import (
    Axis,
    AxisLetter,
    Color,
    Count,
    Declaration,
    Number,
    OneOrList,
    Positive,
    Vector,
    as_tuple,
)


class Rotation(Declaration):
    """A turn of the shape about its centroid, before it is placed."""

    axis: Axis
    """Direction to turn about: x, y, z or [x, y, z] (right-handed)."""
    degrees: Number
    """Angle of the turn [degrees]."""


class Spin(Declaration):
    """An initial rotation about the centroid."""

    axis: Axis
    """Direction to spin about: x, y, z or [x, y, z] (right-handed)."""
    rate: Number
    """Angular velocity [radians per unit of time]: each atom starts with rate · axis × (its offset) plus `velocity`."""


Rotations = Annotated[tuple[Rotation, ...], BeforeValidator(as_tuple), OneOrList()]
"""A turn, or a list of turns."""


class GroupBase(Declaration):
    """What every group has besides its shape."""

    centre: Vector = (0.0, 0.0, 0.0)
    """Where the centroid of the shape goes [length]."""
    rotate: Rotations = ()
    """A turn {axis, degrees} about the centroid before placing, or a list of turns, applied in order."""
    velocity: Vector = (0.0, 0.0, 0.0)
    """Initial velocity of every atom [length per unit of time]."""
    spin: Spin | None = None
    """Initial rotation {axis, rate} about the centroid."""
    color: Color | None = None
    """Colour in pictures: a CSS name or #rrggbb; by default each group gets its own. `render.colors` covers it."""


class StringGroup(GroupBase):
    """Atoms along a straight line: rods and threads."""

    shape: Literal["string"]
    """Atoms along a straight line, numbered along it."""
    count: Count
    """Number of atoms."""
    step: Vector
    """From each atom to the next [length]."""


class RingGroup(GroupBase):
    """Atoms evenly spaced on a circle."""

    shape: Literal["ring"]
    """Atoms on a circle, atom i at the angle 2πi/count from the first axis of its plane."""
    count: Count
    """Number of atoms."""
    radius: Positive
    """Radius of the circle through the centres [length]."""
    axis: AxisLetter = "z"
    """The axis through the ring; its plane is x–y for z, x–z for y, y–z for x, angles from the first of the two."""


class PolygonGroup(GroupBase):
    """Atoms along a closed string through corners: triangles and other frames."""

    shape: Literal["polygon"]
    """A closed string through the corners; atoms are numbered along it from the first corner."""
    corners: Annotated[tuple[Vector, ...], Field(strict=False, min_length=3)]
    """Three or more corner points [length]; only their relative places matter, `centre` places the shape."""
    spacing: Positive
    """Distance between neighbours [length]; each side is divided evenly into the nearest whole number of steps."""


class PlaneGroup(GroupBase):
    """Atoms on a flat grid: surfaces."""

    shape: Literal["plane"]
    """A flat grid of nx · ny atoms; the atom at (x, y) has the index nx · y + x."""
    counts: Annotated[tuple[Count, Count], Field(strict=False, title="[nx, ny]")]
    """Numbers of atoms [nx, ny]."""
    step_x: Vector
    """From each atom to the next along the grid's x [length]."""
    step_y: Vector
    """From each atom to the next along the grid's y [length]."""


class BlockGroup(GroupBase):
    """Atoms on a cubic grid: solids and fluids."""

    shape: Literal["block"]
    """A cubic grid of nx · ny · nz atoms; the atom at (x, y, z) has the index (z · ny + y) · nx + x, x fastest."""
    counts: Annotated[tuple[Count, Count, Count], Field(strict=False, title="[nx, ny, nz]")]
    """Numbers of atoms [nx, ny, nz]."""
    spacing: Positive
    """Distance between neighbours along each axis [length]."""


class AtomsGroup(GroupBase):
    """Atoms at written positions."""

    shape: Literal["atoms"]
    """Atoms where you write them, numbered as written."""
    positions: Annotated[tuple[Vector, ...], Field(strict=False, min_length=1)]
    """The centre of each atom [length]."""
    centre: Vector | None = None  # type: ignore[assignment]  # the one shape that may stay where it is
    """Where the centroid of the atoms goes [length]; by default they stay where they are written."""


Group = Annotated[
    StringGroup | RingGroup | PolygonGroup | PlaneGroup | BlockGroup | AtomsGroup,
    Field(discriminator="shape"),
]
