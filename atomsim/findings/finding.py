"""A finding, which is what a diagnosis says of a scene, as words for people and as data for programs."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, TypeAlias

from atomsim.findings.kinds import KINDS, Level
from atomsim.scene.source import KeyPath, Source, dotted
from atomsim.scene.yaml.written import to_line

When: TypeAlias = Literal["before", "after"]
"""Whether a finding was made before a run, from the scene alone, or after it."""

Remedy: TypeAlias = Mapping[str, Any]
"""A part of a scene that, laid over it as by `extends`, takes away what was found."""


@dataclass(frozen=True, slots=True)
class Symptom:
    """What a diagnosis saw; which kind it is of, and where the file says so, is added by `finding`.

    Attributes:
        at: the value to look at.
        names: the values that take part, the one to blame first.
        message: what is wrong, with the numbers behind it.
        remedy: what to write instead.
        rounds: the rounds in which it shows, or will show.
    """

    at: KeyPath
    names: tuple[KeyPath, ...]
    message: str
    remedy: Remedy = field(default_factory=dict)
    rounds: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that a scene is probably missing, or does by mistake.

    Attributes:
        code: what kind it is of; `docs/findings.md` has a section of this name.
        level: a `warning` is nearly always a fault; a `note` may be meant.
        when: made before a run or after it.
        names: paths of what takes part, such as `groups.cloth`.
        file: where it is written, or where that is declared which lacks something.
        line: the line of it, from 1; 0 where the whole of a setting is meant.
        rounds: the rounds in which it shows.
        message: what is wrong, with the numbers behind it.
        remedy: YAML to paste: a part of a scene to lay over this one.
    """

    code: str
    level: Level
    when: When
    names: tuple[str, ...]
    file: str
    line: int
    rounds: tuple[int, ...]
    message: str
    remedy: str

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{place}: {self.level}: {self.message} [{self.code}]"

    def as_data(self) -> dict[str, Any]:
        """Return the finding as JSON has it."""
        return asdict(self)


def finding(code: str, when: When, symptom: Symptom, source: Source) -> Finding:
    """Make a finding of what a diagnosis saw.

    Args:
        code: the kind.
        when: made before a run or after it.
        symptom: what was seen.
        source: knows the places of values.
    """
    mark = source.mark(symptom.at)
    names = tuple(dict.fromkeys(dotted(name) for name in symptom.names))
    remedy = "\n".join(_written(symptom.remedy))
    return Finding(code, KINDS[code].level, when, names, mark.file, mark.line, symptom.rounds, symptom.message, remedy)


def _written(remedy: Remedy) -> Iterator[str]:
    """Yield the lines of a remedy as a scene has them: a section, and a line for each name."""
    for section, value in remedy.items():
        if isinstance(value, Mapping):
            yield f"{section}:"
            yield from (f"  {to_line(name)}: {to_line(declaration)}" for name, declaration in value.items())
        else:
            yield f"{section}: {to_line(value)}"


def without_consequences(findings: Sequence[Finding]) -> list[Finding]:
    """Leave out what only follows from another finding about the same part of the scene."""
    told = {(each.code, name) for each in findings for name in each.names}
    return [each for each in findings if not _follows(each, told)]


def _follows(found: Finding, told: Collection[tuple[str, str]]) -> bool:
    return any(
        (cause, name) in told
        for cause, section in KINDS[found.code].follows_from.items()
        for name in found.names
        if name.startswith(f"{section}.")
    )
