"""`atomsim recover`: the HDF5 file of a killed run, from its journal."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.terminal.output import say
from atomsim.cli.voice import explained


@explained(
    """
    Build the HDF5 file from the journal of a killed run.

    Example:

    atomsim recover out.h5
    """
)
def recover(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="The trajectory whose journal is left.")],
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.trajectory import Trajectory
    from atomsim.trajectory import recover as rebuild

    with Progress("frame") as progress:
        rebuild(trajectory, progress.report)
    with Trajectory(trajectory) as frames:
        say(f"{trajectory}: {len(frames)} frames up to round {frames.rounds[-1]} of {frames.header.rounds}")
