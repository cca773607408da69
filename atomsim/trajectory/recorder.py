"""What a run hands its frames to; knows how a trajectory comes about, and nothing of what is simulated."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from dataclasses import replace as with_changes
from pathlib import Path
from types import TracebackType

import numpy as np

from atomsim.core.model import Frame, State
from atomsim.disk import Stamp, behind, is_protected
from atomsim.errors import InputError, Remedy, RunError
from atomsim.trajectory.building import build, require_own
from atomsim.trajectory.guard import reading
from atomsim.trajectory.header import End, Header
from atomsim.trajectory.interrupts import held
from atomsim.trajectory.journal.form import SUFFIX, journal_path
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.journal.write import JournalWriter, TamperedError
from atomsim.trajectory.reader import Trajectory, is_ours
from atomsim.trajectory.rows import fill, row_dtype

BLOCK_SECONDS = 1.0
"""A kill loses what was recorded in about this time."""
BLOCK_BYTES = 32 << 20
"""Memory for frames that are not written yet; at least one frame."""


class Recorder:
    """Records a run: frames go to the journal, and at the end the journal becomes the finished file.

    A context manager. However it is left, all frames handed over are in the journal or in the finished file.

    Args:
        path: the trajectory to write.
        header: what it says besides its frames.
        replace: whether an older trajectory of that name may go; it stays until the new one is finished.

    Raises:
        InputError: something is there already, or nothing can be there.
        RunError: the folder cannot be written to, or another process writes this trajectory.

    Attributes:
        path: the trajectory.
        header: what it says besides its frames.
        state: where a resumed run goes on; None for the beginning of the scene.
    """

    def __init__(self, path: str | os.PathLike[str], header: Header, *, replace: bool = False) -> None:
        path = Path(path)
        replaces = Stamp.of(path) if replace else None
        check_target(path, replace=replace)
        with held():
            writer = JournalWriter.begin(journal_path(path), header, replaces)
            try:
                writer.publish(replace=replace)
            except BaseException:
                writer.discard()
                raise
        self._set_up(path, header, writer, None)

    @classmethod
    def resume(
        cls,
        path: str | os.PathLike[str],
        *,
        rounds: int | None = None,
        accept: Callable[[Header], None] = lambda header: None,
    ) -> Recorder:
        """Go on with a run that was stopped, from its last frame, `state`.

        The finished file will have the very bytes that a run without a stop would have given it. So the last frame
        of a run whose `rounds` were no multiple of `record_every` goes if the run goes further; its state serves all
        the same. If there is both a finished file and a journal, the journal is the newer.

        Args:
            path: the trajectory.
            rounds: total rounds to do; as planned before by default.
            accept: called once with the header, before any file is changed; what it raises refuses to go on.

        Raises:
            InputError: there is no such trajectory, it is damaged, blew up, or has done these rounds already.
            RunError: it cannot be written, or another process writes it.
        """
        path = _trajectory_path(path)
        has_journal = _has_journal(path)
        if not has_journal:
            _turn_back(path, rounds, accept)
        writer = JournalWriter.reopen(journal_path(path))
        try:
            with reading(writer.path), contextlib.closing(writer.read()) as journal:
                state = _last_state(journal)
                header = _planned(journal.header, rounds)
                if state is not None and state.round_index > header.rounds:
                    raise _done_already(path, state.round_index)
                if has_journal:
                    require_own(path, journal)
                    accept(header)
                writer.settle(journal)
            writer.go_on(header.rounds)
        except BaseException:
            writer.close()
            raise
        recorder = cls.__new__(cls)
        recorder._set_up(path, header, writer, state)
        return recorder

    def _set_up(self, path: Path, header: Header, writer: JournalWriter, state: State | None) -> None:
        self.path = path
        self.header = header
        self.state = state
        self._writer = writer
        self._last_round = -1 if state is None else state.round_index
        dtype = row_dtype(header.n_atoms, header.memory)
        self._block = np.empty(max(1, BLOCK_BYTES // dtype.itemsize), dtype)
        self._n_waiting = 0
        self._is_open = True
        # The first frame is written at once: with it, a run can be resumed.
        self._last_write = -np.inf

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
            with held():
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


def recover(path: str | os.PathLike[str]) -> None:
    """Build the finished file from the journal that a killed run left, and remove the journal.

    Raises:
        InputError: there is no journal, or its header is damaged.
        RunError: the file cannot be written, or the run is still going on.
    """
    path = _trajectory_path(path)
    if not _has_journal(path):
        raise InputError(f"{path}: there is no journal {journal_path(path)} to recover it from")
    writer = JournalWriter.reopen(journal_path(path))
    try:
        build(writer, path)
        writer.remove()
    finally:
        writer.close()


def _trajectory_path(path: str | os.PathLike[str]) -> Path:
    path = Path(path)
    file = behind(path)
    if file.suffix == SUFFIX:
        raise InputError(f"{file}: this is the name of a journal; name its trajectory, {file.with_suffix('')}")
    return path


def _has_journal(path: Path) -> bool:
    with reading(path):
        return journal_path(path).exists()


def check_target(path: str | os.PathLike[str], *, replace: bool) -> Path:
    """Return the path of a trajectory to be written, having made sure that nothing of value stands there.

    Args:
        path: as the user named it.
        replace: whether an older trajectory of that name may go.

    Raises:
        InputError: something is there already, or nothing can be there.
    """
    path = _trajectory_path(path)
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


def _last_state(journal: Journal) -> State | None:
    last = len(journal.series) - 1
    return journal.state(last) if last >= 0 else None


def _planned(header: Header, rounds: int | None) -> Header:
    return header if rounds is None else with_changes(header, rounds=rounds)


def _turn_back(path: Path, rounds: int | None, accept: Callable[[Header], None]) -> None:
    """Write a finished file back into a journal, complete before it appears; the file itself stays as it is."""
    replaces = Stamp.of(path)
    with Trajectory(path) as trajectory:
        last_round = int(trajectory.rounds[-1])
        header = _planned(trajectory.header, rounds)
        if trajectory.end.kind == "blew up":
            raise InputError(f"{path}: blew up after round {last_round} and would again; change its scene and run that")
        if last_round >= header.rounds:
            raise _done_already(path, last_round)
        accept(header)
        writer = JournalWriter.begin(journal_path(path), trajectory.header, replaces)
        try:
            row = np.empty(1, row_dtype(trajectory.header.n_atoms, trajectory.header.memory))
            for frame in trajectory:
                fill(row[0], frame)
                writer.frames(row)
            writer.publish(replace=False)
        except BaseException:
            writer.discard()
            raise
        writer.close()


def _done_already(path: Path, last_round: int) -> InputError:
    return InputError(f"{path}: has done {last_round} rounds already", Remedy("more rounds"))
