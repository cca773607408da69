"""The sections of the benchmark in order: what each measures, how it is shown, what it answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from benchmarks import cold_start, fluid_scaling, large_body, measuring, pour, recording, rounds
from benchmarks.tables import Answer, Table
from benchmarks.timing import Results


@dataclass(frozen=True, slots=True)
class Section:
    """Part of the benchmark; `measure` takes whether to be quick, the others what it returned."""

    measure: Callable[[bool], Results]
    tables: Callable[[Results], list[Table]]
    answers: Callable[[Results], list[Answer]]

    def markdown(self, results: Results) -> str:
        """Return its tables."""
        return "\n".join(table.markdown() for table in self.tables(results))


SECTIONS = {
    "rods": Section(partial(rounds.measure, "rods"), rounds.tables, rounds.answers),
    "balls": Section(partial(rounds.measure, "balls"), rounds.tables, rounds.answers),
    "fluid": Section(fluid_scaling.measure, fluid_scaling.tables, fluid_scaling.answers),
    "pour": Section(pour.measure, pour.tables, lambda _: []),
    "cold": Section(cold_start.measure, cold_start.tables, cold_start.answers),
    "recording": Section(recording.measure, recording.tables, recording.answers),
    "measuring": Section(measuring.measure, measuring.tables, measuring.answers),
    "memory": Section(large_body.measure, large_body.tables, large_body.answers),
}


def all_answers(results: Results) -> list[Answer]:
    """Return the answers of all sections that were measured."""
    return [
        answer for name, section in SECTIONS.items() if name in results for answer in section.answers(results[name])
    ]
