"""The form of the journal, the append-only file from which nothing can take away what is already in it.

A journal is a series of records: a prefix (kind, length and CRC-32) and that many bytes.

    head     the header as JSON; the first record
    bonds    (n_bonds, 3) int32: first, second, table; the second record
    frames   rows of frames
    end      the end of the run as JSON
    go on    the run goes on after a stop: JSON with the rounds now planned. It takes back the end, and the last
             frame if the run as now planned would not have recorded that round.
    replaces a finished file that the one to be built may replace: JSON with its size and when it was last written.
             There may be several; any other file is somebody else's.

So resuming only appends too, and a reader stops before the first record that is torn or damaged. This file knows the
form, not how a journal is written, read or built into the finished file.
"""

from __future__ import annotations

import os
import struct
import zlib
from pathlib import Path

from atomsim.disk import behind, beside
from atomsim.errors import InputError
from atomsim.trajectory.guard import reading

HEAD, BONDS, FRAMES, END, GO_ON = b"atom.hea", b"atom.bon", b"atom.fra", b"atom.end", b"atom.goo"
REPLACES = b"atom.rep"
"""The kinds of record; the first also tells that a file is a journal."""

PREFIX = struct.Struct("<8sQI")
"""Kind, length of the payload in bytes, CRC-32 of both and of the payload."""


SUFFIX = ".part"
"""By how much the name of a journal is longer than that of its trajectory."""


def journal_path(path: Path) -> Path:
    """Return where the journal of a trajectory lives: next to it, or next to the file that a link leads to.

    Raises:
        InputError: the path has no name, such as `.`, or is a link that leads nowhere.
    """
    if not path.name:
        raise InputError(f"{path}: this is a folder, not a trajectory")
    return beside(behind(path), SUFFIX)


def trajectory_path(path: str | os.PathLike[str]) -> Path:
    """Return the path of a trajectory, having made sure that it is not that of a journal.

    Raises:
        InputError: it is.
    """
    path = Path(path)
    file = behind(path)
    if file.suffix == SUFFIX:
        raise InputError(f"{file}: this is the name of a journal; name its trajectory, {file.with_suffix('')}")
    return path


def has_journal(path: Path) -> bool:
    """Return whether there is a journal of a trajectory.

    Raises:
        InputError: the file system does not tell.
    """
    with reading(path):
        return journal_path(path).exists()


def checksum_start(kind: bytes, length: int) -> int:
    """Return the CRC-32 of a record's kind and length; the payload continues it."""
    return zlib.crc32(struct.pack("<8sQ", kind, length))
