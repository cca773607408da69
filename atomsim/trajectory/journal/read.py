"""The reader of a journal, up to the first record that is not whole."""

from __future__ import annotations

import errno
import json
import os
import zlib
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from atomsim.core.model import State
from atomsim.disk import Stamp
from atomsim.trajectory.guard import DamageError, check_room
from atomsim.trajectory.header import End, Header, check_version, end_from, header_from
from atomsim.trajectory.journal.form import BONDS, END, FRAMES, GO_ON, HEAD, PREFIX, REPLACES, checksum_start
from atomsim.trajectory.rows import SERIES, Rows, Series, check_rounds, memory_of, row_dtype, state_of

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
        replaceable: finished files that the one to be built may replace.
        whole: where the last whole record ends [bytes].
        lost: bytes after it, of a record that is torn or damaged, or that only a later version understands.
        is_later: whether it is the latter, which must not be cut off.
    """

    def __init__(self, fd: int) -> None:
        self._file = os.fdopen(fd, "rb", buffering=0)
        self._size = os.fstat(fd).st_size
        try:
            records = self._whole_records()
            self._read_header(records)
            self._read_rest(records)
        except BaseException:
            self.close()
            raise
        self.lost = self._size - self.whole

    @property
    def last_round(self) -> int:
        """The round of the last frame; −1 without any."""
        return int(self.series["round"][-1]) if len(self.series) else -1

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def additions(self) -> list[str]:
        """Return nothing: what another program writes into a journal is damage."""
        return []

    def rows(self, start: int, stop: int) -> Rows:
        """Return the frames start ≤ index < stop as rows."""
        rows = np.empty(stop - start, self._dtype)
        offsets, size = self._offsets[start:stop], self._dtype.itemsize
        breaks = np.flatnonzero(np.diff(offsets) != size) + 1  # where the next block of frames begins
        for begin, end in pairwise([0, *breaks.tolist(), stop - start]):
            self._read_into(rows[begin:end].view("u1").data, int(offsets[begin]))
        return rows

    def state(self, index: int) -> State:
        """Return the state of a frame, checked against its digest."""
        row = self.rows(index, index + 1)[0]
        return state_of(self.series[index], row["position"].copy(), row["velocity"].copy(), memory_of(row))

    def _read_header(self, records: Iterator[Record]) -> None:
        head = self._payload_of(HEAD, next(records, None))
        values = json.loads(head)
        if not isinstance(values, dict):
            raise DamageError("damaged: its header is not a mapping")
        check_version(values)
        bonds = np.frombuffer(self._payload_of(BONDS, next(records, None)), "<i4").reshape(-1, 3)
        self.header: Header = header_from(values, bonds[:, :2], bonds[:, 2], values.get("author", "unknown"))
        self._dtype = row_dtype(self.header.n_atoms, self.header.layout)
        check_room(self._dtype.itemsize)

    def _read_rest(self, records: Iterator[Record]) -> None:
        self.end = End("killed")
        self.replaceable: frozenset[Stamp] = frozenset()
        self.is_later = False
        blocks: list[range] = []
        for kind, start, length in records:
            if kind == FRAMES and length and length % self._dtype.itemsize == 0:
                blocks.append(range(start, start + length, self._dtype.itemsize))
            elif kind == END:
                self.end = end_from(json.loads(self._bytes(start, length)))
            elif kind == REPLACES:
                self.replaceable |= {Stamp(**json.loads(self._bytes(start, length)))}
            elif kind == GO_ON:
                self._go_on(int(json.loads(self._bytes(start, length))["rounds"]), blocks)
            else:
                self.is_later = kind != FRAMES
                break
            self.whole = start + length
        check_room(sum(map(len, blocks)) * SERIES.itemsize)
        nothing = np.empty(0, dtype=np.int64)
        self._offsets = np.concatenate([nothing, *(np.arange(at.start, at.stop, at.step) for at in blocks)])
        self.series = self._series()
        check_rounds(self.series)

    def _go_on(self, rounds: int, blocks: list[range]) -> None:
        self.end = End("killed")
        self.header = replace(self.header, rounds=rounds)
        if blocks and not self.header.records(int(self._series_at(blocks[-1][-1])["round"])):
            blocks[-1] = blocks[-1][:-1]
            if not blocks[-1]:
                blocks.pop()

    def _series(self) -> Series:
        series = np.empty(len(self._offsets), SERIES)
        n_rows = _PIECE // self._dtype.itemsize
        if n_rows == 0:
            for i, offset in enumerate(self._offsets.tolist()):
                series[i] = self._series_at(offset)
            return series
        for start in range(0, len(series), n_rows):
            stop = min(start + n_rows, len(series))
            series[start:stop] = self.rows(start, stop)["series"]
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
