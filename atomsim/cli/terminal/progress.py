"""A line on the terminal that says how far something long is: a run, a strip, a comparison."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Iterator, Sequence
from types import TracebackType
from typing import TypeVar

REFRESH_SECONDS = 0.1
"""How often the line is written anew."""

WIDTH = 80
"""Columns of a terminal that does not say how many it has."""

Item = TypeVar("Item")


class Progress:
    """Tells how much of something long is done and how long the rest takes, on a terminal, where somebody watches.

    A context manager, which takes the line away at its end.

    Args:
        unit: what is counted.
        is_shown: whether to write at all; by default where standard error is a terminal that can return its carriage.
    """

    def __init__(self, unit: str = "round", is_shown: bool | None = None) -> None:
        self._unit = unit
        self._begin: int | None = None
        self._is_shown = _is_watched() if is_shown is None else is_shown
        self._started = time.monotonic()
        self._written = 0.0
        self._width = 0

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.clear()

    def clear(self) -> None:
        """Take the line away, for something that is to stand in its place."""
        if self._width:
            self._write("")
            self._send("\r")

    def report(self, reached: int, total: int) -> None:
        """Say how many rounds or frames of how many there are; the first call tells where it begins."""
        now = time.monotonic()
        if self._begin is None:
            self._begin, self._started = reached, now
        if self._is_shown and now - self._written >= REFRESH_SECONDS:
            self._written = now
            self._write(progress_line(self._unit, self._begin, reached, total, now - self._started))

    def over(self, items: Sequence[Item]) -> Iterator[Item]:
        """Yield some items, one after the other, and tell how many there were."""
        self.report(0, len(items))
        for number, item in enumerate(items, 1):
            yield item
            self.report(number, len(items))

    def _write(self, line: str) -> None:
        """Put a line in the place of the one before; one that is wider than the terminal could not be taken back."""
        line = line[: _columns() - 1]
        self._send("\r" + line.ljust(self._width))
        self._width = len(line)

    def _send(self, text: str) -> None:
        """Write; a run of hours does not end because its terminal is gone."""
        with contextlib.suppress(OSError):
            sys.stderr.write(text)
            sys.stderr.flush()


def _is_watched() -> bool:
    """Tell whether a line on standard error can be seen, and taken back again."""
    return sys.stderr is not None and sys.stderr.isatty() and os.environ.get("TERM") != "dumb"


def _columns() -> int:
    """Return how wide the terminal is."""
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns or WIDTH
    except (OSError, ValueError):
        return WIDTH


def progress_line(unit: str, begin: int, reached: int, total: int, seconds: float) -> str:
    """Return the line for what has come from `begin` to `reached` of `total` in so many seconds.

    >>> progress_line("round", 0, 1000, 4000, 2.0)
    'round 1,000 of 4,000  25 %  500 rounds/s  0:06 left'
    """
    per_second = (reached - begin) / seconds if seconds > 0 else 0.0
    left = duration((total - reached) / per_second) if per_second > 0 else "?"
    share = 100 * reached // max(total, 1)
    return f"{unit} {reached:,} of {total:,}  {share} %  {rate(per_second)} {unit}s/s  {left} left"


def rate(per_second: float) -> str:
    """Write rounds per second with as many digits as mean something."""
    return f"{per_second:,.0f}" if per_second >= 10 else f"{per_second:.2g}"


def duration(seconds: float) -> str:
    """Write seconds as minutes and hours.

    >>> duration(75), duration(7265)
    ('1:15', '2:01:05')
    """
    minutes, second = divmod(round(seconds), 60)
    hours, minute = divmod(minutes, 60)
    return f"{hours}:{minute:02}:{second:02}" if hours else f"{minute}:{second:02}"
