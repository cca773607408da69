"""Lines over rounds with what happened marked above them; knows no trajectories and no measures."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from atomsim.core.model import Floats
from atomsim.disk import write_whole
from atomsim.drawing.chart import Chart, Mark
from atomsim.drawing.files import check_picture
from atomsim.drawing.page import FORMATS, printable
from atomsim.drawing.plain_matplotlib import plain_matplotlib
from atomsim.drawing.plot_layout import Lanes, apart, limits, number, thinned, ticks
from atomsim.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DPI = 64
"""As that of strips: a power of two, so that no size in pixels is lost on the way through inches."""

WIDTH, CHART, SMALLEST = 1280, 210, 80
"""The width of a plot and the height of a chart by default, and the least of either [pixels]."""

LARGEST = 16000
"""The longest side that all formats can hold [pixels]."""

_FONT, _TITLE = 14, 19
"""Heights of letters [pixels]."""

_LEFT, _RIGHT, _TOP, _BOTTOM, _HEAD, _GAP = 84, 22, 16, 56, 34, 26
"""Room beside, above and below all charts, above each for its title, and below each [pixels]."""

_LANE, _MOST_LANES, _BESIDE = 21, 10, 14
"""Height of a line of events, how many there are at most, and the room between texts beside each other [pixels]."""

_MOST_LABEL, _MOST_EVENT = 260, 420
"""A label beside a line, and the text of an event, are no wider than this [pixels]."""

_DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)))

_PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
"""Behind every text, so that no line runs through it."""

_INK, _FAINT, _GRID, _EVENT = "#1d1d1f", "#6b6b72", "#e6e6eb", "#b4b4be"


def plot_to(
    charts: Sequence[Chart], marks: Sequence[Mark], title: str, out: Path, size: tuple[int, int] | None = None
) -> None:
    """Write a plot: the same charts give the same bytes, and no half-written file ever stands under its name.

    Args:
        charts: what to show, from top to bottom, at least one.
        marks: what happened, ascending.
        title: what stands above all; nothing if empty.
        out: the file; its extension tells the format: png, jpg, webp, pdf or svg.
        size: width and height [pixels]; by default as high as the charts need.

    Raises:
        InputError: an extension, a folder or a size that will not do.
        RunError: the file cannot be written.
    """
    check_picture(out, tuple(FORMATS))
    content = io.BytesIO()
    extension = out.suffix.lower()
    with plain_matplotlib({"svg.hashsalt": "atomsim"}) as font:
        figure = _Page(font, charts, marks, title).drawn(size)
        figure.savefig(content, format=extension[1:], dpi=_DPI, **FORMATS[extension])
    write_whole(out, content.getvalue())


class _Page:
    """A plot on its way to a figure, in which places are pixels from the bottom left."""

    def __init__(self, font: Path, charts: Sequence[Chart], marks: Sequence[Mark], title: str) -> None:
        from matplotlib.ft2font import FT2Font

        self._font, self._letters = font, FT2Font(str(font))
        self._scratch, self._lengths = _empty(1.0, 1.0), dict[tuple[str, float], float]()
        self._charts, self._title = charts, title
        lines = [line for chart in charts for line in chart.lines]
        first, last = min(int(line.rounds[0]) for line in lines), max(int(line.rounds[-1]) for line in lines)
        self._first, self._last = first, max(last, first + 1)
        self._marks = [
            replace(mark, text=self._shortened(mark.text, _FONT, _MOST_EVENT))
            for mark in marks
            if first <= mark.round_index <= last
        ]
        widest = max(self._length(line.label) for line in lines)
        self._label = min(widest + 2 * _FONT, _MOST_LABEL) if widest else 0.0

    def drawn(self, size: tuple[int, int] | None) -> Figure:
        """Return the figure with everything on it."""
        self._left = _LEFT
        self._width = WIDTH if size is None else size[0]
        self._right = self._width - _RIGHT - (self._label + 12 if self._label else 0)
        lanes = Lanes(self._width - _RIGHT, _BESIDE, _MOST_LANES)
        places = [
            lanes.place(self._x(mark.round_index), self._length(mark.text)) if mark.text else None
            for mark in self._marks
        ]
        title = _TITLE + 18 if self._title else 0
        above = _TOP + title + _LANE * len(lanes)
        chart = self._chart_height(size, above)
        self._height = round(above + _BOTTOM - _GAP + len(self._charts) * (_HEAD + chart + _GAP))
        self._figure = _empty(self._width, self._height)
        self._write(self._left, self._height - _TOP - _TITLE, self._title, _TITLE, _INK, self._width - self._left)
        self._draw_marks(places, self._height - _TOP - title)
        top = float(self._height - above)
        for index, each in enumerate(self._charts):
            self._draw_chart(each, top - _HEAD - chart, chart, is_last=index == len(self._charts) - 1)
            top -= _HEAD + chart + _GAP
        return self._figure

    def _chart_height(self, size: tuple[int, int] | None, above: int) -> float:
        """Return how high each chart is.

        Raises:
            InputError: they have no room, or the plot would be larger than files of pictures can be.
        """
        n_charts = len(self._charts)
        around = above + _BOTTOM - _GAP + n_charts * (_HEAD + _GAP)
        chart = float(CHART) if size is None else (size[1] - around) / n_charts
        if chart < SMALLEST or self._right - self._left < SMALLEST:
            least = self._width - self._right + self._left + SMALLEST, around + n_charts * SMALLEST
            raise InputError(f"a plot of this needs {least[0]:.0f}x{least[1]} pixels or more")
        if max(self._width, around + n_charts * chart) > LARGEST:
            raise InputError(f"a plot of {n_charts} charts would be larger than {LARGEST} pixels; plot fewer measures")
        return chart

    def _x(self, round_index: float) -> float:
        """Return where a round is [pixels]."""
        return self._left + (self._right - self._left) * (round_index - self._first) / (self._last - self._first)

    def _draw_marks(self, places: Sequence[tuple[int, float] | None], top: float) -> None:
        """Write what happened, and draw a line from each text through all charts."""
        from matplotlib.lines import Line2D

        highest: dict[int, float] = {}
        n_lanes = 1 + max((place[0] for place in places if place is not None), default=-1)
        for mark, place in zip(self._marks, places, strict=True):
            baseline = top - (n_lanes if place is None else place[0] + 1) * _LANE + 6
            highest[mark.round_index] = max(baseline, highest.get(mark.round_index, 0.0))
            if place is not None:
                self._write(place[1], baseline, mark.text, _FONT, mark.color, self._width - place[1])
        for round_index, y in highest.items():
            x = self._x(round_index) / self._width
            ends = [_BOTTOM / self._height, (y + 0.7 * _FONT) / self._height]
            self._figure.add_artist(Line2D([x, x], ends, color=_EVENT, linewidth=_points(1.0), zorder=-1.0))

    def _draw_chart(self, chart: Chart, bottom: float, height: float, *, is_last: bool) -> None:
        """Draw one chart with its title, its scales and its labels."""
        title = bottom + height + 12
        end = self._write(self._left, title, chart.title, _FONT, _INK, self._right - self._left)
        self._write(end + 9, title, chart.unit, _FONT, _FAINT, self._right - end)
        left, width = self._left / self._width, (self._right - self._left) / self._width
        axes = self._figure.add_axes((left, bottom / self._height, width, height / self._height))
        low, high = limits([line.values[line.counts] for line in chart.lines])
        axes.set_xlim(self._first, self._last)
        axes.set_ylim(low, high)
        axes.patch.set_visible(False)
        axes.spines[:].set_visible(False)
        self._draw_scales(axes, is_last)
        for line in chart.lines:
            rounds, values = thinned(line.rounds, line.values)
            marker = "o" if len(rounds) == 1 else ""
            axes.plot(
                rounds, values, color=line.color, linestyle=_DASHES[line.dash % len(_DASHES)], linewidth=_points(1.8),
                solid_capstyle="round", solid_joinstyle="round", marker=marker, markersize=_points(6),
                clip_on=not marker,
            )  # fmt: skip
        self._label_lines(chart, bottom, height, (low, high))

    def _draw_scales(self, axes: Axes, is_last: bool) -> None:
        """Draw the grid; rounds are written below the last chart only."""
        low, high = axes.get_ylim()
        style: dict[str, Any] = {
            "font": self._font,
            "fontsize": _FONT * 72 / _DPI,
            "color": _FAINT,
            "parse_math": False,
        }
        levels = ticks(low, high, 5)
        axes.set_yticks(levels, [number(level) for level in levels], **style)
        rounds = ticks(self._first, self._last, 9, least_step=1.0)
        axes.set_xticks(rounds, [f"{tick:,.0f}" if is_last else "" for tick in rounds], **style)
        axes.tick_params(length=0, pad=_points(7))
        axes.grid(axis="y", color=_GRID, linewidth=_points(1.0))
        axes.set_axisbelow(True)
        if is_last:
            self._write(self._right - self._length("round"), 12, "round", _FONT, _FAINT, self._width)

    def _label_lines(self, chart: Chart, bottom: float, height: float, scale: tuple[float, float]) -> None:
        """Write the labels beside the ends of the lines, as near as they can be without overlapping."""
        low, high = scale
        lines = [line for line in chart.lines if line.label]
        ends = [_last_finite(line.values, low) for line in lines]
        wished = [bottom + height * (min(max(end, low), high) - low) / (high - low) - 0.36 * _FONT for end in ends]
        places = apart(wished, _FONT + 4, bottom - 0.36 * _FONT, bottom + height)
        for line, end, y in zip(lines, ends, places, strict=True):
            beyond = " ↓" if end < low else " ↑" if end > high else ""
            self._write(self._right + 12, y, line.label + beyond, _FONT, line.color, self._label)

    def _write(self, x: float, baseline: float, words: str, size: float, color: str, room: float) -> float:
        """Write one line, shortened to the room it has; return where it ends."""
        line = self._shortened(words, size, room)
        self._figure.text(
            x / self._width, baseline / self._height, line,
            font=self._font, fontsize=_points(size), color=color, parse_math=False, bbox=_PAPER,
        )  # fmt: skip
        return x + self._length(line, size)

    def _shortened(self, words: str, size: float, room: float) -> str:
        """Return a text cut off where it has no room; nothing where there is not even room for `…`."""
        line = printable(words, self._letters)
        while line and self._length(line, size) > room:
            line = line[: len(line) * 9 // 10 - 1].rstrip() + "…" if len(line) > 2 else ""
        return line

    def _length(self, words: str, size: float = _FONT) -> float:
        """Return how long a text is [pixels]."""
        key = printable(words, self._letters), size
        if key not in self._lengths:
            text = self._scratch.text(0.0, 0.0, key[0], font=self._font, fontsize=_points(size), parse_math=False)
            self._lengths[key] = float(text.get_window_extent().width)
            text.remove()
        return self._lengths[key]


def _empty(width: float, height: float) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI, facecolor="white")
    FigureCanvasAgg(figure)  # which becomes the figure's canvas; text is measured with it
    return figure


def _points(pixels: float) -> float:
    return pixels * 72 / _DPI


def _last_finite(values: Floats, otherwise: float) -> float:
    finite = values[np.isfinite(values)]
    return float(finite[-1]) if finite.size else otherwise
