"""What reaches the terminal: text that it can show and never takes for a command; knows no scene and no trajectory."""

from __future__ import annotations

import contextlib
import io
import os
import re
import sys
import warnings
from typing import Any, TextIO

_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")
"""Characters by which a text could command the terminal; line breaks and tabs only lay it out."""


def prepare() -> None:
    """Make printing fail on no character and hit no file.

    What is not a terminal gets UTF-8; a terminal gets escapes where its encoding lacks a character. A stream that was
    closed from outside is opened on nothing, or the next file to be opened would take its place and its messages. One
    that another program has set not to block is set back, or it would fail whenever its reader is slow.
    """
    if not sys.warnoptions:  # nobody has asked for what libraries tell their developers
        warnings.showwarning = _unheard
    for fd in range(3):
        try:
            os.fstat(fd)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
        with contextlib.suppress(OSError):
            os.set_blocking(fd, True)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            encoding = stream.encoding if stream.isatty() else "utf-8"
            stream.reconfigure(encoding=encoding, errors="backslashreplace")


def _unheard(*_: Any, **__: Any) -> None:
    """Show a warning of Python to nobody."""


def deliver() -> OSError | None:
    """Send off what still waits to be printed; what cannot arrive is given up, or Python would try again, and loudly.

    Returns:
        What kept results from arriving, or None. Messages that nobody hears change nothing.
    """
    _deliver(sys.stderr)
    return _deliver(sys.stdout)


def _deliver(stream: TextIO | None) -> OSError | None:
    """Send off what waits in one stream."""
    if stream is None:
        return None
    try:
        stream.flush()
    except OSError as error:
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        return error
    return None


def say(text: str) -> None:
    """Print a result."""
    print(visible(text))


def tell(message: str) -> None:
    """Print a message beside the results, if anybody can hear it."""
    with contextlib.suppress(OSError):
        print(visible(message), file=sys.stderr, flush=True)


def visible(text: str) -> str:
    r"""Write control characters out; titles, names and paths come from other people's files.

    >>> print(visible("red \x1b[31malert\x07"))
    red \x1b[31malert\x07
    """
    return _CONTROL.sub(lambda match: f"\\x{ord(match.group()):02x}", text)
