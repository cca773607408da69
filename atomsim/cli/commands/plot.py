"""`atomsim plot`: what users type to see measures as lines, read and handed on."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.options import output, pair
from atomsim.cli.remedies import with_remedies
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError, Notice, Remedy

Output = Annotated[
    Path | None, output("PICTURE", "The picture to write: png, jpg, webp, pdf or svg.  [default: OUT with -plot.png]")
]


@explained(
    """
    Draw measures over rounds, with what happened above them.

    Trajectories come first; several share the charts. docs/measures.md defines all measures and events.

    Example:

    atomsim plot out.h5 "height of ring" "tilt of ring" -o ring.svg
    """
)
def plot(
    arguments: Annotated[
        list[str],
        typer.Argument(
            metavar="OUT... [MEASURE]...",
            help="Trajectories, then what to plot.  [default: height and speed of what moves]",
        ),
    ],
    output: Output = None,
    rounds: Annotated[
        str | None, typer.Option(metavar="0-2000", help="The rounds to plot, written as in render.")
    ] = None,
    size: Annotated[str | None, typer.Option(metavar="WxH", help="Size of the picture [pixels].")] = None,
    events: Annotated[bool, typer.Option("--events/--no-events", help="Say what happened.")] = True,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that atomsim did not draw.")] = False,
) -> None:
    from atomsim.drawing.files import is_our_picture
    from atomsim.tasks import plot as plots

    trajectories, measures = _told_apart(arguments)
    pixels = None if size is None else pair(size, "x", int, "--size", "1280x720")
    first = trajectories[0]
    picture = output or first.with_name(f"{first.stem}-plot.png")
    is_free = not picture.exists() or picture.is_dir()  # a folder is told of when it is written
    if not (is_free or force or (picture.is_file() and is_our_picture(picture))):
        raise InputError(f"{picture} exists and atomsim did not draw it", Remedy("replace"))
    plots.plot(trajectories, picture, measures or None, rounds=rounds, mark_events=events, size=pixels, notice=_notice)
    say(str(picture))


def _told_apart(arguments: list[str]) -> tuple[list[Path], list[str]]:
    """Tell trajectories from measures: the first is a file, and so are those after it that exist or are called so."""
    n_files = 1
    while n_files < len(arguments) and _is_file(arguments[n_files]):
        n_files += 1
    return [Path(text) for text in arguments[:n_files]], arguments[n_files:]


def _is_file(text: str) -> bool:
    from atomsim.trajectory.journal.form import journal_path

    path = Path(text)
    return path.suffix == ".h5" or path.exists() or journal_path(path).exists()


def _notice(notice: Notice) -> None:
    tell(with_remedies(notice))
