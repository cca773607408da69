"""Events as records: what happens to parts, and how it is said."""

from __future__ import annotations

from collections.abc import Sequence
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


def in_one_sentence(events: Sequence[Event]) -> str:
    """Say several events of the same parts at once.

    >>> met = ("ball", "floor")
    >>> in_one_sentence([Event(8, "first contact", met), Event(8, "bounce", met), Event(8, "separation", met)])
    'ball touches, bounces off, leaves floor'
    """
    parts = [SENTENCES[event.kind].split("{}") for event in events]
    if len(events) == 1 or any(part[0] or part[-1] or len(part) != 3 for part in parts):
        return ", ".join(map(str, events))
    verbs = ", ".join(part[1].strip() for part in parts)
    return f"{events[0].names[0]} {verbs} {events[0].names[1]}"
