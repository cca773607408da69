"""`atomsim render`: what users type to get pictures, read and handed on."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from atomsim.cli.options import file_to_write, output
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError, Notice, Remedy

Part = TypeVar("Part", int, float)

Output = Annotated[
    Path | None, output("PICTURE", "The picture to write: png, jpg, webp, pdf or svg.  [default: OUT with .png]")
]


@explained(
    """
    Draw a strip: frames side by side, a row per trajectory.

    Example:

    atomsim render rods.h5 rod-thread.h5 threads.h5 -o figure1.png
    """
)
def render(
    trajectories: Annotated[list[Path], typer.Argument(metavar="OUT", help="Trajectories, one row each.")],
    output: Output = None,
    rounds: Annotated[
        str | None,
        typer.Option(
            metavar="0,250,...",
            help="The rounds to show, instead of what the scene says; 0-2000:100 is every hundredth from 0 to 2000, "
            "0-2000 every recorded one, and -20 the last twenty recorded.",
        ),
    ] = None,
    camera: Annotated[
        str | None, typer.Option(metavar="AZ,EL", help="Direction and height of the viewer [degrees].")
    ] = None,
    size: Annotated[str | None, typer.Option(metavar="WxH", help="Size of one frame [pixels].")] = None,
    frames: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            parser=file_to_write("--frames"),
            help="Write one PNG per frame into this folder, and no strip.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that atomsim did not draw.")] = False,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks import render as pictures

    if frames is not None and output is not None:
        raise InputError("--frames writes pictures into its folder, and no strip; -o does not go with it")
    angles = None if camera is None else pair(camera, ",", float, "--camera", "30,20")
    pixels = None if size is None else pair(size, "x", int, "--size", "640x480")
    if frames is not None:
        if not force:
            _require_own(frames.glob("*round-*.png"))
        with Progress("picture") as progress:
            written = pictures.render_frames(
                trajectories,
                frames,
                rounds=rounds,
                camera=angles,
                size=pixels,
                notice=_notice,
                report=progress.report,
            )
        say(f"{frames}: {len(written)} pictures, {written[0].name} to {written[-1].name}")
        return
    first = trajectories[0]
    picture = output or (first.with_suffix(".png") if first.name else first)  # a folder is told of when it is read
    if not force:
        _require_own([picture])
    with Progress("picture") as progress:
        pictures.render(
            trajectories,
            picture,
            rounds=rounds,
            camera=angles,
            size=pixels,
            notice=_notice,
            report=progress.report,
        )
    say(str(picture))


def _require_own(pictures: Iterable[Path]) -> None:
    """Refuse to replace what atomsim did not draw."""
    from atomsim.drawing.files import is_our_picture

    for picture in pictures:
        is_free = not picture.exists() or picture.is_dir()  # a folder is told of when it is written
        if not (is_free or (picture.is_file() and is_our_picture(picture))):
            raise InputError(f"{picture} exists and atomsim did not draw it", Remedy("replace"))


def _notice(notice: Notice) -> None:
    tell(with_remedies(notice))


def pair(text: str, separator: str, kind: type[Part], option: str, example: str) -> tuple[Part, Part]:
    """Read two numbers."""
    try:
        first, second = (kind(part) for part in text.lower().split(separator))
    except ValueError:
        raise InputError(f"{option} needs two numbers, as in {example} (got {text})") from None
    return first, second
