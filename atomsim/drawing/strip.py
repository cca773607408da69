"""Frames side by side in one picture, a row per trajectory; knows no trajectory files and no scenes."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats, Frame, Indices
from atomsim.disk import write_whole
from atomsim.drawing.camera import FARTHEST, Camera, View
from atomsim.drawing.files import MARK, check_picture
from atomsim.drawing.framing import centred, fit, is_drawable
from atomsim.drawing.layout import LARGE, Layout, frame_size
from atomsim.drawing.page import DPI, FORMATS, WHITE, Panel, Paper, encode
from atomsim.drawing.picture import Pixels, draw
from atomsim.errors import InputError, RunError

_SURROUNDINGS = 2.0
"""What is followed is seen with what is around it: the picture is wider by this factor."""

_EVERYWHERE = np.array([[-FARTHEST] * 3, [FARTHEST] * 3])
"""Atoms that start here never leave."""

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
        background: red, green and blue from 0 to 1; None for none.
        start: atom centres at the start of the trajectory [length], which tell what has left the scene since,
            (n_atoms, 3) float64; by default those of the first frame.
        scenery: atoms that need not be seen whole, (n_atoms,) bool; by default none.
        followed: atoms whose centroid stays in the middle of all pictures, (m,) int64; None for a camera that rests.
        filling: atoms that fill the pictures wherever they are, (m,) int64; None for all that have not left.
    """

    title: str
    frames: Sequence[Frame]
    rounds: tuple[int, ...]
    paint: Paint
    view: View = field(default_factory=View)
    background: tuple[float, float, float] | None = (0.96, 0.96, 0.97)
    start: Floats | None = None
    scenery: NDArray[np.bool_] | None = None
    followed: Indices | None = None
    filling: Indices | None = None

    def panels(self, size: tuple[int, int]) -> Iterator[Panel]:
        """Draw one frame after the other; only one is held at a time."""
        camera = self._camera(size)
        for frame, asked in zip(self.frames, self.rounds, strict=True):
            picture = draw(self._placed(frame), self.paint(frame), camera, size, self.background)
            yield Panel(frame.round_index, picture, caption(frame, asked), notice(frame))

    def _placed(self, frame: Frame) -> Floats:
        """Return the atom centres of a frame in the space in which the camera rests, (n_atoms, 3) float64."""
        return frame.position if self.followed is None else centred(frame.position, self.followed)

    def _camera(self, size: tuple[int, int]) -> Camera:
        """Return the camera of all pictures: around all that has not left, what fills them, or what is followed."""
        if self.filling is not None:
            filling = self.filling
            return fit(self.view, _Mapped(self.frames, lambda frame: frame.position[filling]), size, _EVERYWHERE)
        if self.followed is None:
            return fit(self.view, _Mapped(self.frames, self._placed), size, self.start, self.scenery)
        followed = self.followed
        view = replace(self.view, look_at=(0.0, 0.0, 0.0))
        camera = fit(view, _Mapped(self.frames, lambda frame: self._placed(frame)[followed]), size)
        return Camera.of(view, camera.centre, self.view.width or _SURROUNDINGS * camera.width)


@dataclass(frozen=True, slots=True, eq=False)
class _Mapped(Sequence[Floats]):
    """What a function gives of every frame, one at a time."""

    frames: Sequence[Frame]
    function: Callable[[Frame], Floats]

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, index: Any) -> Any:
        return self.function(self.frames[index])


def caption(frame: Frame, asked: int) -> str:
    """Return what stands below the picture of a frame in place of the round that was asked for."""
    return f"round {frame.round_index}" + (f" (nearest to {asked})" if asked != frame.round_index else "")


def notice(frame: Frame) -> str:
    """Return what is wrong with a frame; empty where nothing is."""
    n_lost = int((~is_drawable(frame.position)).sum())
    return f"{n_lost} {'atom' if n_lost == 1 else 'atoms'} not drawable" if n_lost else ""


def compose(
    rows: Sequence[Row],
    out: Path,
    size: tuple[int, int] | None = None,
    report: Report | None = None,
    paper: Paper = WHITE,
    dpi: int | None = None,
) -> None:
    """Write a strip: the same rows give the same bytes, and no half-written file ever stands under its name.

    Args:
        rows: what to show, from top to bottom, at least one.
        out: the file; its extension tells the format: png, jpg, webp, pdf or svg.
        size: width and height of a frame [pixels]; by default one that makes the strip about 2500 pixels wide.
        report: hears how many pictures are drawn.
        paper: the colours around the pictures; without a colour of the page, those formats will do that have none.
        dpi: pixels per inch, which say how large it is on paper.

    Raises:
        InputError: an extension, a folder or a size that will not do.
        RunError: the file cannot be written.
    """
    check_picture(out, tuple(FORMATS))
    if paper.page == "none" and out.suffix.lower() in (".jpg", ".jpeg"):
        raise InputError(f"{out}: a JPEG cannot be transparent; use .png, .webp, .pdf or .svg")
    n_frames = tuple(len(row.frames) for row in rows)
    size = size or frame_size(n_frames)
    check_size(size)
    layout = Layout(size, n_frames, tuple(bool(row.title) for row in rows), has_notices=False)
    _check_layout(layout, out)
    panels: list[list[Panel]] = [[] for _ in rows]
    for number, panel in _drawn(rows, size, report):
        panels[number].append(panel)
    if any(panel.notice for row in panels for panel in row):
        layout = replace(layout, has_notices=True)
        _check_layout(layout, out)
    write_whole(out, encode([row.title for row in rows], panels, layout, out.suffix.lower(), paper, dpi or DPI))


def _check_layout(layout: Layout, out: Path) -> None:
    """Refuse a strip that is larger than files of pictures can be."""
    if max(layout.width, layout.height) > _LARGEST:
        raise InputError(
            f"{out}: a strip of {sum(layout.n_frames)} frames would have {layout.width}×{layout.height} pixels, more "
            f"than {_LARGEST} along a side; choose fewer rounds or smaller frames"
        )


def frames_to(
    rows: Sequence[Row],
    folder: Path,
    size: tuple[int, int] | None = None,
    report: Report | None = None,
    dpi: int | None = None,
) -> list[Path]:
    """Write every frame as a PNG of its own, without text: `round-00250.png`, of several rows `row-2-round-00250.png`.

    Args:
        rows: what to show.
        folder: where the files go; made if it does not exist.
        size: width and height of a frame [pixels]; by default 400 by 300.
        report: hears how many pictures are drawn.
        dpi: pixels per inch, which say how large they are on paper.

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
        write_whole(written[-1], _png(panel.picture, dpi))
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


def _png(picture: Pixels, dpi: int | None) -> bytes:
    from PIL import Image, PngImagePlugin

    comments = PngImagePlugin.PngInfo()
    comments.add_text("Comment", MARK)
    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG", pnginfo=comments, **({"dpi": (dpi, dpi)} if dpi else {}))
    return content.getvalue()
