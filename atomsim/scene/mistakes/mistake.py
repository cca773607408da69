"""Mistakes of a scene on their way to the user: put in order, and of very many only the first are told."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from atomsim.errors import Mark, Problem
from atomsim.scene.mistakes.wording import printable
from atomsim.scene.source import KeyPath, Source, dotted

MOST_TOLD = 100
"""Further mistakes are counted, not told."""


@dataclass(frozen=True, slots=True)
class Mistake:
    """A mistake, found but not yet put into words: that takes time, and of a hundred thousand most are only counted."""

    mark: Mark
    path: KeyPath
    word: Callable[[], str]


def told(mistakes: Iterable[Mistake], source: Source) -> list[Problem]:
    """Put the first mistakes into words, those of the file itself before those of the files it extends."""
    own = printable(source.name)

    def place(mistake: Mistake) -> tuple[bool, str, int, int]:
        mark = mistake.mark
        return mark.file != own, mark.file, mark.line, mark.column

    ordered = sorted(mistakes, key=place)
    problems = [Problem(mistake.mark, dotted(mistake.path), mistake.word()) for mistake in ordered[:MOST_TOLD]]
    return [*problems, *_and_more(len(ordered), source.mark(()))]


def first_of(problems: list[Problem], whole: Mark) -> list[Problem]:
    """Return the first problems, and at the mark of the whole how many there are besides."""
    return [*problems[:MOST_TOLD], *_and_more(len(problems), whole)]


def _and_more(n_found: int, whole: Mark) -> list[Problem]:
    more = n_found - MOST_TOLD
    return [Problem(whole, "", f"and {more} more mistakes")] if more > 0 else []
