"""`atomsim check`: the mistakes of scenes, or what they would run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import Settings
from atomsim.cli.remedies import with_remedies
from atomsim.cli.scenes import check_streams, named_scene
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained

if TYPE_CHECKING:
    from atomsim.findings.finding import Finding


@explained(
    """
    Find the mistakes of scenes, or describe what they would run and say what they are probably missing.

    Every mistake is one line `file:line:column: path: message`; exit code 2 if there is any. What is found in a scene
    without mistakes is a warning, nearly always a fault, or a note, which may be meant; docs/findings.md explains each.

    Example:

    atomsim check scenes/*.yaml
    """
)
def check(
    scenes: Annotated[list[Path], typer.Argument(metavar="SCENE", help="Scenes, YAML files, or - for standard input.")],
    settings: Settings = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print what was found as a list in JSON, and nothing else.")
    ] = False,
) -> None:
    from atomsim.cli.describe import describe_findings, describe_model
    from atomsim.compiler import compile_scene
    from atomsim.errors import SceneError
    from atomsim.findings.before.diagnose import examine

    check_streams(scenes)
    n_wrong = 0
    found: list[Finding] = []
    for path in scenes:
        try:
            loaded = named_scene(path, settings)
            model, state = compile_scene(loaded)
        except SceneError as error:
            n_wrong += 1
            tell(with_remedies(error))
            continue
        scene, examination = loaded.scene, examine(loaded, model, state)
        if as_json:
            found += examination.findings
            continue
        name = loaded.source.name
        say(f"{name}: {scene.title}" if scene.title else name)
        say("\n".join(describe_model(model, state, scene.rounds, scene.record_every)))
        for line in describe_findings(examination):
            say(line)
    if as_json:
        say(json.dumps([each.as_data() for each in found], ensure_ascii=False, indent=1))
    if n_wrong:
        raise typer.Exit(2)
