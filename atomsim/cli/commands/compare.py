"""`atomsim compare` and `atomsim verify`: are two runs the same, and is a file what its scene gives."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.options import Backend, Threads
from atomsim.cli.terminal.output import say, tell


def compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="A trajectory.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another trajectory of the same atoms.")],
    tolerance: Annotated[
        float, typer.Option(metavar="DIFFERENCE", min=0.0, help="How far numbers may be apart; 0 compares bits.")
    ] = 0.0,
) -> None:
    """Say whether two trajectories are identical.

    If they are not, say where and by how much they first differ; exit code 1.

    Example:

    atomsim compare a.h5 b.h5 --tolerance 1e-9
    """
    from atomsim.tasks.compare import first_difference
    from atomsim.trajectory import Trajectory

    with Trajectory(first) as one, Trajectory(second) as other:
        for notice in (*one.notices(), *other.notices()):
            tell(notice)
        if one.header.n_atoms != other.header.n_atoms:
            say(f"different: {first} has {one.header.n_atoms} atoms, {second} {other.header.n_atoms}")
            raise typer.Exit(1)
        difference = first_difference(one, other, one.header.groups, tolerance)
        if difference is not None:
            say(f"different: {difference}")
            raise typer.Exit(1)
        within = f" within {tolerance:g}" if tolerance else ""
        say(f"identical{within}: {len(one)} frames up to round {one.rounds[-1]}")


def verify(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="A trajectory.")],
    backend: Backend = "auto",
    threads: Threads = None,
) -> None:
    """Compute a trajectory again and compare, bit for bit.

    It is computed from the scene inside it; positions and velocities are compared. Exit code 1 if it differs.

    Example:

    atomsim verify out.h5
    """
    from atomsim.core.backend import choose
    from atomsim.core.simulate import simulate
    from atomsim.tasks.compare import first_difference
    from atomsim.tasks.recompute import compile_inside
    from atomsim.trajectory import Trajectory

    with Trajectory(trajectory) as recorded:
        for notice in recorded.notices():
            tell(notice)
        header = recorded.header
        _, model, state = compile_inside(header, trajectory)
        last_round = int(recorded.rounds[-1])
        make_stepper = choose(backend, threads, model, last_round).make_stepper
        computed = simulate(model, state, last_round, header.record_every, make_stepper)
        difference = first_difference(recorded, computed, header.groups)
        if difference is not None:
            say(f"different: {difference} (first: the file; second: computed now)")
            raise typer.Exit(1)
        say(f"identical: {len(recorded)} frames up to round {last_round} are what the scene gives")
