"""Every error a user can cause: the facts, what would help, and the exit code it ends in."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

RemedyKind: TypeAlias = Literal[
    "replace",
    "rename",
    "run",
    "go on",
    "begin",
    "recover",
    "more rounds",
    "lose additions",
    "new file",
    "show scene",
    "record golden",
    "numpy",
    "standard input",
]


@dataclass(frozen=True, slots=True)
class Remedy:
    """What would help: whoever speaks to the user knows how it is done, the command line with options and commands.

    Attributes:
        kind: what to do.
        path: the file to do it with, if there is one.
    """

    kind: RemedyKind
    path: Path = Path()


@dataclass(frozen=True, slots=True)
class Notice:
    """Something that a user should know although it is no error; `str()` states it, without the remedies."""

    message: str
    remedies: tuple[Remedy, ...] = ()

    def __str__(self) -> str:
        return self.message


class AtomsimError(Exception):
    """An error that a user can cause.

    It may travel (pickled to another process, copied), so `args` are always what its class is called with.

    Args:
        message: the facts.
        remedies: what would help, where the message does not say it.

    Attributes:
        remedies: as given.
        exit_code: what the command line ends with, having printed the message and how the remedies are typed.
    """

    exit_code = 1

    def __init__(self, message: object, *remedies: Remedy) -> None:
        super().__init__(message, *remedies)
        self.remedies = remedies

    def __str__(self) -> str:
        return str(self.args[0])


class RunError(AtomsimError):
    """The run failed for a reason outside the scene: disk, memory, a file held by someone else (exit code 1)."""


class InputError(AtomsimError):
    """Bad usage or bad input: a path, an option, a file that is not ours (exit code 2)."""

    exit_code = 2


class BlowUpError(AtomsimError):
    """The numbers of a simulation left the finite (exit code 3)."""

    exit_code = 3


@dataclass(frozen=True, slots=True)
class Mark:
    """A place in a text that a person wrote: file as they named it, line and column counted from 1.

    Line 0 means the whole of it: a file that cannot be read, a setting on the command line.
    """

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}" if self.line else self.file


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake in a scene: where it stands, the dotted path of the value, and what is wrong with the remedy."""

    mark: Mark
    path: str
    message: str

    def __str__(self) -> str:
        return f"{self.mark}: {self.path}: {self.message}" if self.path else f"{self.mark}: {self.message}"


class SceneError(InputError):
    """A scene with mistakes; carries all of them, in the order of the file (exit code 2)."""

    def __init__(self, problems: Iterable[Problem], *remedies: Remedy) -> None:
        self.problems = tuple(problems)
        super().__init__(self.problems, *remedies)

    def __str__(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)
