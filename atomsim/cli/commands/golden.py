"""`atomsim golden record|check`: golden trajectories of scenes, and why each was recorded."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import Backend, Threads, file_name
from atomsim.cli.remedies import command, typed
from atomsim.cli.scenes import STANDARD_INPUT
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import Command, explained
from atomsim.errors import InputError, RunError

if TYPE_CHECKING:
    from atomsim.core.model import Frame, Model
    from atomsim.scene import LoadedScene

golden = typer.Typer(help="Record what scenes give, and check that they still do.")

Scenes = Annotated[list[Path], typer.Argument(metavar="SCENE", help="Scenes, YAML files.")]
Folder = Annotated[
    Path | None,
    typer.Option(
        "--into",
        metavar="FOLDER",
        parser=file_name("--into"),
        help="The folder of the goldens.  [default: golden, beside each scene]",
    ),
]
Reason = Annotated[str, typer.Option(metavar="WHY", help="Why the goldens change; goes into the log.")]


@golden.command(cls=Command)
@explained(
    """
    Record what scenes give now. A golden that exists is replaced only for a reason, which is logged.

    Example:

    atomsim golden record scenes/rods.yaml --into tests/golden --reason "new law"
    """
)
def record(scenes: Scenes, into: Folder = None, reason: Reason = "") -> None:
    from atomsim.tasks.golden import LOG, record_golden, write_golden

    loaded = _loaded(scenes)
    paths = _paths(scenes, into)
    twice = next((path for number, path in enumerate(paths) if path in paths[:number]), None)
    if twice is not None:
        raise InputError(f"two of these scenes would share the golden {twice}; record them into different folders")
    reason = " ".join(reason.split())
    existing = [path for path in paths if path.exists()]
    if existing and not reason:
        raise InputError(f"{existing[0]} exists; say why it changes with --reason")
    for scene, inside, path in zip(scenes, loaded, paths, strict=True):
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with _computed(inside) as (_, frames):
                made = record_golden(frames)
            last_round, digest = list(made.digests.items())[-1]
            write_golden(made, path)
            with (path.parent / LOG).open("a", encoding="utf-8", errors="backslashreplace") as log:
                log.write(f"- {scene.stem}: round {last_round} is {digest[:16]}…: {reason or 'first recording'}\n")
        except OSError as error:
            raise RunError(f"{path.parent}: cannot be written: {error.strerror}") from None
        say(f"{path}: {len(made.digests)} digests, {len(made.frames)} frames")


@golden.command(cls=Command)
@explained(
    """
    Run scenes and compare them with their goldens, bit for bit. A missing golden is a failure.

    Exit code 1 if any differs.

    Example:

    atomsim golden check scenes/rods.yaml --into tests/golden
    """
)
def check(scenes: Scenes, into: Folder = None, backend: Backend = "auto", threads: Threads = None) -> None:
    from atomsim.tasks.golden import check_golden, read_golden

    loaded = _loaded(scenes)
    n_wrong = 0
    for scene, inside, path in zip(scenes, loaded, _paths(scenes, into), strict=True):
        if not path.exists():
            n_wrong += 1
            remedy = command("golden record", scene) + ("" if into is None else f" --into {typed(into)}")
            say(f"{scene}: there is no golden {path}; record it with: {remedy}")
            continue
        approved = read_golden(path)
        with _computed(inside, backend, threads) as (model, frames):
            wrong = check_golden(approved, frames, model.groups)
        n_wrong += wrong is not None
        say(f"{scene}: {wrong or f'identical, {len(approved.digests)} rounds'}")
    if n_wrong:
        tell(f"{n_wrong} of {len(scenes)} scenes differ from their goldens")
        raise typer.Exit(1)


def _loaded(scenes: Sequence[Path]) -> list[LoadedScene]:
    """Load all scenes, so that a mistake in one is told before any is computed."""
    from atomsim.scene import load

    if STANDARD_INPUT in scenes:
        raise InputError("a golden is named after the file of its scene, and standard input has no name")
    return [load(scene) for scene in scenes]


def _paths(scenes: Sequence[Path], into: Path | None) -> list[Path]:
    """Return where the goldens of scenes lie, none of them in a file or in the place of something else."""
    from atomsim.disk import check_regular
    from atomsim.tasks.golden import LOG, golden_path

    paths = [golden_path(scene, into) for scene in scenes]
    for path in paths:
        for part in path.parents:
            if part.exists() and not part.is_dir():
                raise InputError(f"{part}: this is a file; give the name of a folder")
        check_regular(path)
        check_regular(path.parent / LOG)
    return paths


@contextmanager
def _computed(
    inside: LoadedScene, backend: str = "auto", threads: int | None = None
) -> Iterator[tuple[Model, Iterator[Frame]]]:
    """Give a scene's model and its frames, computed as they are asked for, while a line tells how far they are."""
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks.prepare import prepare

    prepared = prepare(inside)
    chosen = prepared.choose(backend, threads)
    with Progress() as progress:
        yield prepared.model, prepared.frames(chosen, report=lambda reached: progress.report(reached, prepared.rounds))
