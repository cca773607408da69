"""A line on the terminal that says how far a run is; knows rounds and seconds only."""

from __future__ import annotations

import contextlib
import sys
import time
from types import TracebackType

REFRESH_SECONDS = 0.1
"""How often the line is written anew."""


class Progress:
    """Reports rounds per second and time left on a terminal, and nothing where nobody watches.

    A context manager, which takes the line away at its end.

    Args:
        is_shown: whether to write at all; by default where standard error is a terminal.
    """

    def __init__(self, is_shown: bool | None = None) -> None:
        self._begin: int | None = None
        self._is_shown = sys.stderr is not None and sys.stderr.isatty() if is_shown is None else is_shown
        self._started = time.monotonic()
        self._written = 0.0
        self._width = 0

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._width:
            self._write("")
            self._send("\r")

    def report(self, round_index: int, rounds: int) -> None:
        """Say which round of how many has been reached; the first call tells where the run begins."""
        now = time.monotonic()
        if self._begin is None:
            self._begin, self._started = round_index, now
        if self._is_shown and now - self._written >= REFRESH_SECONDS:
            self._written = now
            self._write(progress_line(self._begin, round_index, rounds, now - self._started))

    def _write(self, line: str) -> None:
        self._send("\r" + line.ljust(self._width))
        self._width = len(line)

    def _send(self, text: str) -> None:
        """Write; a run of hours does not end because its terminal is gone."""
        with contextlib.suppress(OSError):
            sys.stderr.write(text)
            sys.stderr.flush()


def progress_line(begin: int, round_index: int, rounds: int, seconds: float) -> str:
    """Return the line for a run that has come from `begin` to `round_index` of `rounds` in so many seconds.

    >>> progress_line(0, 1000, 4000, 2.0)
    'round 1,000 of 4,000  25 %  500 rounds/s  0:06 left'
    """
    per_second = (round_index - begin) / seconds if seconds > 0 else 0.0
    left = duration((rounds - round_index) / per_second) if per_second > 0 else "?"
    share = 100 * round_index // rounds
    return f"round {round_index:,} of {rounds:,}  {share} %  {rate(per_second)} rounds/s  {left} left"


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
