"""`atomsim show`: what is in a trajectory, and the scene that made it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.terminal.output import say
from atomsim.cli.voice import explained

if TYPE_CHECKING:
    from atomsim.trajectory import Trajectory


@explained(
    """
    Say what is in a trajectory, or print the scene that made it.

    Example:

    atomsim show out.h5 --scene > again.yaml
    """
)
def show(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="A trajectory.")],
    scene: Annotated[
        bool, typer.Option("--scene", help="Print the scene that made it, to be run again, and nothing else.")
    ] = False,
) -> None:
    from atomsim import Trajectory
    from atomsim.cli.describe import describe_trajectory

    with Trajectory(trajectory) as frames:
        say(_scene_of(frames) if scene else "\n".join(describe_trajectory(frames)))


def _scene_of(trajectory: Trajectory) -> str:
    """Return the scene that gives this trajectory: the one inside, with the rounds that were asked for."""
    from atomsim.scene import loads
    from atomsim.tasks.recompute import scene_inside

    header = trajectory.header
    loaded = scene_inside(header, trajectory.path)
    if loaded.scene.rounds != header.rounds:
        loaded = loads(header.scene, header.scene_name, [f"rounds={header.rounds}"])
    return loaded.source.text.rstrip("\n")
