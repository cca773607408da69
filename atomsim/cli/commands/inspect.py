"""`atomsim check`, `show` and `schema`: what is in a scene, in a trajectory, in the language."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.terminal.output import say, tell

if TYPE_CHECKING:
    from atomsim.trajectory import Trajectory


def check(
    scenes: Annotated[list[Path], typer.Argument(metavar="SCENE", help="Scenes, YAML files.")],
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE", help="Change a value of the scenes; may be repeated."),
    ] = None,
) -> None:
    """Find the mistakes of scenes, or describe what they would run.

    Every mistake is one line `file:line:column: path: message`; exit code 2 if there is any.

    Example:

    atomsim check scenes/*.yaml
    """

    from atomsim.cli.describe import describe_model
    from atomsim.compiler import compile_scene
    from atomsim.errors import SceneError
    from atomsim.scene import load

    n_wrong = 0
    for path in scenes:
        try:
            loaded = load(path, settings or ())
            model, state = compile_scene(loaded.scene, loaded.source)
        except SceneError as error:
            n_wrong += 1
            tell(str(error))
        else:
            scene = loaded.scene
            say(f"{path}: {scene.title}" if scene.title else str(path))
            say("\n".join(describe_model(model, state, scene.rounds, scene.record_every)))
            beyond = [shown for shown in scene.render.rounds or () if shown > scene.rounds]
            if beyond:
                say(f"  warning: render.rounds: there is no round {beyond[0]}; the run ends at {scene.rounds}")
    if n_wrong:
        raise typer.Exit(2)


def show(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="A trajectory.")],
    scene: Annotated[
        bool, typer.Option("--scene", help="Print the scene that made it, to be run again, and nothing else.")
    ] = False,
) -> None:
    """Say what is in a trajectory, or print the scene that made it.

    Example:

    atomsim show out.h5 --scene > again.yaml
    """
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


def schema() -> None:
    """Print the JSON Schema of the scene language.

    Editors complete and check scenes with it.

    Example:

    atomsim schema > scene.schema.json
    """
    from atomsim.scene.schema import schema_text

    print(schema_text(), end="")
