"""`atomsim golden record|check`: golden trajectories of scenes, and why each was recorded."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import Backend, Threads
from atomsim.cli.remedies import command
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import Command, explained

if TYPE_CHECKING:
    from collections.abc import Iterator

    from atomsim.core.model import Frame, Model

golden = typer.Typer(help="Record what scenes give, and check that they still do.")

Scenes = Annotated[list[Path], typer.Argument(metavar="SCENE", help="Scenes, YAML files.")]
Folder = Annotated[Path, typer.Option("--into", metavar="FOLDER", help="The folder of the goldens.")]

DEFAULT_FOLDER = Path("tests/golden")


@golden.command(cls=Command)
@explained(
    """
    Record what scenes give now. A golden that exists is replaced only for a reason, which is logged.

    Example:

    atomsim golden record scenes/rods.yaml --into tests/golden --reason "new law"
    """
)
def record(
    scenes: Scenes,
    into: Folder = DEFAULT_FOLDER,
    reason: Annotated[str, typer.Option(metavar="WHY", help="Why the goldens change; goes into the log.")] = "",
) -> None:
    from atomsim.errors import InputError, RunError
    from atomsim.tasks.golden import LOG, golden_path, record_golden, write_golden

    paths = [golden_path(scene, into) for scene in scenes]
    twice = next((path for number, path in enumerate(paths) if path in paths[:number]), None)
    if twice is not None:
        raise InputError(f"two of these scenes would share the golden {twice}; record them into different folders")
    _require_folder(into)
    reason = " ".join(reason.split())
    existing = [path for path in paths if path.exists()]
    if existing and not reason:
        raise InputError(f"{existing[0]} exists; say why it changes with --reason")
    try:
        into.mkdir(parents=True, exist_ok=True)
        for scene in scenes:
            path = golden_path(scene, into)
            _, frames = _computed(scene)
            made = record_golden(frames)
            last_round, digest = list(made.digests.items())[-1]
            write_golden(made, path)
            with (into / LOG).open("a", encoding="utf-8", errors="backslashreplace") as log:
                log.write(f"- {scene.stem}: round {last_round} is {digest[:16]}…: {reason or 'first recording'}\n")
            say(f"{path}: {len(made.digests)} digests, {len(made.frames)} frames")
    except OSError as error:
        raise RunError(f"{into}: cannot be written: {error.strerror}") from None


@golden.command(cls=Command)
@explained(
    """
    Run scenes and compare them with their goldens, bit for bit. A missing golden is a failure.

    Exit code 1 if any differs.

    Example:

    atomsim golden check scenes/rods.yaml --into tests/golden
    """
)
def check(scenes: Scenes, into: Folder = DEFAULT_FOLDER, backend: Backend = "auto", threads: Threads = None) -> None:
    from atomsim.tasks.golden import check_golden, golden_path, read_golden

    _require_folder(into)
    n_wrong = 0
    for scene in scenes:
        path = golden_path(scene, into)
        if not path.exists():
            n_wrong += 1
            remedy = f"{command('golden record', scene)} --into {shlex.quote(str(into))}"
            say(f"{scene}: there is no golden {path}; record it with: {remedy}")
            continue
        model, frames = _computed(scene, backend, threads)
        approved = read_golden(path)
        wrong = check_golden(approved, frames, model.groups)
        n_wrong += wrong is not None
        say(f"{scene}: {wrong or f'identical, {len(approved.digests)} rounds'}")
    if n_wrong:
        tell(f"{n_wrong} of {len(scenes)} scenes differ from their goldens")
        raise typer.Exit(1)


def _require_folder(into: Path) -> None:
    """Refuse to look for goldens in a file, or below one."""
    from atomsim.errors import InputError

    for part in (into, *into.parents):
        if part.exists() and not part.is_dir():
            raise InputError(f"{part}: this is a file; give the name of a folder")


def _computed(scene: Path, backend: str = "auto", threads: int | None = None) -> tuple[Model, Iterator[Frame]]:
    """Return a scene's model and its frames, computed as they are asked for."""
    from atomsim.compiler import compile_scene
    from atomsim.core.backend import choose
    from atomsim.core.simulate import simulate
    from atomsim.scene import load

    loaded = load(scene)
    model, state = compile_scene(loaded)
    rounds = loaded.scene.rounds
    make_stepper = choose(backend, threads, model, rounds).make_stepper
    return model, simulate(model, state, rounds, loaded.scene.record_every, make_stepper)
