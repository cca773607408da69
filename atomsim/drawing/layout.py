"""Where everything goes on a strip, in pixels; knows neither what is shown nor how it is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

MOST_IN_A_LINE = 8
"""A row with more frames continues on further lines."""

_MARGIN, _GAP = 14, 8

LARGE, SMALL = (400, 300), (320, 240)
"""Sizes of a frame by default: small ones where more than `_MOST_LARGE` stand side by side."""

_MOST_LARGE = 6


@dataclass(frozen=True, slots=True)
class Layout:
    """Sizes of the parts of a strip [pixels].

    Attributes:
        frame: width and height of a frame.
        n_frames: how many each row has.
        has_title: whether each row has a title.
        has_notices: whether captions have a second line.
    """

    frame: tuple[int, int]
    n_frames: tuple[int, ...]
    has_title: tuple[bool, ...]
    has_notices: bool

    @property
    def columns(self) -> int:
        """Frames in a line: as many as the longest row needs in lines of even length."""
        longest = max(self.n_frames)
        return -(-longest // -(-longest // MOST_IN_A_LINE))

    @property
    def font(self) -> int:
        """Height of a caption's letters."""
        return min(max(self.frame[1] // 15, 11), 28)

    @property
    def title_height(self) -> int:
        """Height of a title with the space around it."""
        return 2 * self.font

    @property
    def caption_height(self) -> int:
        """Height of a caption with the space around it."""
        return self.font * (4 if self.has_notices else 2) + self.font // 2

    @property
    def width(self) -> int:
        """Width of the strip."""
        return 2 * _MARGIN + self.columns * (self.frame[0] + _GAP) - _GAP

    @property
    def height(self) -> int:
        """Height of the strip."""
        return self.row_top(len(self.n_frames))

    def row_top(self, row: int) -> int:
        """Return where a row begins, measured from the top."""
        top = _MARGIN
        for n_frames, has_title in zip(self.n_frames[:row], self.has_title[:row], strict=True):
            top += has_title * self.title_height + -(-n_frames // self.columns) * self._line_height
        return top

    @property
    def _line_height(self) -> int:
        return self.frame[1] + self.caption_height

    def corner(self, row: int, frame: int) -> tuple[int, int]:
        """Return the top left corner of a frame: pixels from the left and from the top of the strip."""
        line, column = divmod(frame, self.columns)
        top = self.row_top(row) + self.has_title[row] * self.title_height + line * self._line_height
        return _MARGIN + column * (self.frame[0] + _GAP), top


def frame_size(n_frames: Sequence[int]) -> tuple[int, int]:
    """Return the default size of a frame [pixels] in a strip whose rows have so many frames."""
    return LARGE if Layout(LARGE, tuple(n_frames), (False,) * len(n_frames), False).columns <= _MOST_LARGE else SMALL
