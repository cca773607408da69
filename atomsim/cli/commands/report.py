"""`atomsim report`: what happened in a run, what was expected of it, and what is missing in its scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import output
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained

if TYPE_CHECKING:
    from atomsim.tasks.report import Report


@explained(
    """
    Say what happened in a run, what was expected of it, and what its scene is probably missing.

    With -o it becomes a page to mail (.html), Markdown (.md), or the findings as data (.json).
    docs/findings.md explains every finding.

    Example:

    atomsim report out.h5 -o out.html
    """
)
def report(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="A trajectory.")],
    output: Annotated[Path | None, output("REPORT", "Write a page (.html), Markdown (.md) or data (.json).")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is no report of atomsim's.")] = False,
) -> None:
    from atomsim.tasks import report as reports
    from atomsim.trajectory import Trajectory

    if output is not None:
        reports.check_report(output, replace=force)
    with Trajectory(trajectory) as run:
        for notice in run.notices():
            tell(with_remedies(notice))
        if output is None:
            _print(reports.gather(run))
            return
        written = reports.write_report(run, output)
    say(f"{output}: {len(written.findings)} findings")


def _print(found: Report) -> None:
    """Print a report, the most important first."""
    from atomsim.cli.describe import finding_lines

    say(found.title)
    for each in found.findings:
        for line in finding_lines(each):
            say(line)
    for expectation in found.judged:
        say(f"  {'met' if expectation.verdict.is_met else 'NOT MET'}: {expectation}")
    for event in found.events:
        say(f"  round {event.round_index}: {event}")
    for name, value in found.facts.items():
        say(f"  {name:<11}{value}")
