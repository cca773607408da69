"""The top level of a scene and how it is shown; knows the declarations, not how they compile."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from atomsim.scene.language.base import (
    AxisLetter,
    Begin,
    Color,
    Colors,
    Count,
    Declaration,
    Named,
    NotNegative,
    Number,
    Positive,
    Round,
    Selection,
    Vector,
)
from atomsim.scene.language.expectations import Expectation
from atomsim.scene.language.forces import Force
from atomsim.scene.language.groups import Group
from atomsim.scene.language.rules import Bonds, Collisions
from atomsim.scene.language.silence import Silences


class Jitter(Declaration):
    """A tiny seeded disturbance of the initial positions that breaks symmetry the same way every time."""

    amplitude: Annotated[NotNegative, Begin(1e-9)]
    """Each coordinate moves by a uniform amount within ± this [length]."""
    seed: Round = 1
    """Seed of the random numbers; the same seed gives the same disturbance."""


View = Literal["front", "side", "top"]
"""A direction to look from, by name."""


class Camera(Declaration):
    """From where and how large the strip shows the scene.

    With z up, azimuth 0 is a viewer on +x and 90 one on +y; with y up, on +z and +x; with x up, on +y and +z. Seen from
    the front, x points right (y, if x is up); from the side, the viewer stands where that points; from the top, right
    is as from the front. Where nothing says the azimuth, the main horizontal motion crosses the picture from left to
    right, at most 35 degrees aslant; without such a motion it is 30.

    What `look_at` and `width` leave open is chosen so that all atoms of the rounds shown fit, but for those that have
    left: an atom has left when it is farther outside the box of the scene at its start than the longest side of that
    box. If most atoms have left, the box of the middle eight tenths of the atoms shown takes its place. Nor need those
    fit that stay where they are, farther outside the box of all that moves than its longest side.
    """

    view: View | None = None
    """A direction by name, in place of azimuth and elevation."""
    azimuth: Number | None = None
    """Direction of the viewer about the up axis [degrees]; 0 is on the axis that follows `up` in x, y, z, x."""
    elevation: Number | None = None
    """Height of the viewer above the horizontal [degrees]; by default 20."""
    up: AxisLetter = "z"
    """The axis that points up in the picture."""
    look_at: Vector | None = None
    """The point in the middle of the picture [length]; by default the middle of the atoms that fit."""
    width: Positive | None = None
    """The visible width [length]; by default all atoms shown fit that have not left the scene."""
    follow: Selection | None = None
    """Atoms that stay in the middle of the picture, in place of `look_at`; by default nothing is followed."""
    close_up: Selection | None = None
    """Atoms that fill the picture, in place of `look_at`; by default all that have not left."""
    field_of_view: Annotated[float, Field(allow_inf_nan=False, ge=0, le=120)] | None = None
    """Angle that the width takes [degrees]: 60 is a wide angle, 0 has parallel rays; by default 11.4."""

    @model_validator(mode="after")
    def _one_way_to_say_it(self) -> Camera:
        if self.view is not None and (self.azimuth is not None or self.elevation is not None):
            raise PydanticCustomError("together", "`view` stands for azimuth and elevation; leave one or the other out")
        if sum(one is not None for one in (self.look_at, self.follow, self.close_up)) > 1:
            raise PydanticCustomError("together", "say one of `look_at`, `follow` and `close_up`: where to look")
        return self


def _named_view(value: Any) -> Any:
    return {"view": value} if isinstance(value, str) and value in get_args(View) else value


_CAMERA_SCHEMA = {"anyOf": [{"enum": list(get_args(View))}, {"$ref": "#/$defs/Camera"}]}


class Render(Declaration):
    """How `atomsim render` shows the trajectory; everything has a default."""

    rounds: Annotated[tuple[Round, ...], Field(strict=False, min_length=1)] | None = None
    """The rounds that make the strip; by default the first, the last and four between, closest where most happens."""
    camera: Annotated[Camera, BeforeValidator(_named_view), WithJsonSchema(_CAMERA_SCHEMA)] = Field(
        default_factory=Camera
    )
    """From where the scene is seen; `side` alone is `{view: side}`."""
    colors: Colors = Field(default_factory=dict)
    """Colours by selection, such as `ring[0:5]: gold`. They cover those of groups, later ones earlier: `all` first."""
    background: Color = "#f5f5f7"
    """Colour behind the atoms."""


def _check_version(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise PydanticCustomError("version", "the version of the scene language is 1")
    if value > 1:
        raise PydanticCustomError("version", "this scene needs a newer atomsim; this one reads version 1")
    return value


class Scene(Declaration):
    """A scene: groups of atoms, what binds them, what may collide, what acts from outside."""

    atomsim: Annotated[Literal[1], BeforeValidator(_check_version), Begin(1)]
    """The version of the scene language, which is 1."""
    title: str = ""
    """One line that says what the scene shows."""
    description: str = ""
    """As much as you like to say about it."""
    time_step: Annotated[Positive, Begin(0.02)]
    """τ, by which velocities move positions in each round [time]."""
    rounds: Annotated[Count, Begin(2000)]
    """Iteration rounds to run."""
    record_every: Count = 10
    """A frame is written at round 0, every so many rounds, and at the last round."""
    jitter: Jitter | None = None
    """A seeded disturbance of the initial positions."""
    groups: Annotated[
        Named[Group],
        Field(min_length=1),
        Begin({"rope": {"shape": "string", "count": 10, "step": [1, 0, 0]}}),
    ]
    """What there is, by name; atoms are numbered in order of declaration."""
    bonds: Named[Bonds] = Field(default_factory=dict)
    """What holds together, by name; one force table each."""
    collisions: Named[Collisions] = Field(default_factory=dict)
    """What may touch, by name; one force table each."""
    forces: Named[Force] = Field(default_factory=dict)
    """What acts from outside, by name, applied in order of declaration."""
    expect: Named[Expectation] = Field(default_factory=dict)
    """What should happen, by name; `atomsim test` runs the scene and says what does not."""
    render: Render = Field(default_factory=Render)
    """How `atomsim render` shows the trajectory."""
    silence: Silences = Field(default_factory=dict)
    """Findings that are meant, by code: {because, names} or a list of these."""
