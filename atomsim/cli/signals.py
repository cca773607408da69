"""Ctrl-C and SIGTERM as a wish that a run looks at when it can stop cleanly; knows nothing of runs."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class StopWish:
    """Whether someone asked the process to stop.

    Attributes:
        signal_number: the signal that asked, or None.
    """

    def __init__(self) -> None:
        self.signal_number: int | None = None

    def note(self, signal_number: int, _: FrameType | None) -> None:
        """Remember the first wish; a second Ctrl-C does not wait any longer."""
        if self.signal_number is not None:
            raise KeyboardInterrupt
        self.signal_number = signal_number


@contextmanager
def wishes_to_stop() -> Iterator[StopWish]:
    """Turn Ctrl-C and SIGTERM into a wish for as long as this lasts."""
    wish = StopWish()
    before = {number: signal.signal(number, wish.note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield wish
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
