"""`atomsim check`: the mistakes of scenes, or what they would run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import Settings, file_name
from atomsim.cli.remedies import with_remedies
from atomsim.cli.scenes import STANDARD_INPUT, check_streams, named_scene
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError

if TYPE_CHECKING:
    from atomsim.findings.finding import Finding
    from atomsim.scene import LoadedScene


@explained(
    """
    Find the mistakes of scenes, or describe what they would run and say what they are probably missing.

    Every mistake is one line `file:line:column: path: message`; exit code 2 if there is any. What is found in a scene
    without mistakes is a warning, nearly always a fault, or a note, which may be meant; docs/findings.md explains each.

    Examples:

    atomsim check scenes/*.yaml

    atomsim check hand.yaml --fix mended.yaml
    """
)
def check(
    scenes: Annotated[list[Path], typer.Argument(metavar="SCENE", help="Scenes, YAML files, or - for standard input.")],
    settings: Settings = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print what was found as a list in JSON, and nothing else.")
    ] = False,
    fix: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            parser=file_name("--fix"),
            help="Write a scene that extends SCENE and applies what can be mended.",
        ),
    ] = None,
    modes: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            parser=file_name("--modes"),
            help="Draw how floppy bodies and loose joints can move, a picture for each.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that atomsim did not write.")] = False,
) -> None:
    from atomsim.cli.describe import describe_findings, describe_model
    from atomsim.compiler import compile_scene
    from atomsim.errors import SceneError
    from atomsim.findings.before.diagnose import examine

    check_streams(scenes)
    if modes is not None and len(scenes) != 1:
        raise InputError("--modes goes with one scene")
    if fix is not None and (len(scenes) != 1 or STANDARD_INPUT in scenes or settings or as_json):
        raise InputError("--fix goes with one scene file as it is, without --set and --json")
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
        pictures = _draw_modes(loaded, modes, force)
        if as_json:
            found += examination.findings
            continue
        name = loaded.source.name
        say(f"{name}: {scene.title}" if scene.title else name)
        say("\n".join(describe_model(model, state, scene.rounds, scene.record_every)))
        for line in (*describe_findings(examination), *pictures):
            say(line)
    if fix is not None and not n_wrong:
        _mend(scenes[0], fix, force)
    if as_json:
        say(json.dumps([each.as_data() for each in found], ensure_ascii=False, indent=1))
    if n_wrong:
        raise typer.Exit(2)


def _draw_modes(loaded: LoadedScene, folder: Path | None, replace: bool) -> list[str]:
    """Draw how floppy bodies and loose joints can move, if asked for, and return the names of the pictures."""
    if folder is None:
        return []
    from atomsim.tasks.modes import draw_modes

    drawn = [str(path) for path in draw_modes(loaded, folder, replace=replace)]
    return drawn or [f"nothing here is floppy or loosely joined, so {folder} gets no picture"]


def _mend(scene: Path, target: Path, replace: bool) -> None:
    """Write the mended scene, and say what is gone, what is left and what has come to light."""
    from atomsim.tasks.mend import mend

    mended = mend(scene, target, replace=replace)
    if mended.path is None:
        say(f"nothing that can be mended without asking was found, so {target} is not written")
        return
    say(f"{target}: extends {scene}")
    for label, findings in (("gone", mended.gone), ("left", mended.left)):
        if findings:
            say(f"  {label:<11}{', '.join(f'{each.code} ({each.file}:{each.line})' for each in findings)}")
    for each in mended.new:
        say(str(each))
