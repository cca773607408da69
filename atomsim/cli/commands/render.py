"""`atomsim render`: what users type to get pictures, read and handed on."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

from atomsim.cli.options import file_name, number, numbers, output, pair, whole_number
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError, Notice, Remedy

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
        list[str] | None,
        typer.Option(
            metavar="AZ,EL",
            help="Direction and height of the viewer [degrees], or front, side or top; if repeated, a row for each.",
        ),
    ] = None,
    look_at: Annotated[
        str | None, typer.Option(metavar="X,Y,Z", help="The point in the middle of the picture [length].")
    ] = None,
    width: Annotated[
        float | None,
        typer.Option(
            metavar="W", parser=number("--width", 0.0), help="What the picture shows from left to right [length]."
        ),
    ] = None,
    follow: Annotated[
        str | None, typer.Option(metavar="GROUP", help="Atoms that stay in the middle of the picture.")
    ] = None,
    close_up: Annotated[str | None, typer.Option(metavar="GROUP", help="Atoms that fill the picture.")] = None,
    field_of_view: Annotated[
        float | None,
        typer.Option(
            metavar="ANGLE",
            parser=number("--field-of-view", 0.0),
            help="Angle that the width takes [degrees]: 60 is a wide angle, 0 has parallel rays.",
        ),
    ] = None,
    size: Annotated[
        str | None, typer.Option(metavar="WxH", help="Size of one frame [pixels], or on paper, as in 8x6cm.")
    ] = None,
    dpi: Annotated[
        int | None,
        typer.Option(
            metavar="N", parser=whole_number("--dpi", 1), help="Pixels per inch of paper; for a size in cm, 300."
        ),
    ] = None,
    dark: Annotated[bool, typer.Option("--dark", help="Draw for a dark surrounding.")] = False,
    transparent: Annotated[bool, typer.Option("--transparent", help="Draw nothing behind the atoms.")] = False,
    frames: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            parser=file_name("--frames"),
            help="Write one PNG per frame into this folder, and no strip.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that atomsim did not draw.")] = False,
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks import render as pictures

    if frames is not None and output is not None:
        raise InputError("--frames writes pictures into its folder, and no strip; -o does not go with it")
    keys = {"width": width, "follow": follow, "close_up": close_up, "field_of_view": field_of_view}
    wishes: dict[str, Any] = {
        "rounds": rounds,
        "camera": _cameras(camera, look_at, keys),
        "size": size,
        "dpi": dpi,
        "dark": dark,
        "transparent": transparent,
        "notice": _notice,
    }
    if frames is not None:
        if not force:
            _require_own(frames.glob("*round-*.png"))
        with Progress("picture") as progress:
            written = pictures.render_frames(trajectories, frames, **wishes, report=progress.report)
        say(f"{frames}: {len(written)} pictures, {written[0].name} to {written[-1].name}")
        return
    first = trajectories[0]
    picture = output or (first.with_suffix(".png") if first.name else first)  # a folder is told of when it is read
    if not force:
        _require_own([picture])
    with Progress("picture") as progress:
        pictures.render(trajectories, picture, **wishes, report=progress.report)
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


def _cameras(directions: list[str] | None, look_at: str | None, keys: dict[str, Any]) -> list[dict[str, Any]]:
    """Return what is asked of the cameras, one for each direction, or one without."""
    if look_at is not None:
        keys["look_at"] = numbers(look_at, ",", float)
        if len(keys["look_at"]) != 3:
            raise InputError(f"--look-at needs three numbers, as in 0,0,5 (got {look_at})")
    asked = {key: value for key, value in keys.items() if value is not None}
    return [asked | direction for direction in map(_direction, directions or [""])]


def _direction(text: str) -> dict[str, Any]:
    """Read `30,20`, or the name of a direction."""
    if not text or text.strip().isalpha():
        return {"view": text.strip().lower()} if text else {}
    azimuth, elevation = pair(text, ",", float, "--camera", "30,20; or front, side or top")
    return {"azimuth": azimuth, "elevation": elevation}
