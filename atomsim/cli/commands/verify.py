"""`atomsim verify`: whether a trajectory is what the scene inside it gives."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.options import Backend, Threads
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained


@explained(
    """
    Compute a trajectory again and compare, bit for bit.

    It is computed from the scene inside it; positions and velocities are compared. Exit code 1 if it differs.

    Example:

    atomsim verify out.h5
    """
)
def verify(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="A trajectory.")],
    backend: Backend = "auto",
    threads: Threads = None,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks.compare import first_difference
    from atomsim.tasks.prepare import prepare_inside
    from atomsim.trajectory import Trajectory

    with Trajectory(trajectory) as recorded:
        for notice in recorded.notices():
            tell(with_remedies(notice))
        last_round = int(recorded.rounds[-1])
        prepared = prepare_inside(recorded.header, trajectory, last_round)
        chosen = prepared.choose(backend, threads)
        with Progress() as progress:
            computed = prepared.frames(chosen, report=lambda reached: progress.report(reached, last_round))
            difference = first_difference(recorded, computed, recorded.header.groups)
        if difference is not None:
            say(f"different: {difference} (first: the file; second: computed now)")
            raise typer.Exit(1)
        say(f"identical: {len(recorded)} frames up to round {last_round} are what the scene gives")
