"""Forces: what acts from outside. One class per kind; knows no atoms, only selections."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from atomsim.scene.language.base import (
    Axis,
    Begin,
    Declaration,
    Number,
    Rest,
    Round,
    Selection,
    Target,
    Towards,
    Vector,
    refuse_together,
    require_one,
)


class ForceBase(Declaration):
    """What every force has besides its kind."""

    acts_on: Selection = ("all",)
    """The atoms that feel it."""


class Damping(ForceBase):
    """Resistance against motion."""

    kind: Literal["damping"]
    """Impulse −m · v per round."""
    coefficient: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False), Begin(0.01)]
    """m, the share of the velocity that is lost per round, from 0 to 1."""


class Gravity(ForceBase):
    """The same impulse in every round."""

    kind: Literal["gravity"]
    """A constant impulse per round."""
    impulse: Annotated[Vector, Begin([0, 0, -0.001])]
    """The impulse per round [velocity]."""


class Push(ForceBase):
    """An impulse for a while."""

    kind: Literal["push"]
    """The same impulse in every round, or one `towards` something, while from_round ≤ round < until_round."""
    impulse: Annotated[Vector | None, Begin([0.01, 0, 0])] = None
    """The impulse per round [velocity]; or say `towards` and `magnitude`."""
    towards: Towards | None = None
    """Where each atom is pushed: a point [x, y, z], or a selection, whose centroid it is in every round."""
    magnitude: Number | None = None
    """With `towards`: the size of the impulse per round [velocity]; below zero it pushes away."""
    from_round: Round = 0
    """The first round that pushes."""
    until_round: Round | None = None
    """The first round that no longer pushes; by default it never ends."""

    @model_validator(mode="after")
    def _check_rounds(self) -> Push:
        if self.until_round is not None and self.until_round <= self.from_round:
            raise PydanticCustomError("push_rounds", "`until_round` must be above `from_round`, or nothing is pushed")
        return self

    @model_validator(mode="after")
    def _check_way(self) -> Push:
        require_one(self, "impulse", "towards")
        refuse_together((self.towards is None) != (self.magnitude is None), "`towards` and `magnitude` go together")
        return self


class Hold(ForceBase):
    """A grip that lets nothing change the velocity."""

    kind: Literal["hold"]
    """Exactly opposite to everything else: what rests stays, what moves moves on (a conveyor)."""


class Oscillate(ForceBase):
    """An impulse that swings."""

    kind: Literal["oscillate"]
    """Impulse · sin(2π · round / period + phase) per round."""
    impulse: Annotated[Vector, Begin([0, 0, 0.01])]
    """The largest impulse per round [velocity]."""
    period: Annotated[float, Field(ge=1e-6, allow_inf_nan=False), Begin(200)]
    """Rounds per swing."""
    phase: Number = 0.0
    """Angle at round 0 [radians]."""


class Torque(ForceBase):
    """A turning force."""

    kind: Literal["torque"]
    """Impulses along axis × (c − centre) whose total torque about the axis is `magnitude`."""
    axis: Annotated[Axis, Begin("z")]
    """Direction of the axis: x, y, z or [x, y, z] (right-handed)."""
    magnitude: Annotated[Number, Begin(0.1)]
    """Total torque per round [velocity · length]."""
    about: Selection | None = None
    """The atoms whose centroid is the centre; by default those it acts on."""


class Tether(ForceBase):
    """A bond to a fixed point in space."""

    kind: Literal["tether"]
    """The bond force towards `target`."""
    target: Annotated[Target, Begin("initial")]
    """The fixed point [length]; or `initial`: of each atom the place where it starts, an elastic foundation."""
    rest: Rest = "initial"
    """The desired distance: `initial` (the distance at the start; none from its own place) or a number [length]."""


Force = Annotated[
    Damping | Gravity | Push | Hold | Oscillate | Torque | Tether,
    Field(discriminator="kind"),
]
