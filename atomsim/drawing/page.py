"""A strip as the bytes of a file: pictures and lines of text in their places."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from atomsim.drawing.files import MARK
from atomsim.drawing.layout import Layout
from atomsim.drawing.picture import Pixels
from atomsim.drawing.plain_matplotlib import plain_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.ft2font import FT2Font

_AGG, _PDF, _SVG = ({"backend": name} for name in ("agg", "pdf", "svg"))

FORMATS: Mapping[str, Mapping[str, Any]] = {
    ".png": _AGG | {"metadata": {"Software": None, "Comment": MARK}},
    ".jpg": _AGG | {"pil_kwargs": {"quality": 92, "comment": MARK.encode()}},
    ".jpeg": _AGG | {"pil_kwargs": {"quality": 92, "comment": MARK.encode()}},
    ".webp": _AGG | {"pil_kwargs": {"lossless": True, "xmp": MARK.encode()}},
    ".pdf": _PDF | {"metadata": {"Creator": MARK, "Producer": None, "CreationDate": None}},
    ".svg": _SVG | {"metadata": {"Creator": MARK, "Date": None}},
}
"""What a strip can be written as, with our mark, and without the time of writing and the versions of programs."""

DPI = 64
"""Pixels per inch where nobody says: a power of two, so that no size is lost on the way through inches."""

_ROUNDING = 0.1
"""Pixels by which a page is larger than it has to be, or one might be lost where an inch has another number of them."""

_LONGEST_LINE = 400
"""Letters of a line beyond this are not even measured."""

_MISSING = "\N{REPLACEMENT CHARACTER}"
"""Stands for what the font does not have; for such letters matplotlib would warn, and look in other fonts."""


@dataclass(frozen=True, slots=True)
class Paper:
    """The colours of what is around the pictures: `#rrggbb`, or `none` for a page that can be laid over others."""

    page: str
    ink: str
    faint: str
    alarm: str


WHITE = Paper("#ffffff", "#1d1d1f", "#56565c", "#b22222")
BLACK = Paper("#1c1c1e", "#f2f2f4", "#a9a9b0", "#ff7b72")


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """A picture of a round with the line below it that says what it shows, and one that says what is wrong."""

    round_index: int
    picture: Pixels
    caption: str
    notice: str


def encode(
    titles: Sequence[str],
    rows: Sequence[Sequence[Panel]],
    layout: Layout,
    extension: str,
    paper: Paper = WHITE,
    dpi: int = DPI,
) -> bytes:
    """Return a strip as a file: the same strip gives the same bytes, whatever the user's matplotlib is set to.

    Args:
        titles: what stands above each row.
        rows: the panels of each row, from top to bottom.
        layout: where they go.
        extension: the format, one of `FORMATS`.
        paper: the colours around the pictures.
        dpi: pixels per inch.
    """
    content = io.BytesIO()
    with plain_matplotlib({"svg.hashsalt": "atomsim"}) as font:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.ft2font import FT2Font

        spare = 0.0 if dpi == DPI else _ROUNDING
        inches = ((layout.width + spare) / dpi, (layout.height + spare) / dpi)
        figure = Figure(figsize=inches, dpi=dpi, facecolor=paper.page)
        FigureCanvasAgg(figure)  # which becomes the figure's canvas; text is measured with it
        page = _Page(figure, layout, paper, dpi, font, FT2Font(str(font)))
        for number, (title, panels) in enumerate(zip(titles, rows, strict=True)):
            page.add(number, title, panels)
        figure.savefig(content, format=extension[1:], dpi=dpi, **FORMATS[extension])
    return content.getvalue()


@dataclass(frozen=True, slots=True, eq=False)
class _Page:
    """A matplotlib figure in which places are pixels from the top left."""

    figure: Figure
    layout: Layout
    paper: Paper
    dpi: int
    font: Path
    letters: FT2Font

    def add(self, number: int, title: str, panels: Sequence[Panel]) -> None:
        """Put a row in its place."""
        layout, font = self.layout, self.layout.font
        left, top = layout.corner(number, 0)
        self._write(left, top - 0.75 * font, title, 1.25 * font, self.paper.ink, layout.width - 2 * left)
        width, height = layout.frame
        for index, panel in enumerate(panels):
            left, top = layout.corner(number, index)
            self.figure.figimage(panel.picture, xo=left, yo=layout.height - top - height, origin="upper")
            self._write(left, top + height + 1.4 * font, panel.caption, font, self.paper.faint, width)
            self._write(left, top + height + 2.8 * font, panel.notice, font, self.paper.alarm, width)

    def _write(self, left: float, baseline: float, words: str, size: float, color: str, room: float) -> None:
        """Write one line, shortened to the room it has; where there is not even room for `…`, nothing."""
        line = printable(words, self.letters)
        text = self.figure.text(
            left / self.layout.width,
            1.0 - baseline / self.layout.height,
            line,
            font=self.font,
            fontsize=size * 72 / self.dpi,
            color=color,
            parse_math=False,
        )
        while text.get_window_extent().width > room:
            shorter = line[: len(line) * 9 // 10].rstrip()
            text.set_text(f"{shorter}…" if line else "")
            line = shorter


def printable(words: str, letters: FT2Font) -> str:
    """Return a text on one line, in letters that a font has."""
    line = " ".join(words[:_LONGEST_LINE].split())
    return "".join(letter if letters.get_char_index(ord(letter)) else _MISSING for letter in line)
