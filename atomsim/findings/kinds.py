"""The kinds of findings: how sure each is, and what it only follows from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

Level: TypeAlias = Literal["warning", "note"]
"""A `warning` is nearly always a fault; a `note` is a fact that may be meant."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of finding.

    Attributes:
        level: how sure it is to be a fault.
        is_mechanical: whether its remedy can be applied without asking: it deletes no part, and guesses nothing.
        follows_from: kinds of which this one is a mere consequence, each with the section of the scene in which both
            must name the same: it is not told twice.
    """

    level: Level
    is_mechanical: bool = False
    follows_from: Mapping[str, str] = field(default_factory=dict)


ASTRAY = ("unsupported", "too-late", "hole", "tunnelling", "over-damped", "over-stiff", "weld", "blow-up", "hovers")
"""Who is said to go astray in one of these ways is not said to have missed what it should have touched as well."""

CRUSHED = ("floppy", "prestressed", "overpowered", "blow-up")
"""What is crushed in one of these ways is not said to pass through itself as well."""

KINDS: dict[str, Kind] = {
    "ghost-contact": Kind(
        "warning", is_mechanical=True, follows_from=dict.fromkeys(("overpowered", "blow-up"), "groups")
    ),
    "self-pass": Kind("warning", follows_from=dict.fromkeys(CRUSHED, "groups")),
    "tunnelling": Kind("warning", is_mechanical=True),
    "hole": Kind("warning", is_mechanical=True),
    "floppy": Kind("warning", is_mechanical=True, follows_from={"in-pieces": "groups", "rule-misses-group": "groups"}),
    "loose-joint": Kind("note", follows_from={"in-pieces": "groups", "rule-misses-group": "groups"}),
    "in-pieces": Kind("warning", is_mechanical=True),
    "rule-misses-group": Kind("warning", is_mechanical=True),
    "over-stiff": Kind("warning", is_mechanical=True),
    "weld": Kind("warning", is_mechanical=True, follows_from={"prestressed": "bonds"}),
    "declared-twice": Kind("warning", is_mechanical=True),
    "idle": Kind("warning", follows_from={"rule-misses-group": "groups"}),
    "hovers": Kind("warning"),
    "floating-support": Kind("note", is_mechanical=True),
    "unsupported": Kind("warning", follows_from={"ghost-contact": "groups", "hole": "groups", "in-pieces": "groups"}),
    "too-late": Kind("warning", is_mechanical=True, follows_from={"over-damped": "groups"}),
    "force-on-held": Kind("warning"),
    "force-never-acts": Kind("warning"),
    "collision-of-held": Kind("warning"),
    "overlap-at-start": Kind("warning", is_mechanical=True, follows_from={"weld": "collisions"}),
    "prestressed": Kind("warning", is_mechanical=True),
    "never-touches": Kind("warning", follows_from=dict.fromkeys(ASTRAY, "groups")),
    "collision-never": Kind("note", follows_from=dict.fromkeys((*ASTRAY, "never-touches"), "groups")),
    "over-damped": Kind("warning"),
    "symmetric": Kind("warning", is_mechanical=True),
    "coarse-record": Kind("note"),
    "off-camera": Kind("warning", is_mechanical=True),
    "overpowered": Kind(
        "warning",
        follows_from=dict.fromkeys(("prestressed", "tunnelling", "over-stiff", "blow-up", "force-on-held"), "groups"),
    ),
    "energy-grows": Kind("warning"),
    "blow-up": Kind("warning"),
    "left-scene": Kind("note"),
    "restless": Kind("note"),
    "rests-early": Kind("note"),
    "no-such-round": Kind("note", is_mechanical=True),
    "needless-silence": Kind("note"),
}
"""Every kind by its code."""
