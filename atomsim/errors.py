"""Every error a user can cause, with the exit code it ends in; knows nothing of scenes or arrays."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path


def command(words: str, path: Path) -> str:
    """Return a command on a file as it can be pasted into a shell, whatever the file is called.

    >>> command("render", Path("my run.h5")), command("render", Path("-x.h5"))
    ("atomsim render 'my run.h5'", 'atomsim render ./-x.h5')
    """
    name = str(path)
    return f"atomsim {words} {shlex.quote(f'./{name}' if name.startswith('-') else name)}"


class AtomsimError(Exception):
    """An error with a message for the user; the command line prints the message and exits with `exit_code`.

    An error may travel (pickled to another process, copied), so `args` are always what its class is called with.
    """

    exit_code = 1


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

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__(self.problems)

    def __str__(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)
