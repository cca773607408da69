"""`atomsim run` and `atomsim recover`: a scene becomes a trajectory; knows neither the language nor the dynamics."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from atomsim.core.model import Model, State
    from atomsim.trajectory import Recorder

DEFAULT_OUTPUT = Path("out.h5")


def run(
    scene: Annotated[Path | None, typer.Argument(help="The scene, a YAML file.", show_default=False)] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="The trajectory to write.")] = DEFAULT_OUTPUT,
    rounds: Annotated[
        int | None, typer.Option(min=1, help="Iteration rounds to run, instead of what the scene says.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE", help="Change a value of the scene; may be repeated."),
    ] = None,
    compress: Annotated[bool, typer.Option("--compress", help="Write a smaller file, slowly.")] = False,
    resume: Annotated[
        Path | None, typer.Option(metavar="OUT", help="Go on with this trajectory; the scene is inside.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the trajectory if it exists.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")] = False,
) -> None:
    """Simulate a scene and record its trajectory.

    Examples:

    atomsim run scenes/rods.yaml -o rods.h5 --set time_step=0.005

    atomsim run --resume rods.h5 --rounds 8000
    """
    from atomsim.errors import InputError

    if resume is not None:
        if scene is not None or settings or output != DEFAULT_OUTPUT or force or compress:
            raise InputError("--resume takes only --rounds, --backend, --threads and --quiet: the scene is in the file")
        _resume(resume, rounds, quiet)
    elif scene is None:
        raise InputError("name a scene to run, as in: atomsim run scenes/rods.yaml")
    else:
        _begin(scene, output, rounds, settings or [], compress, force, quiet)


def recover(
    trajectory: Annotated[Path, typer.Argument(metavar="OUT", help="The trajectory whose journal is left.")],
) -> None:
    """Build the HDF5 file from the journal of a killed run.

    Example:

    atomsim recover out.h5
    """
    from atomsim.trajectory import Trajectory
    from atomsim.trajectory import recover as rebuild

    rebuild(trajectory)
    with Trajectory(trajectory) as frames:
        print(f"{trajectory}: {len(frames)} frames up to round {frames.rounds[-1]} of {frames.header.rounds}")


def _begin(
    scene: Path, output: Path, rounds: int | None, settings: list[str], compress: bool, force: bool, quiet: bool
) -> None:
    from atomsim.compiler import compile_scene
    from atomsim.scene import load
    from atomsim.trajectory import Header, Recorder

    if rounds is not None:
        settings = [*settings, f"rounds={rounds}"]
    loaded = load(scene, settings)
    model, state = compile_scene(loaded.scene, loaded.source)
    header = Header.of(
        model,
        scene_text=loaded.source.text,
        scene_name=str(scene),
        overrides=loaded.source.overrides,
        rounds=loaded.scene.rounds,
        record_every=loaded.scene.record_every,
        compress=compress,
    )
    with Recorder(output, header, replace=force) as recorder:
        _record(recorder, model, state, is_first_frame_due=True, quiet=quiet)


def _resume(path: Path, rounds: int | None, quiet: bool) -> None:
    from atomsim.compiler import compile_scene
    from atomsim.scene import loads
    from atomsim.trajectory import Recorder

    with Recorder.resume(path, rounds=rounds) as recorder:
        loaded = loads(recorder.header.scene, recorder.header.scene_name)
        model, first = compile_scene(loaded.scene, loaded.source)
        state = first if recorder.state is None else recorder.state
        _record(recorder, model, state, is_first_frame_due=recorder.state is None, quiet=quiet)


def _record(recorder: Recorder, model: Model, state: State, *, is_first_frame_due: bool, quiet: bool) -> None:
    """Run from a state to the planned round, record every frame, and say how it ended."""
    from atomsim.cli.progress import Progress
    from atomsim.cli.signals import wishes_to_stop
    from atomsim.core.simulate import simulate
    from atomsim.errors import BlowUpError
    from atomsim.trajectory import End

    header = recorder.header
    progress = Progress(state.round_index, header.rounds, is_shown=False if quiet else None)
    started = time.monotonic()
    end = End("finished")
    blow_up: BlowUpError | None = None
    reached, digest = state.round_index, ""
    with wishes_to_stop() as wish:

        def report(round_index: int) -> None:
            progress.report(round_index)
            if wish.signal_number is not None:
                raise _StopWishedError

        try:
            for frame in simulate(model, state, header.rounds, header.record_every, report=report):
                if is_first_frame_due or frame.round_index > state.round_index:
                    recorder.append(frame)
                reached, digest = frame.round_index, frame.digest
        except _StopWishedError:
            end = End("interrupted")
        except BlowUpError as error:
            end, blow_up = End("blew up", str(error)), error
        progress.clear()
        recorder.finish(end)
    seconds = time.monotonic() - started
    if blow_up is not None:
        raise BlowUpError(f"{blow_up}\n{recorder.path} keeps the frames up to round {reached}")
    if wish.signal_number is not None:
        print(
            f"stopped after round {reached} of {header.rounds}; to go on: atomsim run --resume {recorder.path}",
            file=sys.stderr,
        )
        raise typer.Exit(128 + wish.signal_number)
    if not quiet:
        _summarise(recorder.path, reached, reached - state.round_index, seconds, digest)


class _StopWishedError(Exception):
    """Leaves the simulation between two rounds."""


def _summarise(path: Path, reached: int, n_rounds: int, seconds: float, digest: str) -> None:
    """Print what was done and what to type next."""
    from atomsim.cli.progress import rate
    from atomsim.core.memory import readable_bytes

    size = readable_bytes(path.stat().st_size)
    print(f"{path}: {reached:,} rounds in {seconds:.2f} s ({rate(n_rounds / max(seconds, 1e-9))} rounds/s), {size}")
    print(f"digest of round {reached}: {digest}")
    print(f"next: atomsim render {path}")
