"""`atomsim render`: trajectories become a picture; knows which rounds to show, not how they are drawn."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

if TYPE_CHECKING:
    from atomsim.render import Row
    from atomsim.scene.language import Render
    from atomsim.trajectory import Trajectory

Part = TypeVar("Part", int, float)

N_FRAMES = 6
"""How many rounds a strip shows where nobody chose."""


def render(
    trajectories: Annotated[list[Path], typer.Argument(metavar="OUT...", help="Trajectories, one row each.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", help="The picture to write: png, jpg, webp, pdf or svg.  [default: OUT with .png]"
        ),
    ] = None,
    rounds: Annotated[
        str | None, typer.Option(metavar="0,250,...", help="The rounds to show, instead of what the scene says.")
    ] = None,
    camera: Annotated[
        str | None, typer.Option(metavar="AZ,EL", help="Direction and height of the viewer [degrees].")
    ] = None,
    size: Annotated[str | None, typer.Option(metavar="WxH", help="Size of one frame [pixels].")] = None,
    frames: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write one PNG per frame into this folder, and no strip."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that atomsim did not draw.")] = False,
) -> None:
    """Draw a strip: frames side by side, a row per trajectory.

    Example:

    atomsim render rods.h5 rod-thread.h5 threads.h5 -o figure1.png
    """
    from contextlib import ExitStack

    from atomsim.errors import InputError
    from atomsim.render import compose, frames_to
    from atomsim.trajectory import Trajectory

    wanted = None if rounds is None else _rounds(rounds)
    angles = None if camera is None else _pair(camera, ",", float, "--camera", "30,20")
    pixels = None if size is None else _pair(size, "x", int, "--size", "640x480")
    picture = trajectories[0].with_suffix(".png") if output is None else output
    if frames is None and picture.exists() and not force:
        raise InputError(f"{picture} exists and atomsim did not draw it; add --force to replace it")
    with ExitStack() as opened:
        rows = []
        for path in trajectories:
            trajectory = opened.enter_context(Trajectory(path))
            if trajectory.from_journal:
                typer.echo(f"{path}: read from its journal; to make the file: atomsim recover {path}", err=True)
            rows.append(_row(trajectory, wanted, angles, every=frames is not None))
        if frames is None:
            compose(rows, picture, pixels)
            print(picture)
        else:
            written = frames_to(rows, frames, pixels)
            print(f"{frames}: {len(written)} pictures, {written[0].name} to {written[-1].name}")


def _row(trajectory: Trajectory, wanted: list[int] | None, angles: tuple[float, float] | None, *, every: bool) -> Row:
    """Choose the frames of one trajectory and from where they are seen."""
    from atomsim.render import Row, View, atom_color
    from atomsim.scene import loads

    header = trajectory.header
    chosen = loads(header.scene, header.scene_name).scene.render
    if wanted is None and every:
        asked = tuple(trajectory.rounds.tolist())
    else:
        asked = _asked(trajectory, wanted, chosen)
    view = View(**chosen.camera.model_dump())
    if angles is not None:
        view = replace(view, azimuth=angles[0], elevation=angles[1])
    title = header.title or header.scene_name
    if trajectory.end.kind == "blew up":
        title += f" — blew up after round {trajectory.rounds[-1]}"
    return Row(
        title=title,
        frames=tuple(trajectory[_nearest(trajectory, round_index)] for round_index in asked),
        color=atom_color(header.groups),
        view=view,
        background=chosen.background,
        asked=asked,
        start=trajectory[0].position,
    )


def _asked(trajectory: Trajectory, wanted: list[int] | None, chosen: Render) -> tuple[int, ...]:
    """Return the rounds to show: as asked for, else as the scene says as far as the run went, else evenly spread."""
    from atomsim.errors import InputError

    last = int(trajectory.rounds[-1])
    if wanted is not None:
        too_late = [round_index for round_index in wanted if round_index > last]
        if too_late:
            raise InputError(f"{trajectory.path}: there is no round {too_late[0]}; it ends at round {last}")
        return tuple(wanted)
    if chosen.rounds is not None:
        reached = tuple(round_index for round_index in chosen.rounds if round_index <= last)
        return reached if len(reached) == len(chosen.rounds) else (*reached, last)
    recorded = trajectory.rounds
    places = sorted({place * (len(recorded) - 1) // (N_FRAMES - 1) for place in range(N_FRAMES)})
    return tuple(int(recorded[place]) for place in places)


def _nearest(trajectory: Trajectory, round_index: int) -> int:
    """Return the index of the frame recorded nearest to a round, the earlier of two."""
    distance = abs(trajectory.rounds - round_index)
    return int(distance.argmin())


def _rounds(text: str) -> list[int]:
    """Read `0,250,500`."""
    from atomsim.errors import InputError

    try:
        rounds = [int(part) for part in text.split(",")]
    except ValueError:
        rounds = [-1]
    if any(round_index < 0 for round_index in rounds):
        raise InputError(f"--rounds needs whole numbers with commas between, as in 0,250,500 (got {text})")
    return rounds


def _pair(text: str, separator: str, kind: type[Part], option: str, example: str) -> tuple[Part, Part]:
    """Read two numbers."""
    from atomsim.errors import InputError

    try:
        first, second = (kind(part) for part in text.lower().split(separator))
    except ValueError:
        raise InputError(f"{option} needs two numbers, as in {example} (got {text})") from None
    return first, second
