"""Frames side by side in one picture, a row per trajectory; knows no trajectory files and no scenes."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from atomsim.core.model import Floats, Frame
from atomsim.disk import write_whole
from atomsim.drawing.camera import View
from atomsim.drawing.files import MARK, check_picture
from atomsim.drawing.framing import fit, is_drawable
from atomsim.drawing.layout import LARGE, Layout, frame_size
from atomsim.drawing.page import FORMATS, Panel, encode
from atomsim.drawing.picture import Pixels, draw
from atomsim.errors import InputError, RunError

_LARGEST = 16000
"""The longest side that all formats can hold [pixels]."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """What one row of a strip shows.

    Attributes:
        title: what stands above it; nothing if empty.
        frames: the recorded rounds to show, at least one.
        color: red, green and blue of every atom from 0 to 1, (n_atoms, 3) float64.
        view: from where it is seen, the same for all frames.
        background: red, green and blue from 0 to 1.
        asked: the round that was asked for in place of each frame; by default what the frames hold.
        start: atom centres at the start of the trajectory [length], which tell what has left the scene since,
            (n_atoms, 3) float64; by default those of the first frame.
    """

    title: str
    frames: tuple[Frame, ...]
    color: Floats
    view: View = field(default_factory=View)
    background: tuple[float, float, float] = (0.96, 0.96, 0.97)
    asked: tuple[int, ...] | None = None
    start: Floats | None = None

    def captions(self) -> list[str]:
        """Return what stands below each frame."""
        asked = self.asked or tuple(frame.round_index for frame in self.frames)
        return [
            f"round {frame.round_index}" + (f" (nearest to {wish})" if wish != frame.round_index else "")
            for frame, wish in zip(self.frames, asked, strict=True)
        ]

    def notices(self) -> list[str]:
        """Return what is wrong with each frame; empty where nothing is."""
        lost = [int((~is_drawable(frame.position)).sum()) for frame in self.frames]
        return [f"{n_lost} {'atom' if n_lost == 1 else 'atoms'} not drawable" if n_lost else "" for n_lost in lost]

    def pictures(self, size: tuple[int, int]) -> Iterator[Pixels]:
        """Draw one frame after the other, each (height, width, 3) uint8; only one is held at a time."""
        camera = fit(self.view, [frame.position for frame in self.frames], size, self.start)
        for frame in self.frames:
            yield draw(frame.position, self.color, camera, size, self.background)


def compose(rows: Sequence[Row], out: Path, size: tuple[int, int] | None = None) -> None:
    """Write a strip: the same rows give the same bytes, and no half-written file ever stands under its name.

    Args:
        rows: what to show, from top to bottom, at least one.
        out: the file; its extension tells the format: png, jpg, webp, pdf or svg.
        size: width and height of a frame [pixels]; by default one that makes the strip about 2500 pixels wide.

    Raises:
        InputError: an extension, a folder or a size that will not do.
        RunError: the file cannot be written.
    """
    check_picture(out, tuple(FORMATS))
    n_frames = tuple(len(row.frames) for row in rows)
    size = size or frame_size(n_frames)
    check_size(size)
    has_notices = any(any(row.notices()) for row in rows)
    layout = Layout(size, n_frames, tuple(bool(row.title) for row in rows), has_notices)
    if max(layout.width, layout.height) > _LARGEST:
        raise InputError(
            f"{out}: a strip of {sum(n_frames)} frames would have {layout.width}×{layout.height} pixels, more than "
            f"{_LARGEST} along a side; choose fewer rounds or smaller frames"
        )
    panels = [
        [Panel(*panel) for panel in zip(row.pictures(size), row.captions(), row.notices(), strict=True)] for row in rows
    ]
    write_whole(out, encode([row.title for row in rows], panels, layout, out.suffix.lower()))


def frames_to(rows: Sequence[Row], folder: Path, size: tuple[int, int] | None = None) -> list[Path]:
    """Write every frame as a PNG of its own, without text: `round-00250.png`, of several rows `row-2-round-00250.png`.

    Args:
        rows: what to show.
        folder: where the files go; made if it does not exist.
        size: width and height of a frame [pixels]; by default 400 by 300.

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
    digits = max(len(str(frame.round_index)) for row in rows for frame in row.frames)
    written = []
    for number, row in enumerate(rows, 1):
        prefix = f"row-{number}-" if len(rows) > 1 else ""
        for frame, picture in zip(row.frames, row.pictures(size), strict=True):
            written.append(folder / f"{prefix}round-{frame.round_index:0{digits}}.png")
            write_whole(written[-1], _png(picture))
    return written


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
