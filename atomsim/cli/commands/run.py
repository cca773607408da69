"""`atomsim run`: a scene becomes a trajectory, or a trajectory goes on."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import Backend, Settings, Threads, file_name, output, whole_number
from atomsim.cli.remedies import command, in_words
from atomsim.cli.scenes import named_scene
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError, Remedy

if TYPE_CHECKING:
    from atomsim.tasks.run import Outcome

DEFAULT_OUTPUT = Path("out.h5")

Output = Annotated[Path | None, output("OUT", f"The trajectory to write.  [default: {DEFAULT_OUTPUT}]")]
Rounds = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        parser=whole_number("--rounds", 1),
        help="Iteration rounds to run, instead of what the scene says.",
    ),
]


@explained(
    """
    Simulate a scene and record its trajectory.

    Examples:

    atomsim run scenes/rods.yaml -o rods.h5 --set time_step=0.005

    atomsim run --resume rods.h5 --rounds 8000
    """
)
def run(
    scene: Annotated[
        Path | None,
        typer.Argument(metavar="SCENE", help="The scene, a YAML file, or - for standard input.", show_default=False),
    ] = None,
    output: Output = None,
    rounds: Rounds = None,
    settings: Settings = None,
    backend: Backend = "auto",
    threads: Threads = None,
    compress: Annotated[bool, typer.Option("--compress", help="Write a smaller file, slowly.")] = False,
    resume: Annotated[
        Path | None,
        typer.Option(
            metavar="OUT", parser=file_name("--resume"), help="Go on with this trajectory; it holds its scene."
        ),
    ] = None,
    force: Annotated[
        bool,
        typer.Option("--force", help="Replace the trajectory if it exists; with --resume, lose what was added to it."),
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")] = False,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.cli.terminal.signals import wishes_to_stop
    from atomsim.tasks import run as record

    if resume is not None and (output is not None or compress):
        raise InputError("--resume goes on with the file that it names; -o and --compress do not go with it")
    if scene is None and resume is not None and settings:
        raise InputError("--resume goes on with the scene inside the trajectory, which --set cannot change")
    if scene is None and resume is None:
        raise InputError("name a scene to run, as in: atomsim run scenes/rods.yaml")
    started = time.monotonic()
    loaded = None if scene is None else named_scene(scene, settings)
    target = resume or output or DEFAULT_OUTPUT
    with wishes_to_stop(_to_go_on(target)) as wish, Progress(is_shown=False if quiet else None) as progress:

        def report(round_index: int, last_round: int) -> bool:
            progress.report(round_index, last_round)
            return wish.is_wished()

        if resume is not None:
            outcome = record.resume(
                target,
                rounds=rounds,
                scene=loaded,
                replace=force,
                backend=backend,
                threads=threads,
                report=report,
                warn=None if quiet else _warn,
            )
        elif loaded is not None:
            outcome = record.run(
                loaded,
                target,
                rounds=rounds,
                replace=force,
                compress=compress,
                backend=backend,
                threads=threads,
                report=report,
                warn=None if quiet else tell,
            )
    if outcome.warning is not None and not quiet:
        _warn(outcome.warning)
    if wish.signal_number is not None and outcome.end.kind == "interrupted":
        tell(f"stopped after round {outcome.last_round} of {outcome.rounds}; {_to_go_on(outcome.path)}")
        raise typer.Exit(128 + wish.signal_number)
    if not quiet:
        _summarise(outcome, time.monotonic() - started)


def _warn(warning: str) -> None:
    tell(f"warning: {warning}")


def _to_go_on(path: Path) -> str:
    return in_words(Remedy("go on", path))


def _summarise(outcome: Outcome, seconds: float) -> None:
    """Print what was done and what to type next."""
    if outcome.backend is None:
        more = in_words(Remedy("more rounds"))
        say(f"{outcome.path}: complete, it has done {outcome.last_round:,} rounds already; {more}")
        return
    from atomsim.cli.terminal.progress import rate
    from atomsim.core.free_memory import readable_bytes

    n_rounds = outcome.last_round - outcome.first_round
    size = readable_bytes(outcome.path.stat().st_size)
    say(f"{outcome.path}: {n_rounds:,} rounds in {seconds:.2f} s ({rate(n_rounds / seconds)} rounds/s), {size}")
    say(f"computed by {outcome.backend}")
    say(f"digest of round {outcome.last_round}: {outcome.digest}")
    say(f"next: {command('render', outcome.path)}")
