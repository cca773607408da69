"""The recorder that a run hands its frames to, and the recovery of a run that was killed."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

import numpy as np

from atomsim.core.model import Frame, State
from atomsim.disk import Stamp, behind, is_protected
from atomsim.errors import InputError, Remedy, RunError
from atomsim.trajectory.building import build
from atomsim.trajectory.door import is_ours
from atomsim.trajectory.guard import reading
from atomsim.trajectory.header import End, Header
from atomsim.trajectory.interrupts import postponed
from atomsim.trajectory.journal.form import has_journal, journal_path, trajectory_path
from atomsim.trajectory.journal.write import JournalWriter, TamperedError
from atomsim.trajectory.rows import fill, row_dtype

BLOCK_SECONDS = 1.0
"""A kill loses what was recorded in about this time."""
BLOCK_BYTES = 32 << 20
"""Memory for frames that are not written yet; at least one frame."""


class Recorder:
    """Records a run: frames go to the journal, and at the end the journal becomes the finished file.

    A context manager. However it is left, all frames handed over are in the journal or in the finished file.

    Args:
        path: the trajectory.
        header: what it says besides its frames.
        writer: what writes its journal, which becomes this object's own.
        state: that of the last frame already in it, if there is one.

    Attributes:
        path: the trajectory.
        header: what it says besides its frames.
        state: where a resumed run goes on; None for the beginning of the scene.
    """

    def __init__(self, path: Path, header: Header, writer: JournalWriter, state: State | None = None) -> None:
        self.path = path
        self.header = header
        self.state = state
        self._writer = writer
        self._last_round = -1 if state is None else state.round_index
        dtype = row_dtype(header.n_atoms, header.layout)
        self._block = np.empty(max(1, BLOCK_BYTES // dtype.itemsize), dtype)
        self._n_waiting = 0
        self._is_open = True
        # The first frame is written at once: with it, a run can be resumed.
        self._last_write = -np.inf

    @classmethod
    def begin(cls, path: str | os.PathLike[str], header: Header, *, replace: bool = False) -> Recorder:
        """Begin a trajectory.

        Args:
            path: the trajectory to write.
            header: what it says besides its frames.
            replace: whether an older trajectory of that name may go; it stays until the new one is finished.

        Raises:
            InputError: something is there already, or nothing can be there.
            RunError: the folder cannot be written to, or another process writes this trajectory.
        """
        path = Path(path)
        replaces = Stamp.of(path) if replace else None
        check_target(path, replace=replace)
        with postponed():
            writer = JournalWriter.begin(journal_path(path), header, replaces)
            try:
                writer.publish(replace=replace)
            except BaseException:
                writer.discard()
                raise
        return cls(path, header, writer)

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if not self._is_open:
            return
        try:
            self._flush()
        except RunError:
            # One message is enough; if there is none yet, this is it.
            if error is None:
                raise
        finally:
            self._close()

    def append(self, frame: Frame) -> None:
        """Record a frame; its arrays may change afterwards.

        Raises:
            RunError: it could not be written; the frames before it are intact.
            ValueError: its round is not later than the last one, or its number of atoms or its memory another.
        """
        if frame.round_index <= self._last_round:
            raise ValueError(f"round {frame.round_index} recorded after round {self._last_round}")
        if self._n_waiting == len(self._block):
            self._flush()
        fill(self._block[self._n_waiting], frame)
        self._n_waiting += 1
        self._last_round = frame.round_index
        if time.monotonic() - self._last_write >= BLOCK_SECONDS:
            self._flush()

    def finish(self, end: End) -> None:
        """Build the finished file and remove the journal.

        Raises:
            RunError: it could not be written; all frames are intact in the journal.
        """
        self._flush()
        self._writer.end(end)
        build(self._writer, self.path)
        self._writer.remove()
        self._close()

    def _flush(self) -> None:
        if self._n_waiting:
            # Between the two lines, an interrupt would make the frames be written twice.
            with postponed():
                try:
                    self._writer.frames(self._block[: self._n_waiting])
                except TamperedError:
                    self._n_waiting = 0
                    raise
                self._n_waiting = 0
        self._last_write = time.monotonic()

    def _close(self) -> None:
        self._writer.close()
        self._is_open = False


def recover(path: str | os.PathLike[str], report: Callable[[int, int], object] | None = None) -> None:
    """Build the finished file from the journal that a killed run left, and remove the journal.

    Args:
        path: the trajectory.
        report: hears how many frames of how many are in the file.

    Raises:
        InputError: there is no journal, or its header is damaged.
        RunError: the file cannot be written, or the run is still going on.
    """
    path = trajectory_path(path)
    if not has_journal(path):
        raise InputError(f"{path}: there is no journal {journal_path(path)} to recover it from")
    writer = JournalWriter.reopen(journal_path(path))
    try:
        build(writer, path, report)
        writer.remove()
    finally:
        writer.close()


def check_target(path: str | os.PathLike[str], *, replace: bool) -> Path:
    """Return the path of a trajectory to be written, having made sure that nothing of value stands there.

    Args:
        path: as the user named it.
        replace: whether an older trajectory of that name may go.

    Raises:
        InputError: something is there already, or nothing can be there.
    """
    path = trajectory_path(path)
    with reading(path):
        _check_free(path, replace=replace)
    return path


def _check_free(path: Path, *, replace: bool) -> None:
    folder = behind(path).parent
    if not folder.is_dir():
        raise InputError(f"{path}: there is no folder {folder}")
    if path.is_dir():
        raise InputError(f"{path}: is a folder; name a file in it")
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: is not a regular file")
    if is_protected(path):
        raise InputError(f"{path}: is write-protected", Remedy("rename"))
    for taken in (path, journal_path(path)):
        if taken.exists() and not is_ours(taken):
            raise InputError(f"{taken} exists and is no trajectory", Remedy("rename"))
        if taken.exists() and not replace:
            raise InputError(f"{taken} exists", Remedy("replace"), Remedy("go on", path))
