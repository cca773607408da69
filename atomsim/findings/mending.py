"""Mending: the remedies of findings joined to one scene that extends the given one."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from atomsim.errors import Mark
from atomsim.findings.finding import Finding
from atomsim.findings.kinds import KINDS
from atomsim.scene.mistakes.wording import printable
from atomsim.scene.yaml.strict_yaml import read_yaml
from atomsim.scene.yaml.written import to_line

Place: TypeAlias = tuple[str, ...]
"""Where a change goes: a section alone, or a section and a name in it."""


@dataclass(slots=True)
class _Change:
    """What stands at a place: a value, or keys of a declaration, or nothing (None), and the findings it answers."""

    value: Any
    answers: list[Finding] = field(default_factory=list)


class Mending:
    """Changes to a scene, collected from findings one after the other.

    Args:
        names: the names that each section of the scene has; a new declaration gets one of its own.
    """

    def __init__(self, names: dict[str, set[str]]) -> None:
        self._names = names
        self._changes: dict[Place, _Change] = {}

    def add(self, findings: Iterable[Finding]) -> bool:
        """Take up every remedy that is mechanical; return whether there was any that is new."""
        n_before = sum(len(change.answers) for change in self._changes.values())
        for found in findings:
            if KINDS[found.code].is_mechanical and found.remedy:
                for place, value in _parts(read_yaml(found.remedy, _nowhere).plain()):
                    self._put(place, value, found)
        return sum(len(change.answers) for change in self._changes.values()) > n_before

    def _put(self, place: Place, value: Any, found: Finding) -> None:
        known = self._changes.get(place)
        if known is not None and self._is_new(place) and known.value != value:
            place = self._unused(place)
            known = None
        if known is None:
            self._changes[place] = _Change(value, [found])
            return
        if any((each.code, each.names) == (found.code, found.names) for each in known.answers):
            return  # it was answered, and did not go
        known.value = _joined(place, known.value, value)
        known.answers.append(found)

    def _is_new(self, place: Place) -> bool:
        """Return whether a place is a declaration that the scene does not have, made by a remedy."""
        return len(place) == 2 and place[0] in self._names and place[1] not in self._names[place[0]]

    def _unused(self, place: Place) -> Place:
        number = 2
        while (place[0], f"{place[1]}_{number}") in self._changes:
            number += 1
        return place[0], f"{place[1]}_{number}"

    def settings(self) -> list[str]:
        """Return the changes as `PATH=VALUE`, to be laid over the scene."""
        return list(self._settings())

    def _settings(self) -> Iterator[str]:
        for place, change in self._changes.items():
            if len(place) == 2 and isinstance(change.value, dict) and not self._is_new(place):
                yield from (f"{'.'.join(place)}.{key}={to_line(value)}" for key, value in change.value.items())
            else:
                yield f"{'.'.join(place)}={to_line(change.value)}"

    def text(self, extended: str) -> str:
        """Return the scene that extends another one, with a comment at every change.

        Args:
            extended: the other scene, as seen from this one.
        """
        name = to_line(extended) if extended.isprintable() else json.dumps(extended)  # which is YAML, too
        lines = ["atomsim: 1", f"extends: {name}"]
        sections = dict.fromkeys(place[0] for place in self._changes)
        for section in sections:
            inside = {place: change for place, change in self._changes.items() if place[0] == section}
            if (section,) not in inside:
                lines.append(f"{section}:")
            for place, change in inside.items():
                indent = "  " * (len(place) - 1)
                lines += [f"{indent}# {printable(_reason(found))}" for found in change.answers]
                lines.append(f"{indent}{to_line(place[-1])}: {to_line(change.value)}")
        return "\n".join(lines) + "\n"


def _nowhere(line: int, column: int) -> Mark:
    return Mark("remedy", line, column)


def _reason(found: Finding) -> str:
    place = f"{found.file}:{found.line}" if found.line else found.file
    return f"{found.code} ({place}): {found.message}"


def _parts(remedy: Any) -> Iterator[tuple[Place, Any]]:
    """Yield the places of a remedy and what to write there."""
    for section, value in remedy.items():
        if isinstance(value, dict):
            yield from (((section, name), inner) for name, inner in value.items())
        else:
            yield (section,), value


def _joined(place: Place, one: Any, other: Any) -> Any:
    """Join two changes of one place: keys together, the smaller time step, else the larger number; nothing wins.

    What was raised to mend one thing (a threshold, a reach, rounds) is not lowered again to mend another.
    """
    if place == ("time_step",):
        return min(one, other)
    if isinstance(one, int | float) and isinstance(other, int | float):
        return max(one, other)
    if isinstance(one, dict) and isinstance(other, dict):
        return one | {key: _joined((*place, key), one.get(key, value), value) for key, value in other.items()}
    return None if one is None or other is None else other
