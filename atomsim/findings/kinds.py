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
        follows_from: kinds of which this one is a mere consequence, each with the section of the scene in which both
            must name the same: it is not told twice.
    """

    level: Level
    follows_from: Mapping[str, str] = field(default_factory=dict)


KINDS: dict[str, Kind] = {
    "ghost-contact": Kind("warning"),
    "self-pass": Kind("warning"),
    "tunnelling": Kind("warning"),
    "hole": Kind("warning"),
    "floppy": Kind("warning", {"in-pieces": "groups", "rule-misses-group": "groups"}),
    "loose-joint": Kind("note", {"in-pieces": "groups", "rule-misses-group": "groups"}),
    "in-pieces": Kind("warning"),
    "rule-misses-group": Kind("warning"),
    "over-stiff": Kind("warning"),
    "weld": Kind("warning", {"prestressed": "bonds"}),
    "declared-twice": Kind("warning"),
    "idle": Kind("warning"),
    "hovers": Kind("warning"),
    "floating-support": Kind("note"),
    "unsupported": Kind("warning", {"ghost-contact": "groups", "hole": "groups", "in-pieces": "groups"}),
    "too-late": Kind("warning", {"over-damped": "groups"}),
    "force-on-held": Kind("warning"),
    "force-never-acts": Kind("warning"),
    "collision-of-held": Kind("warning"),
    "overlap-at-start": Kind("warning", {"weld": "collisions"}),
    "prestressed": Kind("warning"),
    "never-touches": Kind("warning"),
    "collision-never": Kind("note"),
    "over-damped": Kind("warning"),
    "symmetric": Kind("warning"),
    "coarse-record": Kind("note"),
    "off-camera": Kind("warning"),
    "overpowered": Kind("warning"),
    "energy-grows": Kind("warning"),
    "blow-up": Kind("warning"),
    "left-scene": Kind("note"),
    "restless": Kind("note"),
    "rests-early": Kind("note"),
    "no-such-round": Kind("note"),
    "needless-silence": Kind("note"),
}
"""Every kind by its code."""
