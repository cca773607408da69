"""`atomsim check`: the mistakes of scenes, or what they would run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell


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
            tell(with_remedies(error))
        else:
            scene = loaded.scene
            say(f"{path}: {scene.title}" if scene.title else str(path))
            say("\n".join(describe_model(model, state, scene.rounds, scene.record_every)))
            beyond = [shown for shown in scene.render.rounds or () if shown > scene.rounds]
            if beyond:
                say(f"  warning: render.rounds: there is no round {beyond[0]}; the run ends at {scene.rounds}")
    if n_wrong:
        raise typer.Exit(2)
