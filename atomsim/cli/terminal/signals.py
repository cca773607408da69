"""Signals as a wish to stop, which a run looks at when it can stop cleanly."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from atomsim.cli.terminal.output import tell

WISHES = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""Ctrl-C, `kill`, a terminal that was closed."""


class StopWish:
    """Whether someone asked the process to stop.

    Attributes:
        signal_number: the signal that asked first, or None.
        is_heard: whether somebody has begun to ask for the wish; until then, a signal ends the process at once.
    """

    def __init__(self) -> None:
        self.signal_number: int | None = None
        self.is_heard = False

    def is_wished(self) -> bool:
        """Tell whether to stop; whoever asks once has to ask again and again."""
        self.is_heard = True
        return self.signal_number is not None

    def note(self, signal_number: int, _: FrameType | None) -> None:
        """Remember the first wish; a second Ctrl-C does not wait any longer.

        A terminal that is closed may say so twice, itself and by its shell, and is not impatient.
        """
        is_patient = self.signal_number is None or signal_number == signal.SIGHUP
        self.signal_number = self.signal_number or signal_number
        if not (is_patient and self.is_heard):
            raise KeyboardInterrupt


@contextmanager
def wishes_to_stop(hint: str) -> Iterator[StopWish]:
    """Turn signals into a wish for as long as this lasts, unless they are ignored, as behind `nohup`.

    Args:
        hint: what to tell those who would not wait for the wish to be granted.
    """
    wish = StopWish()
    heeded = [number for number in WISHES if signal.getsignal(number) != signal.SIG_IGN]
    before = {number: signal.signal(number, wish.note) for number in heeded}
    try:
        yield wish
    except KeyboardInterrupt:
        if wish.is_heard:
            tell(f"stopped at once; {hint}")
        sys.exit(128 + (wish.signal_number or signal.SIGINT))
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
