"""`atomsim measure`: numbers of a run, or what happened in it, printed or written into a table."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import output
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError, Remedy

if TYPE_CHECKING:
    from atomsim.trajectory import Trajectory

NARROWEST = 12
"""Letters that a printed number takes at least."""

Output = Annotated[Path | None, output("CSV", "Write a table with every digit into this file.")]


@explained(
    """
    Measure a run: print or write numbers over its frames, or what happened.

    docs/measures.md defines all measures and events.

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
            show_default=False,
        ),
    ] = None,
    output: Output = None,
    rounds: Annotated[
        str | None,
        typer.Option(
            metavar="0,250,...",
            help="Measure only the frames nearest to these rounds; 0-2000:100 and -20 as in render.",
        ),
    ] = None,
    events: Annotated[
        bool, typer.Option("--events", help="Say what happened, in place of measures: contacts, bounces, falls.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is no table of atomsim's.")] = False,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks import tables
    from atomsim.trajectory import Trajectory

    if events and (measures or rounds is not None):
        raise InputError("--events looks at all frames; measures and --rounds do not go with it")
    if output is not None:
        tables.check_table(output)
        if output.exists() and not force and not tables.is_our_table(output):
            raise InputError(f"{output} exists and is no table of atomsim's", Remedy("replace"))
    with Trajectory(trajectory) as run:
        for notice in run.notices():
            tell(with_remedies(notice))
        if events:
            _tell_events(run, output)
        elif output is None:
            _print_measures(run, measures, rounds)
        else:
            with Progress("frame") as progress:
                n_rows = tables.write_measures(run, measures, output, rounds, progress.report)
            say(f"{output}: {n_rows} frame{'' if n_rows == 1 else 's'}")


def _tell_events(run: Trajectory, output: Path | None) -> None:
    """Print or write what happened."""
    from atomsim.tasks.measure import events
    from atomsim.tasks.tables import write_events

    found, time_step = events(run), run.header.time_step
    if output is not None:
        write_events(found, time_step, output)
        say(f"{output}: {len(found)} event{'' if len(found) == 1 else 's'}")
        return
    say(f"{'round':>9}  {'time':>10}  event")
    for event in found:
        say(f"{event.round_index:>9}  {event.round_index * time_step:>10.6g}  {event}")


def _print_measures(run: Trajectory, measures: Sequence[str] | None, rounds: str | None) -> None:
    """Print a table, row by row as it is measured."""
    from atomsim.measures.series import columns_of, rows
    from atomsim.tasks.measure import frames_at, resolved

    asked, gauges = resolved(run, measures)
    frames = frames_at(run, rounds)
    columns = columns_of(asked)
    widths = [max(len(name), NARROWEST) for name in columns]
    say("  ".join([f"{'round':>9}", f"{'time':>10}", *map(str.rjust, columns, widths)]))
    for part in rows(run, gauges, frames):
        for round_index, time, values in zip(*(column.tolist() for column in part), strict=True):
            numbers = [f"{value:>{width}.6g}" for value, width in zip(values, widths, strict=True)]
            say("  ".join([f"{round_index:>9}", f"{time:>10.6g}", *numbers]))
