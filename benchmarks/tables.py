"""Tables and answers as Markdown, which reads well in a terminal too; knows nothing of what is measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

MISSING = "not installed"


@dataclass(frozen=True, slots=True)
class Table:
    """A caption, the names of the columns, and rows of text; columns after the first are numbers."""

    caption: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    def markdown(self) -> str:
        """Return the table with its caption above, columns aligned."""
        widths = [max(len(row[column]) for row in (self.head, *self.rows)) for column in range(len(self.head))]
        rule = ["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]
        lines = [_line(row, widths) for row in (self.head, rule, *self.rows)]
        return "\n".join([self.caption, "", *lines]) + "\n"


@dataclass(frozen=True, slots=True)
class Answer:
    """A question that the tables have to answer, what was measured, what was aimed at, whether it was reached."""

    question: str
    measured: str
    target: str
    is_reached: bool


def at_least(question: str, value: float, least: float) -> Answer:
    """Answer how many times faster something is."""
    return Answer(question, f"{value:.1f} times", f"≥ {least:g} times", value >= least)


def below(question: str, value: float, most: float, unit: str) -> Answer:
    """Answer how much something takes."""
    return Answer(question, f"{significant(value)} {unit}", f"< {most:g} {unit}", value < most)


def answers_table(answers: Sequence[Answer]) -> Table:
    """Return all answers as a table."""
    rows = [(each.question, each.measured, each.target, "yes" if each.is_reached else "**no**") for each in answers]
    return Table("What was aimed at, and what was measured:", ("question", "measured", "target", "reached"), rows)


def significant(value: float) -> str:
    """Write a number with three digits that mean something.

    >>> significant(7.0213), significant(72.35), significant(222.2), significant(12345.0)
    ('7.02', '72.4', '222', '12,345')
    """
    if value >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    first, *others = (cell.ljust(width) for cell, width in zip(cells[:1], widths[:1], strict=True))
    return "| " + " | ".join([first, *others, *map(str.rjust, cells[1:], widths[1:])]) + " |"
