"""The writer of a journal, which goes on when another program changes it under the run."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import zlib
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from atomsim import disk
from atomsim.disk import Stamp
from atomsim.errors import InputError, Remedy, RunError
from atomsim.trajectory.guard import DamageError
from atomsim.trajectory.header import End, Header, document
from atomsim.trajectory.journal.form import (
    BONDS,
    END,
    FRAMES,
    GO_ON,
    HEAD,
    PREFIX,
    REPLACES,
    checksum_start,
    journal_path,
)
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.rows import Rows


class TamperedError(RunError):
    """Another program changed a journal under its run; what could be kept is kept, and the run cannot go on."""


class JournalWriter:
    """Appends records to a journal that no one else can write; a record that fails leaves no trace."""

    def __init__(self, path: Path, fd: int) -> None:
        self._path = path
        self._fd = fd
        self._whole = 0
        self._last_round = -1
        self._is_named = False
        self._header: Header | None = None
        self._replaceable: list[Stamp] = []

    @classmethod
    def begin(cls, path: Path, header: Header, replaces: Stamp | None = None) -> JournalWriter:
        """Begin a journal under a temporary name next to `path`; `publish` gives it its own.

        Args:
            path: the journal.
            header: what the trajectory says besides its frames.
            replaces: the finished file that the one to be built may replace, if there is one.

        Raises:
            RunError: it cannot be written, or another process is doing the same.
        """
        try:
            fd = disk.begin_locked(disk.beside(path, ".tmp"))
        except OSError as error:
            raise RunError(f"{path}: cannot be written: {error.strerror}") from error
        writer = cls(path, fd)
        writer._header = header
        writer._replaceable = [] if replaces is None else [replaces]
        try:
            writer._begin()
        except BaseException as error:
            writer.discard()
            if isinstance(error, OSError):
                raise RunError(f"{path}: cannot be written: {error.strerror}") from error
            raise
        return writer

    @classmethod
    def reopen(cls, path: Path) -> JournalWriter:
        """Open a journal to go on with; `settle` must be called before anything is appended.

        Raises:
            RunError: it cannot be opened for writing, or another process writes it.
        """
        try:
            return cls(path, disk.open_locked(path))
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
        except FileExistsError:
            raise RunError(f"{self._path}: another atomsim has just begun to write it") from None
        except OSError as error:
            raise RunError(f"{self._path}: cannot be written: {error.strerror}") from error
        self._is_named = True

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

    def settle(self, journal: Journal) -> None:
        """Forget everything after the last record that is whole in the journal, as it was just read.

        Raises:
            InputError: a later version wrote it, and what follows cannot be judged.
            TamperedError: a record that was written here is not whole any more.
            RunError: the file cannot be shortened.
        """
        if journal.is_later:
            raise InputError(f"{self._path}: written by a later atomsim, which is needed to go on with it")
        if journal.whole < self._whole:
            raise TamperedError(
                f"{self._path}: another program changed it, and its frames after {_round(journal.last_round)} are "
                "lost; they can be computed again",
                self._remedy(),
            )
        try:
            os.ftruncate(self._fd, journal.whole)
        except OSError as error:
            raise RunError(f"{self._path}: cannot be written: {error.strerror}") from error
        self._whole, self._last_round, self._is_named = journal.whole, journal.last_round, True
        self._header, self._replaceable = journal.header, list(journal.replaceable)

    def frames(self, rows: Rows) -> None:
        """Append frames as one block.

        Raises:
            TamperedError: another program changed the journal; if it can be written to, the frames are in it.
            RunError: they could not be written; those before them are intact.
        """
        trouble = self._mend() if self._is_named else None
        self._append(FRAMES, rows)
        self._last_round = int(rows["series"]["round"][-1])
        if trouble is not None:
            raise trouble

    def end(self, end: End) -> None:
        """Append the end of the run and see that everything is on the disk.

        Raises:
            RunError: it could not be written; all frames are intact.
        """
        self._append_json(END, {"end": end.kind, "end_report": end.report})
        self._sync()

    def may_replace(self, finished: Stamp) -> None:
        """Append that the file to be built may replace this finished one, and see that it is on the disk.

        Raises:
            RunError: it could not be written; all frames are intact.
        """
        self._append_json(REPLACES, asdict(finished))
        self._replaceable.append(finished)
        self._sync()

    def go_on(self, rounds: int) -> None:
        """Append that the run goes on, to a total of `rounds`.

        Raises:
            RunError: it could not be written.
        """
        self._append_json(GO_ON, {"rounds": rounds})
        assert self._header is not None  # the journal was settled
        self._header = replace(self._header, rounds=rounds)

    def remove(self) -> None:
        """Remove the journal, whose frames are elsewhere now, and let go of it; another file of its name stays."""
        with contextlib.suppress(OSError):
            if os.path.samestat(self._path.stat(), os.fstat(self._fd)):
                self._path.unlink()
        self.close()

    def close(self) -> None:
        """Let go of the journal; closing twice does no harm."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def _begin(self) -> None:
        assert self._header is not None
        self._append_json(HEAD, {**document(self._header), "author": self._header.author})
        self._append(BONDS, np.column_stack((self._header.bond, self._header.bond_table)).astype("<i4"))
        for stamp in self._replaceable:
            self._append_json(REPLACES, asdict(stamp))

    def _mend(self) -> TamperedError | None:
        """Make a journal that another program has changed fit to be written to again.

        Returns:
            The error to raise once that is done, if frames are lost or the journal has another name now.
        """
        found = os.fstat(self._fd)
        lost = self._cut_to_what_is_left() if found.st_size < self._whole else None
        elsewhere = self._name_again() if found.st_nlink == 0 else None
        return lost or elsewhere

    def _cut_to_what_is_left(self) -> TamperedError | None:
        before = self._last_round
        try:
            with contextlib.closing(self.read()) as journal:
                self._whole, self._last_round = journal.whole, journal.last_round
        except DamageError:  # not even its header is left
            self._whole, self._last_round = 0, -1
            self._begin()
        if self._last_round == before:
            return None
        return TamperedError(
            f"{self._path}: another program shortened it, and its frames after {_round(self._last_round)} up to round "
            f"{before} are lost; what is left and the newest frames are in it",
            self._remedy(),
        )

    def _name_again(self) -> TamperedError | None:
        """Copy a journal that has lost its only name, and would end with this process, to a file of its own."""
        path = self._path if not self._path.exists() else _free_name(self._path)
        temporary = disk.beside(path, ".tmp")
        try:
            fd = disk.begin_locked(temporary)
            disk.copy(self._fd, fd, self._whole)
            os.fsync(fd)
            disk.publish(temporary, path)
        except OSError as error:
            raise TamperedError(
                f"{self._path}: removed by another program, and so are its frames: {error.strerror}"
            ) from error
        os.close(self._fd)
        taken, self._path, self._fd = self._path, path, fd
        if path == taken:
            return None
        return TamperedError(
            f"{taken}: another program wrote a file of that name; all frames of the run are in {path}", self._remedy()
        )

    def _append_json(self, kind: bytes, values: Mapping[str, Any]) -> None:
        self._append(kind, np.frombuffer(json.dumps(values).encode(), "u1"))

    def _append(self, kind: bytes, payload: np.ndarray[Any, Any]) -> None:
        data = np.ascontiguousarray(payload).reshape(-1).view("u1").data
        prefix = PREFIX.pack(kind, len(data), zlib.crc32(data, checksum_start(kind, len(data))))
        try:
            self._whole = disk.write_all(self._fd, prefix, data, at=self._whole)
        except OSError as error:
            raise self._failure(error) from error

    def _sync(self) -> None:
        try:
            os.fsync(self._fd)
        except OSError as error:
            raise self._failure(error) from error

    def _failure(self, error: OSError) -> RunError:
        with contextlib.suppress(OSError):
            os.ftruncate(self._fd, self._whole)
        return RunError(
            f"{self._path}: {error.strerror}; what was recorded before is intact in it: make room first",
            self._remedy(),
        )

    def _remedy(self) -> Remedy:
        return Remedy("go on", self._path.with_suffix(""))


def _round(round_index: int) -> str:
    return f"round {round_index}" if round_index >= 0 else "its header"


def _free_name(path: Path) -> Path:
    """Return a name like that of this journal by which there is neither a journal nor a trajectory."""
    trajectory = path.with_suffix("")
    others = (trajectory.with_name(f"{trajectory.stem}-{number}{trajectory.suffix}") for number in itertools.count(2))
    return next(journal_path(other) for other in others if not (other.exists() or journal_path(other).exists()))
