"""Writing a journal; knows nothing of HDF5, and neither when a run writes nor why."""

from __future__ import annotations

import contextlib
import json
import os
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from atomsim import disk
from atomsim.errors import Remedy, RunError
from atomsim.trajectory.document import document
from atomsim.trajectory.header import End, Header
from atomsim.trajectory.journal.form import BONDS, END, FRAMES, GO_ON, HEAD, PREFIX, checksum_start
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.rows import Rows


class JournalWriter:
    """Appends records to a journal that no one else can write; a record that fails leaves no trace."""

    def __init__(self, path: Path, fd: int, whole: int) -> None:
        self._path = path
        self._fd = fd
        self._whole = whole

    @classmethod
    def begin(cls, path: Path, header: Header) -> JournalWriter:
        """Begin a journal under a temporary name next to `path`; `publish` gives it its own.

        Raises:
            RunError: it cannot be written, or another process is doing the same.
        """
        try:
            fd = disk.open_locked(disk.beside(path, ".tmp"), create=True)
        except OSError as error:
            raise RunError(f"{path}: cannot be written: {error.strerror}") from error
        writer = cls(path, fd, 0)
        try:
            os.ftruncate(fd, 0)
            writer._append_json(HEAD, document(header))
            writer._append(BONDS, np.column_stack((header.bond, header.bond_table)).astype("<i4"))
        except BaseException as error:
            writer.discard()
            if isinstance(error, OSError):
                raise RunError(f"{path}: cannot be written: {error.strerror}") from error
            raise
        return writer

    @classmethod
    def reopen(cls, path: Path) -> JournalWriter:
        """Open a journal to go on with; `cut` must be called before anything is appended.

        Raises:
            RunError: it cannot be opened for writing, or another process writes it.
        """
        try:
            return cls(path, disk.open_locked(path), 0)
        except OSError as error:
            raise RunError(f"{path}: cannot be written: {error.strerror}") from error

    @property
    def path(self) -> Path:
        """The journal's own name."""
        return self._path

    def publish(self, *, replace: bool) -> None:
        """Give the journal its own name, once all that is in it is on the disk.

        Args:
            replace: whether a journal that has that name may go; one that is being written may not.

        Raises:
            RunError: the name is taken, or cannot be given.
        """
        temporary = disk.beside(self._path, ".tmp")
        try:
            os.fsync(self._fd)
            if replace and self._path.exists():
                old = disk.open_locked(self._path)
                try:
                    disk.replace(temporary, self._path)
                finally:
                    os.close(old)
            else:
                disk.publish(temporary, self._path)
                disk.sync_folder(self._path.parent)
        except FileExistsError:
            raise RunError(f"{self._path}: another atomsim has just begun to write it") from None
        except OSError as error:
            raise RunError(f"{self._path}: cannot be written: {error.strerror}") from error

    def discard(self) -> None:
        """Give up a journal that was not published."""
        with contextlib.suppress(OSError):
            disk.beside(self._path, ".tmp").unlink(missing_ok=True)
        self.close()

    def read(self) -> Journal:
        """Return what is in the journal, even if its name is gone.

        Raises:
            OSError, DamageError, MemoryError: as `Journal` does.
        """
        return Journal(os.dup(self._fd))

    def cut(self, whole: int) -> None:
        """Forget everything after the last whole record, which ends at this offset.

        Raises:
            RunError: the file cannot be shortened.
        """
        try:
            os.ftruncate(self._fd, whole)
        except OSError as error:
            raise RunError(f"{self._path}: cannot be written: {error.strerror}") from error
        self._whole = whole

    def frames(self, rows: Rows) -> None:
        """Append frames as one block.

        Raises:
            RunError: they could not be written; those before them are intact.
        """
        self._append(FRAMES, rows)

    def end(self, end: End) -> None:
        """Append the end of the run and see that everything is on the disk.

        Raises:
            RunError: it could not be written; all frames are intact.
        """
        self._append_json(END, {"end": end.kind, "end_report": end.report})
        try:
            os.fsync(self._fd)
        except OSError as error:
            raise self._failure(error) from error

    def go_on(self, rounds: int) -> None:
        """Append that the run goes on, to a total of `rounds`.

        Raises:
            RunError: it could not be written.
        """
        self._append_json(GO_ON, {"rounds": rounds})

    def remove(self) -> None:
        """Remove the journal, whose frames are elsewhere now, and let go of it."""
        with contextlib.suppress(OSError):
            self._path.unlink(missing_ok=True)
        self.close()

    def close(self) -> None:
        """Let go of the journal; closing twice does no harm."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def _append_json(self, kind: bytes, values: Mapping[str, Any]) -> None:
        self._append(kind, np.frombuffer(json.dumps(values).encode(), "u1"))

    def _append(self, kind: bytes, payload: np.ndarray[Any, Any]) -> None:
        data = np.ascontiguousarray(payload).reshape(-1).view("u1").data
        prefix = PREFIX.pack(kind, len(data), zlib.crc32(data, checksum_start(kind, len(data))))
        try:
            self._whole = disk.write_all(self._fd, prefix, data, at=self._whole)
        except OSError as error:
            raise self._failure(error) from error

    def _failure(self, error: OSError) -> RunError:
        with contextlib.suppress(OSError):
            os.ftruncate(self._fd, self._whole)
        return RunError(
            f"{self._path}: {error.strerror}; what was recorded before is intact in it: make room first",
            Remedy("go on", self._path.with_suffix("")),
        )
