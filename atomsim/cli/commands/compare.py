"""`atomsim compare`: whether two runs are the same, and where they part."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.options import number
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained


@explained(
    """
    Say whether two trajectories are identical.

    If they are not, say where and by how much they first differ; exit code 1.

    Example:

    atomsim compare a.h5 b.h5 --tolerance 1e-9
    """
)
def compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="A trajectory.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another trajectory of the same atoms.")],
    tolerance: Annotated[
        float,
        typer.Option(
            metavar="DIFFERENCE",
            parser=number("--tolerance", 0.0),
            help="How far numbers may be apart; 0 compares bits.",
        ),
    ] = 0.0,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks.compare import first_difference
    from atomsim.trajectory import Trajectory

    with Trajectory(first) as one, Trajectory(second) as other:
        for notice in (*one.notices(), *other.notices()):
            tell(with_remedies(notice))
        if one.header.n_atoms != other.header.n_atoms:
            say(f"different: {first} has {one.header.n_atoms} atoms, {second} {other.header.n_atoms}")
            raise typer.Exit(1)
        with Progress("frame") as progress:
            difference = first_difference(progress.over(one), other, one.header.groups, tolerance)
        if difference is not None:
            say(f"different: {difference}")
            raise typer.Exit(1)
        within = f" within {tolerance:g}" if tolerance else ""
        say(f"identical{within}: {len(one)} frames up to round {one.rounds[-1]}")
