"""`atomsim measure`: numbers of a run, printed or written into a table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import output, rounds_in
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError, Remedy

if TYPE_CHECKING:
    from atomsim.measures.series import Rows

NARROWEST = 12
"""Letters that a printed number takes at least."""


@explained(
    """
    Measure a run: print or write numbers over its frames.

    docs/measures.md defines all measures.

    Example:

    atomsim measure out.h5 "height of ring" "gap between ring and surface" -o heights.csv
    """
)
def measure(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="A trajectory.")],
    measures: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="MEASURE",
            help='What to measure, such as "height of ring".  [default: height and speed of what moves]',
        ),
    ] = None,
    output: Annotated[Path | None, output("CSV", "Write a table with every digit into this file.")] = None,
    rounds: Annotated[
        str | None, typer.Option(metavar="0,250,...", help="Measure only the frames nearest to these rounds.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is no table of atomsim's.")] = False,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.measures.series import columns_of
    from atomsim.measures.series import rows as measured_rows
    from atomsim.tasks import measure as tables
    from atomsim.trajectory import Trajectory

    wanted = rounds_in(rounds)
    if output is not None:
        tables.check_table(output)
        if output.exists() and not force and not tables.is_our_table(output):
            raise InputError(f"{output} exists and is no table of atomsim's", Remedy("replace"))
    with Trajectory(trajectory) as run:
        for notice in run.notices():
            tell(with_remedies(notice))
        if output is not None:
            with Progress("frame") as progress:
                n_rows = tables.write_measures(run, measures, output, wanted, progress.report)
            say(f"{output}: {n_rows} frames")
            return
        asked, gauges = tables.resolved(run, measures)
        _print(columns_of(asked), measured_rows(run, gauges, tables.frames_at(run, wanted)))


def _print(columns: Sequence[str], parts: Iterable[Rows]) -> None:
    """Print a table, row by row as it is measured."""
    widths = [max(len(name), NARROWEST) for name in columns]
    say("  ".join([f"{'round':>9}", f"{'time':>10}", *map(str.rjust, columns, widths)]))
    for part in parts:
        for round_index, time, values in zip(*(column.tolist() for column in part), strict=True):
            numbers = [f"{value:>{width}.6g}" for value, width in zip(values, widths, strict=True)]
            say("  ".join([f"{round_index:>9}", f"{time:>10.6g}", *numbers]))
