"""Events as records: what happens to parts, and how it is said."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

EventKind: TypeAlias = Literal[
    "first contact",
    "bounce",
    "sticks",
    "separation",
    "falls off",
    "falls through",
    "wraps",
    "entangles",
    "topples",
    "rest",
]

SENTENCES: dict[EventKind, str] = {
    "first contact": "{} touches {}",
    "bounce": "{} bounces off {}",
    "sticks": "{} sticks to {}",
    "separation": "{} leaves {}",
    "falls off": "{} falls off {}",
    "falls through": "{} falls through {}",
    "wraps": "{} wraps around {}",
    "entangles": "{} and {} entangle",
    "topples": "{} topples",
    "rest": "{} comes to rest",
}
"""What is said of each kind, with the names of its groups."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened.

    Attributes:
        round_index: in which round, as far as recorded frames tell.
        kind: what.
        names: to which groups, one or two.
    """

    round_index: int
    kind: EventKind
    names: tuple[str, ...]

    @property
    def order(self) -> tuple[int, int, tuple[str, ...]]:
        """What events are sorted by: their rounds, then one after the other as they can only happen."""
        return self.round_index, list(SENTENCES).index(self.kind), self.names

    def __str__(self) -> str:
        """Say it in words."""
        return SENTENCES[self.kind].format(*self.names)
