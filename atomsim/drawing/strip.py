"""Frames side by side in one picture, a row per trajectory; knows no trajectory files and no scenes."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from atomsim.core.model import Floats, Frame
from atomsim.disk import write_whole
from atomsim.drawing.camera import View
from atomsim.drawing.files import MARK, check_picture
from atomsim.drawing.framing import fit, is_drawable
from atomsim.drawing.layout import LARGE, Layout, frame_size
from atomsim.drawing.picture import Pixels, draw
from atomsim.errors import InputError, RunError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FORMATS: dict[str, dict[str, Any]] = {
    ".png": {"metadata": {"Software": None, "Comment": MARK}},
    ".jpg": {"pil_kwargs": {"quality": 92, "comment": MARK.encode()}},
    ".jpeg": {"pil_kwargs": {"quality": 92, "comment": MARK.encode()}},
    ".webp": {"pil_kwargs": {"lossless": True, "xmp": MARK.encode()}},
    ".pdf": {"metadata": {"Creator": MARK, "Producer": None, "CreationDate": None}},
    ".svg": {"metadata": {"Creator": MARK, "Date": None}},
}
"""What a strip can be written as, with our mark, and without the time of writing and the versions of programs."""

_DPI = 64
"""A power of two, so that no size in pixels is lost on the way through inches."""

_LARGEST = 16000
"""The longest side that all formats can hold [pixels]."""

_LONGEST_LINE = 400
"""Letters of a title beyond this are not even measured."""

_INK, _FAINT, _ALARM = "#1d1d1f", "#56565c", "#b22222"


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """What one row of a strip shows.

    Attributes:
        title: what stands above it; nothing if empty.
        frames: the recorded rounds to show, at least one.
        color: red, green and blue of every atom from 0 to 1, (n_atoms, 3) float64.
        view: from where it is seen, the same for all frames.
        background: `#rrggbb` or a CSS name.
        asked: the round that was asked for in place of each frame; by default what the frames hold.
        start: atom centres at the start of the trajectory [length], which tell what has left the scene since,
            (n_atoms, 3) float64; by default those of the first frame.
    """

    title: str
    frames: tuple[Frame, ...]
    color: Floats
    view: View = field(default_factory=View)
    background: str = "#f5f5f7"
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
        background = _rgb(self.background)
        for frame in self.frames:
            yield draw(frame.position, self.color, camera, size, background)


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
    check_picture(out, tuple(_FORMATS))
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
    write_whole(out, _encode(rows, layout, out.suffix.lower()))


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


def _rgb(color: str) -> tuple[float, float, float]:
    from matplotlib.colors import to_rgb

    try:
        return to_rgb(color)
    except ValueError:
        raise InputError(f"background: `{color}` is not a color; use a CSS name or #rrggbb") from None


def _png(picture: Pixels) -> bytes:
    from PIL import Image, PngImagePlugin

    comments = PngImagePlugin.PngInfo()
    comments.add_text("Comment", MARK)
    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG", pnginfo=comments)
    return content.getvalue()


def _encode(rows: Sequence[Row], layout: Layout, extension: str) -> bytes:
    """Return the bytes of the strip; a user's own matplotlib settings have no say in them."""
    from matplotlib import rc_context, style
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    content = io.BytesIO()
    with style.context("default"), rc_context({"svg.hashsalt": "atomsim"}), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph")  # a title may hold what the font does not
        figure = Figure(figsize=(layout.width / _DPI, layout.height / _DPI), dpi=_DPI, facecolor="white")
        FigureCanvasAgg(figure)  # which becomes the figure's canvas; text is measured with it
        page = _Page(figure, layout)
        for number, row in enumerate(rows):
            page.add(number, row)
        figure.savefig(content, format=extension[1:], dpi=_DPI, **_FORMATS[extension])
    return content.getvalue()


@dataclass(frozen=True, slots=True, eq=False)
class _Page:
    """A matplotlib figure in which places are pixels from the top left."""

    figure: Figure
    layout: Layout

    def add(self, number: int, row: Row) -> None:
        """Put a row in its place."""
        layout, font = self.layout, self.layout.font
        left, top = layout.corner(number, 0)
        if row.title:
            self._write(left, top - 0.75 * font, row.title, 1.25 * font, _INK, layout.width - 2 * left)
        width, height = layout.frame
        texts = zip(row.pictures(layout.frame), row.captions(), row.notices(), strict=True)
        for index, (picture, caption, notice) in enumerate(texts):
            left, top = layout.corner(number, index)
            self.figure.figimage(picture, xo=left, yo=layout.height - top - height, origin="upper")
            self._write(left, top + height + 1.4 * font, caption, font, _FAINT, width)
            self._write(left, top + height + 2.8 * font, notice, font, _ALARM, width)

    def _write(self, left: float, baseline: float, words: str, font: float, color: str, room: float) -> None:
        """Write one line, shortened to the room it has."""
        line = " ".join(words[:_LONGEST_LINE].split())
        text = self.figure.text(
            left / self.layout.width,
            1.0 - baseline / self.layout.height,
            line,
            fontfamily="DejaVu Sans",
            fontsize=font * 72 / _DPI,
            color=color,
            parse_math=False,
        )
        while text.get_window_extent().width > room:
            line = line[: len(line) * 9 // 10]
            text.set_text(line.rstrip() + "…")
