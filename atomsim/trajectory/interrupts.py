"""Moments at which Ctrl-C has to wait."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@contextmanager
def postponed() -> Iterator[Callable[[], None]]:
    """Hold Ctrl-C and termination back until the end, or until the function given is called to let them through.

    An exception from a signal handler may come between any two steps of Python, also those that HDF5 calls, which it
    leaves in disorder. Handlers run in the main thread only, so elsewhere there is nothing to hold.
    """
    pending: list[int] = []
    handlers: dict[int, Any] = {}

    def let_through() -> None:
        while pending:
            number = pending.pop(0)
            handlers[number](number, None)

    if threading.current_thread() is threading.main_thread():
        handlers = {number: handler for number in _NUMBERS if callable(handler := signal.getsignal(number))}
    try:
        for number in handlers:
            signal.signal(number, lambda arrived, _frame: pending.append(arrived))
        yield let_through
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        let_through()
