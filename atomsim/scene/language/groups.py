"""Groups: what there is. One class per shape; knows no bonds, collisions or forces."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from atomsim.scene.language.base import (
    Axis,
    AxisLetter,
    Begin,
    Color,
    Count,
    Declaration,
    Number,
    OneOrList,
    Positive,
    Vector,
    as_tuple,
    refuse_together,
    require_one,
)


class Rotation(Declaration):
    """A turn of the shape about its centroid, before it is placed."""

    axis: Annotated[Axis, Begin("z")]
    """Direction to turn about: x, y, z or [x, y, z] (right-handed)."""
    degrees: Annotated[Number, Begin(90)]
    """Angle of the turn [degrees]."""


class Spin(Declaration):
    """An initial rotation about the centroid."""

    axis: Annotated[Axis, Begin("z")]
    """Direction to spin about: x, y, z or [x, y, z] (right-handed)."""
    rate: Annotated[Number, Begin(0.5)]
    """Angular velocity [radians per unit of time]: each atom starts with rate · axis × (its offset) plus `velocity`."""


Rotations = Annotated[tuple[Rotation, ...], BeforeValidator(as_tuple), OneOrList()]
"""A turn, or a list of turns."""


class Copies(Declaration):
    """Copies of a group about an axis or along a line, each one a part with a number of its own: `finger.0`."""

    count: Annotated[Count, Begin(3)]
    """How many there are, with the group as written, which is number 0."""
    step: Annotated[Vector | None, Begin([0, 0, 5])] = None
    """Along a line: from each copy to the next [length]."""
    axis: Axis | None = None
    """About an axis: its direction, x, y, z or [x, y, z] (right-handed); velocities turn with the copies."""
    through: Vector | None = None
    """With `axis`: a point that the axis goes through [length]; by default [0, 0, 0]."""
    degrees: Number | None = None
    """With `axis`: angle from each copy to the next [degrees]; by default 360 / count, all the way around."""

    @model_validator(mode="after")
    def _check_way(self) -> Copies:
        require_one(self, "step", "axis")
        is_about_none = self.axis is None and (self.through is not None or self.degrees is not None)
        refuse_together(is_about_none, "`through` and `degrees` go with `axis`")
        return self


CopiesList = Annotated[tuple[Copies, ...], BeforeValidator(as_tuple), OneOrList()]
"""Copies, or a list of copies: copies of the copies before."""


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
    copies: CopiesList = ()
    """Copies {count, step} along a line or {count, axis} about an axis, or a list of these: copies of copies."""
    color: Color | None = None
    """Colour in pictures: a CSS name or #rrggbb; by default each group gets its own. `render.colors` covers it."""


class StringGroup(GroupBase):
    """Atoms along a straight line: rods and threads.

    Say how it runs, by `step` or `to`, and how many atoms it has, by `count` or, between `from` and `to`, `spacing`.
    """

    shape: Literal["string"]
    """Atoms along a straight line, numbered along it."""
    count: Annotated[Count | None, Begin(10)] = None
    """Number of atoms."""
    step: Annotated[Vector | None, Begin([1, 0, 0])] = None
    """From each atom to the next [length]."""
    from_: Annotated[Vector | None, Field(alias="from")] = None
    """The place of the first atom [length], in place of `centre`."""
    to: Vector | None = None
    """The place of the last atom [length]; goes with `from`, in place of `step`."""
    spacing: Positive | None = None
    """Between `from` and `to`: distance between neighbours [length], made to fit a whole number of times."""
    centre: Vector | None = None  # type: ignore[assignment]  # `from` may say where it is
    """Where the centroid of the string goes [length]; by default [0, 0, 0], unless `from` says where it begins."""

    @model_validator(mode="after")
    def _check_way(self) -> StringGroup:
        require_one(self, "step", "to")
        require_one(self, "count", "spacing")
        refuse_together(self.to is not None and self.from_ is None, "`to` goes with `from`")
        refuse_together(self.spacing is not None and self.to is None, "`spacing` goes with `from` and `to`")
        refuse_together(
            self.from_ is not None and self.centre is not None, "`centre` and `from` both say where; write one"
        )
        refuse_together(self.to is not None and self.to == self.from_, "`from` and `to` are the same place")
        refuse_together(self.to is not None and self.count == 1, "from here to there it takes a `count` of 2 or more")
        return self


class RingGroup(GroupBase):
    """Atoms evenly spaced on a circle."""

    shape: Literal["ring"]
    """Atoms on a circle, atom i at the angle 2πi/count from the first axis of its plane."""
    count: Annotated[Count, Begin(20)]
    """Number of atoms."""
    radius: Annotated[Positive, Begin(4)]
    """Radius of the circle through the centres [length]."""
    axis: AxisLetter = "z"
    """The axis through the ring; its plane is x–y for z, x–z for y, y–z for x, angles from the first of the two."""


class PolygonGroup(GroupBase):
    """Atoms along a closed string through corners: triangles and other frames."""

    shape: Literal["polygon"]
    """A closed string through the corners; atoms are numbered along it from the first corner."""
    corners: Annotated[tuple[Vector, ...], Field(strict=False, min_length=3), Begin([[0, 0, 0], [8, 0, 0], [0, 6, 0]])]
    """Three or more corner points [length]; only their relative places matter, `centre` places the shape."""
    spacing: Annotated[Positive, Begin(1)]
    """Distance between neighbours [length]; each side is divided evenly into the nearest whole number of steps."""


class PlaneGroup(GroupBase):
    """Atoms on a flat grid: surfaces."""

    shape: Literal["plane"]
    """A flat grid of nx · ny atoms; the atom at (x, y) has the index nx · y + x."""
    counts: Annotated[tuple[Count, Count], Field(strict=False, title="[nx, ny]"), Begin([12, 8])]
    """Numbers of atoms [nx, ny]."""
    step_x: Annotated[Vector, Begin([2, 0, 0])]
    """From each atom to the next along the grid's x [length]."""
    step_y: Annotated[Vector, Begin([0, 2, 0])]
    """From each atom to the next along the grid's y [length]."""


class BlockGroup(GroupBase):
    """Atoms on a cubic grid: solids and fluids."""

    shape: Literal["block"]
    """A cubic grid of nx · ny · nz atoms; the atom at (x, y, z) has the index (z · ny + y) · nx + x, x fastest."""
    counts: Annotated[tuple[Count, Count, Count], Field(strict=False, title="[nx, ny, nz]"), Begin([4, 4, 4])]
    """Numbers of atoms [nx, ny, nz]."""
    spacing: Annotated[Positive, Begin(1.5)]
    """Distance between neighbours along each axis [length]."""


class BallGroup(GroupBase):
    """Atoms in a ball, or on its surface: balls, heads, loads."""

    shape: Literal["ball"]
    """Atoms on spheres one inside the other, from the one in the middle outwards, each from below to above, z up."""
    radius: Annotated[Positive, Begin(3)]
    """Radius of the outermost sphere, on which atoms have their centres [length]."""
    spacing: Annotated[Positive, Begin(1)]
    """Distance between neighbours, nearly [length]: between spheres, and on each of them."""
    hollow: bool = False
    """Whether there are atoms on the outermost sphere only."""


class AtomsGroup(GroupBase):
    """Atoms at written positions."""

    shape: Literal["atoms"]
    """Atoms where you write them, numbered as written."""
    positions: Annotated[tuple[Vector, ...], Field(strict=False, min_length=1), Begin([[0, 0, 0], [2, 0, 0]])]
    """The centre of each atom [length]."""
    centre: Vector | None = None  # type: ignore[assignment]  # the one shape that may stay where it is
    """Where the centroid of the atoms goes [length]; by default they stay where they are written."""


Group = Annotated[
    StringGroup | RingGroup | PolygonGroup | PlaneGroup | BlockGroup | BallGroup | AtomsGroup,
    Field(discriminator="shape"),
]
