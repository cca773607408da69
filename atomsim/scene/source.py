"""Where a scene came from: its text and the place of every value; knows nothing of what the values mean."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from atomsim.errors import Mark, Problem
from atomsim.scene.mistakes.wording import readable

KeyPath: TypeAlias = tuple[str | int, ...]
"""The keys and list indices that lead to a value: `("bonds", "right", "rule")`."""


def dotted(path: KeyPath) -> str:
    """Write a path the way users do: `forces.weight.impulse.2`."""
    return ".".join(readable(str(part)) for part in path)


@dataclass(frozen=True, slots=True)
class Source:
    """The text that a scene was read from.

    Attributes:
        name: the file as the user named it, or `<scene>` for a scene built in Python.
        text: the resolved scene (after `extends` and `--set`) as YAML; reading it gives the same scene.
        overrides: the `PATH=VALUE` settings that were applied, as written.
        marks: the place of every value, by path, in whichever file it was written; the mark of a mapping entry
            is that of its key.
    """

    name: str = "<scene>"
    text: str = ""
    overrides: tuple[str, ...] = ()
    marks: Mapping[KeyPath, Mark] = field(default_factory=dict)

    def mark(self, path: KeyPath) -> Mark:
        """Return the place of a value, or of the nearest enclosing value that was written down."""
        for length in range(len(path), -1, -1):
            mark = self.marks.get(path[:length])
            if mark is not None:
                return mark
        return Mark(self.name, 1, 1)

    def problem(self, path: KeyPath, message: str) -> Problem:
        """Describe a mistake in the value at a path."""
        return Problem(self.mark(path), dotted(path), message)
