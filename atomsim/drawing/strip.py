"""Frames side by side in one picture, a row per trajectory; knows no trajectory files and no scenes."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

from atomsim.core.model import Floats, Frame
from atomsim.disk import whole_file, write_whole
from atomsim.drawing.camera import View
from atomsim.drawing.files import MARK, check_picture
from atomsim.drawing.framing import fit, is_drawable
from atomsim.drawing.layout import LARGE, Layout, frame_size
from atomsim.drawing.page import FORMATS, Panel, encode
from atomsim.drawing.picture import Pixels, draw
from atomsim.errors import InputError, RunError

_LARGEST = 16000
"""The longest side that all formats can hold [pixels]."""


Paint: TypeAlias = Callable[[Frame], Floats]
"""Gives the colours of a round: red, green and blue of every atom from 0 to 1, (n_atoms, 3) float64."""

Report: TypeAlias = Callable[[int, int], None]
"""Called with the number of pictures drawn and to draw, at the start and after every picture."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """What one row of a strip shows.

    Attributes:
        title: what stands above it; nothing if empty.
        frames: the recorded rounds to show, at least one. They are taken one at a time, twice or three times each, so
            they may lie in a file that is larger than the memory.
        rounds: the round that was asked for in place of each frame.
        paint: gives the colours of each frame.
        view: from where it is seen, the same for all frames.
        background: red, green and blue from 0 to 1.
        start: atom centres at the start of the trajectory [length], which tell what has left the scene since,
            (n_atoms, 3) float64; by default those of the first frame.
    """

    title: str
    frames: Sequence[Frame]
    rounds: tuple[int, ...]
    paint: Paint
    view: View = field(default_factory=View)
    background: tuple[float, float, float] = (0.96, 0.96, 0.97)
    start: Floats | None = None

    def panels(self, size: tuple[int, int]) -> Iterator[Panel]:
        """Draw one frame after the other; only one is held at a time."""
        camera = fit(self.view, _Positions(self.frames), size, self.start)
        for frame, asked in zip(self.frames, self.rounds, strict=True):
            picture = draw(frame.position, self.paint(frame), camera, size, self.background)
            yield Panel(frame.round_index, picture, caption(frame, asked), notice(frame))


@dataclass(frozen=True, slots=True, eq=False)
class _Positions(Sequence[Floats]):
    """The atom centres of frames, one at a time."""

    frames: Sequence[Frame]

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, index: Any) -> Any:
        return self.frames[index].position


def caption(frame: Frame, asked: int) -> str:
    """Return what stands below the picture of a frame in place of the round that was asked for."""
    return f"round {frame.round_index}" + (f" (nearest to {asked})" if asked != frame.round_index else "")


def notice(frame: Frame) -> str:
    """Return what is wrong with a frame; empty where nothing is."""
    n_lost = int((~is_drawable(frame.position)).sum())
    return f"{n_lost} {'atom' if n_lost == 1 else 'atoms'} not drawable" if n_lost else ""


def compose(rows: Sequence[Row], out: Path, size: tuple[int, int] | None = None, report: Report | None = None) -> None:
    """Write a strip: the same rows give the same bytes, and no half-written file ever stands under its name.

    Args:
        rows: what to show, from top to bottom, at least one.
        out: the file; its extension tells the format: png, jpg, webp, pdf or svg.
        size: width and height of a frame [pixels]; by default one that makes the strip about 2500 pixels wide.
        report: hears how many pictures are drawn.

    Raises:
        InputError: an extension, a folder or a size that will not do.
        RunError: the file cannot be written.
    """
    check_picture(out, tuple(FORMATS))
    n_frames = tuple(len(row.frames) for row in rows)
    size = size or frame_size(n_frames)
    check_size(size)
    layout = Layout(size, n_frames, tuple(bool(row.title) for row in rows), has_notices=False)
    _check_layout(layout, out)
    panels: list[list[Panel]] = [[] for _ in rows]
    with whole_file(out) as file:  # before anything is drawn, which may take long
        for number, panel in _drawn(rows, size, report):
            panels[number].append(panel)
        if any(panel.notice for row in panels for panel in row):
            layout = replace(layout, has_notices=True)
            _check_layout(layout, out)
        file.write(encode([row.title for row in rows], panels, layout, out.suffix.lower()))


def _check_layout(layout: Layout, out: Path) -> None:
    """Refuse a strip that is larger than files of pictures can be."""
    if max(layout.width, layout.height) > _LARGEST:
        raise InputError(
            f"{out}: a strip of {sum(layout.n_frames)} frames would have {layout.width}×{layout.height} pixels, more "
            f"than {_LARGEST} along a side; choose fewer rounds or smaller frames"
        )


def frames_to(
    rows: Sequence[Row], folder: Path, size: tuple[int, int] | None = None, report: Report | None = None
) -> list[Path]:
    """Write every frame as a PNG of its own, without text: `round-00250.png`, of several rows `row-2-round-00250.png`.

    Args:
        rows: what to show.
        folder: where the files go; made if it does not exist.
        size: width and height of a frame [pixels]; by default 400 by 300.
        report: hears how many pictures are drawn.

    Returns:
        The files, in order.

    Raises:
        InputError: a size that will not do, or the folder is a file.
        RunError: a file cannot be written.
    """
    size = size or LARGE
    check_size(size)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise InputError(f"{folder}: this is a file; give the name of a folder") from None
    except OSError as error:
        raise RunError(f"{folder}: cannot be made: {error.strerror or error}") from error
    digits = len(str(max(max(row.rounds) for row in rows)))
    written = []
    for number, panel in _drawn(rows, size, report):
        prefix = f"row-{number + 1}-" if len(rows) > 1 else ""
        written.append(folder / f"{prefix}round-{panel.round_index:0{digits}}.png")
        write_whole(written[-1], _png(panel.picture))
    return written


def _drawn(rows: Sequence[Row], size: tuple[int, int], report: Report | None) -> Iterator[tuple[int, Panel]]:
    """Yield the number of a row and a panel of it, one after the other, and report what was done with each."""
    n_panels = sum(len(row.frames) for row in rows)
    report = report or (lambda n_drawn, n_panels: None)
    report(0, n_panels)
    panels = ((number, panel) for number, row in enumerate(rows) for panel in row.panels(size))
    for n_drawn, panel in enumerate(panels, 1):
        yield panel
        report(n_drawn, n_panels)


def check_size(size: tuple[int, int]) -> None:
    """Refuse frames that nobody can see or no memory can hold.

    Raises:
        InputError: as said.
    """
    if not all(16 <= side <= 4096 for side in size):
        raise InputError(f"a frame must be from 16 to 4096 pixels wide and high (got {size[0]}x{size[1]})")


def _png(picture: Pixels) -> bytes:
    from PIL import Image, PngImagePlugin

    comments = PngImagePlugin.PngInfo()
    comments.add_text("Comment", MARK)
    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG", pnginfo=comments)
    return content.getvalue()
