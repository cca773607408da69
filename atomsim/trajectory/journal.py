"""Reading a journal, up to the first record that is not whole; knows nothing of HDF5."""

from __future__ import annotations

import errno
import json
import os
import zlib
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from atomsim.core.model import Floats
from atomsim.trajectory.document import check_version, end_from, header_from
from atomsim.trajectory.guard import DamageError, check_room
from atomsim.trajectory.header import End, Header
from atomsim.trajectory.records import BONDS, END, FRAMES, GO_ON, HEAD, PREFIX, checksum_start
from atomsim.trajectory.rows import SERIES, Rows, Series, check_rounds, row_dtype

Record: TypeAlias = tuple[bytes, int, int]
"""Kind of a record, then where its payload starts and how long that is [bytes]."""

_PIECE = 1 << 20
"""Bytes read at a time for the checksum: what a record claims to be must not decide how much memory it takes."""


class Journal:
    """What is whole in a journal.

    Args:
        fd: a file descriptor of it, open for reading, which becomes this object's own.

    Raises:
        OSError: it cannot be read.
        DamageError: it is not a journal, or its header is damaged.
        MemoryError: one of its frames does not fit.

    Attributes:
        header: with the rounds planned last.
        series: what is known of each frame besides its atoms.
        end: how the run ended; `killed` if nobody said.
        whole: where the last whole record ends [bytes].
        lost: bytes after it, of a record that is torn or damaged.
    """

    def __init__(self, fd: int) -> None:
        self._file = os.fdopen(fd, "rb", buffering=0)
        self._size = os.fstat(fd).st_size
        try:
            self._offsets: list[int] = []
            records = self._whole_records()
            self._read_header(records)
            self._read_rest(records)
        except BaseException:
            self.close()
            raise
        self.lost = self._size - self.whole

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def rows(self, start: int, stop: int) -> Rows:
        """Return the frames start ≤ index < stop as rows."""
        rows = np.empty(stop - start, self._dtype)
        for i, offset in enumerate(self._offsets[start:stop]):
            self._read_into(rows[i : i + 1].view("u1").data, offset)
        return rows

    def state(self, index: int) -> tuple[Floats, Floats]:
        """Return position and velocity of a frame, both (n_atoms, 3)."""
        row = self.rows(index, index + 1)[0]
        return row["position"].copy(), row["velocity"].copy()

    def _read_header(self, records: Iterator[Record]) -> None:
        head = self._payload_of(HEAD, next(records, None))
        values = json.loads(head)
        if not isinstance(values, dict):
            raise DamageError("damaged: its header is not a mapping")
        check_version(values)
        bonds = np.frombuffer(self._payload_of(BONDS, next(records, None)), "<i4").reshape(-1, 3)
        self.header: Header = header_from(values, bonds[:, :2], bonds[:, 2])
        self._dtype = row_dtype(self.header.n_atoms)
        check_room(self._dtype.itemsize)

    def _read_rest(self, records: Iterator[Record]) -> None:
        self.end = End("killed")
        for kind, start, length in records:
            if kind == FRAMES and length % self._dtype.itemsize == 0:
                self._offsets.extend(range(start, start + length, self._dtype.itemsize))
            elif kind == END:
                self.end = end_from(json.loads(self._bytes(start, length)))
            elif kind == GO_ON:
                self._go_on(int(json.loads(self._bytes(start, length))["rounds"]))
            else:
                break
            self.whole = start + length
        self.series = self._series()
        check_rounds(self.series)

    def _go_on(self, rounds: int) -> None:
        self.end = End("killed")
        self.header = replace(self.header, rounds=rounds)
        last = self._offsets[-1:]
        if last and not self.header.records(int(self._series_at(last[0])["round"])):
            self._offsets.pop()

    def _series(self) -> Series:
        check_room(len(self._offsets) * SERIES.itemsize)
        series = np.empty(len(self._offsets), SERIES)
        for i, offset in enumerate(self._offsets):
            series[i] = self._series_at(offset)
        return series

    def _series_at(self, offset: int) -> Any:
        return np.frombuffer(self._bytes(offset, SERIES.itemsize), SERIES)[0]

    def _whole_records(self) -> Iterator[Record]:
        """Yield the records one after the other, until one is torn or damaged."""
        start = 0
        while start + PREFIX.size <= self._size:
            kind, length, checksum = PREFIX.unpack(self._bytes(start, PREFIX.size))
            start += PREFIX.size
            if start + length > self._size or self._checksum(kind, start, length) != checksum:
                return
            yield kind, start, length
            start += length

    def _checksum(self, kind: bytes, start: int, length: int) -> int:
        checksum = checksum_start(kind, length)
        for offset in range(start, start + length, _PIECE):
            checksum = zlib.crc32(self._bytes(offset, min(_PIECE, start + length - offset)), checksum)
        return checksum

    def _payload_of(self, kind: bytes, record: Record | None) -> bytes:
        if record is None or record[0] != kind:
            raise DamageError("damaged: its header is not whole")
        _, start, length = record
        check_room(length)
        self.whole = start + length
        return self._bytes(start, length)

    def _read_into(self, view: memoryview, offset: int) -> None:
        while view:
            n_read = os.preadv(self._file.fileno(), [view], offset)
            if n_read == 0:
                raise OSError(errno.EIO, "the journal became shorter while it was read")
            view, offset = view[n_read:], offset + n_read

    def _bytes(self, offset: int, length: int) -> bytes:
        return os.pread(self._file.fileno(), length, offset)
