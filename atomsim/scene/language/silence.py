"""Silence: findings that a scene means; knows their codes, not what they say."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias, get_args

from pydantic import AfterValidator, BeforeValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from atomsim.scene.language.base import Declaration, OneOrList, as_tuple, drop_nulls
from atomsim.scene.language.names import normalised
from atomsim.scene.mistakes.wording import meant, readable

Code: TypeAlias = Literal[
    "ghost-contact",
    "self-pass",
    "tunnelling",
    "hole",
    "floppy",
    "loose-joint",
    "in-pieces",
    "rule-misses-group",
    "over-stiff",
    "weld",
    "declared-twice",
    "idle",
    "hovers",
    "floating-support",
    "unsupported",
    "too-late",
    "force-on-held",
    "force-never-acts",
    "collision-of-held",
    "overlap-at-start",
    "prestressed",
    "never-touches",
    "collision-never",
    "over-damped",
    "symmetric",
    "coarse-record",
    "off-camera",
    "overpowered",
    "energy-grows",
    "blow-up",
    "left-scene",
    "restless",
    "rests-early",
    "no-such-round",
]
"""What a finding can be called, but for the one that speaks of silences."""

CODES: tuple[Code, ...] = get_args(Code)

_PATTERN = f"^({'|'.join(CODES)})$"


def _check_code(value: str) -> str:
    if value not in CODES:
        message = "there is no finding `{code}`; {remedy}"
        remedy = meant(value, CODES, "the findings are")
        raise PydanticCustomError("code", message, {"code": readable(value), "remedy": remedy})
    return value


def _check_reason(value: str) -> str:
    if not value.strip():
        raise PydanticCustomError("reason", "needs the reason why this is meant")
    return value


class Silence(Declaration):
    """A finding that is meant, and so is not told."""

    because: Annotated[str, AfterValidator(_check_reason)]
    """Why it is meant: for whoever reads the scene later."""
    names: Annotated[
        tuple[Annotated[str, AfterValidator(normalised)], ...], BeforeValidator(as_tuple), OneOrList()
    ] = ()
    """Only findings that mention all these, such as `groups.cloth`; by default every finding of this code."""


Silences = Annotated[
    dict[
        Annotated[str, AfterValidator(_check_code), WithJsonSchema({"type": "string", "pattern": _PATTERN})],
        Annotated[tuple[Silence, ...], BeforeValidator(as_tuple), OneOrList()],
    ],
    BeforeValidator(drop_nulls),
]
"""By the code of a finding: a {because, names}, or a list of these."""
