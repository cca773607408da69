"""A run that was stopped, or finished, opened to go on: first looked at, then gone on with."""

from __future__ import annotations

import contextlib
import os
from dataclasses import replace as with_changes
from pathlib import Path
from types import TracebackType

import numpy as np

from atomsim.disk import Stamp
from atomsim.errors import InputError, Remedy
from atomsim.trajectory.building import require_own
from atomsim.trajectory.guard import reading
from atomsim.trajectory.journal.form import has_journal, journal_path, trajectory_path
from atomsim.trajectory.journal.write import JournalWriter
from atomsim.trajectory.reader import Trajectory
from atomsim.trajectory.recorder import Recorder
from atomsim.trajectory.rows import fill, row_dtype

_MOST_NAMED = 5
"""So many additions are named in a message."""


class StoppedRun:
    """A run that can go on from its last frame; until `go_on` no file is changed.

    The finished file will have the very bytes that a run without a stop would have given it. So the last frame of a
    run whose `rounds` were no multiple of `record_every` goes if the run goes further; its state serves all the same.
    If there is both a finished file and a journal, the journal is the newer.

    A context manager, which keeps other writers out.

    Args:
        path: the trajectory.
        rounds: total rounds to do; as planned before by default.
        replace: whether what another program added to the finished file may go with it.

    Raises:
        InputError: there is no such trajectory, it is damaged, blew up, or holds what another program added to it.
        RunError: it cannot be written, or another process writes it.

    Attributes:
        path: the trajectory.
        header: what it says besides its frames, with the rounds now planned.
        state: that of its last frame; None if it has none yet.
        is_complete: whether the finished file has these rounds already, so that there is nothing to go on to.
    """

    def __init__(self, path: str | os.PathLike[str], rounds: int | None = None, *, replace: bool = False) -> None:
        self.path = trajectory_path(path)
        source = _Unfinished(self.path) if has_journal(self.path) else _Finished(self.path)
        self._source: _Unfinished | _Finished | None = source
        self.header = source.header if rounds is None else with_changes(source.header, rounds=rounds)
        self.state = source.state
        try:
            self.is_complete = source.is_complete(self.header.rounds)
            if not (self.is_complete or replace):
                source.require_no_additions()
        except BaseException:
            source.close()
            raise

    def __enter__(self) -> StoppedRun:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._source is not None:
            self._source.close()

    def go_on(self) -> Recorder:
        """Return what records the rest of the run; it is its own context manager.

        To be called once, and not if the run is complete.

        Raises:
            InputError: a later version wrote the journal, and what it says cannot be judged.
            RunError: it cannot be written.
        """
        assert self._source is not None
        source, self._source = self._source, None
        try:
            writer = source.writer()
            writer.go_on(self.header.rounds)
        except BaseException:
            source.close()
            raise
        return Recorder(self.path, self.header, writer, self.state)


class _Unfinished:
    """A run of which there is a journal."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._writer = JournalWriter.reopen(journal_path(path))
        try:
            with reading(self._writer.path), contextlib.closing(self._writer.read()) as journal:
                last = len(journal.series) - 1
                self.state = journal.state(last) if last >= 0 else None
                self.header = journal.header
                self._journal = journal
        except BaseException:
            self.close()
            raise

    def is_complete(self, rounds: int) -> bool:
        """Return false: where no rounds are left to do, the file is still to be built; and refuse too few rounds."""
        if self.state is not None and self.state.round_index > rounds:
            raise InputError(f"{self._path}: has done {self.state.round_index} rounds already", Remedy("more rounds"))
        require_own(self._path, self._journal)
        return False

    def require_no_additions(self) -> None:
        """Do nothing: there is no file to which anything could have been added, or it is known to be replaceable."""

    def writer(self) -> JournalWriter:
        """Return what writes on after the last whole record."""
        self._writer.settle(self._journal)
        return self._writer

    def close(self) -> None:
        self._writer.close()


class _Finished:
    """A run of which there is the finished file alone; that stays as it is until a new one takes its place."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._stamp = Stamp.of(path)
        self._frames = Trajectory(path)
        self._writer: JournalWriter | None = None
        try:
            self.header = self._frames.header
            self.state = self._frames[-1].state
        except BaseException:
            self.close()
            raise

    def is_complete(self, rounds: int) -> bool:
        """Tell whether it has so many rounds, and refuse to go on where nothing else is to be expected."""
        last_round = self.state.round_index
        if self._frames.end.kind == "blew up":
            raise InputError(
                f"{self._path}: blew up after round {last_round} and would again; change its scene and run that"
            )
        return last_round >= rounds

    def require_no_additions(self) -> None:
        """Refuse to go on where something would be lost that no run can compute again."""
        added = self._frames.additions()
        if added:
            named = ", ".join(added[:_MOST_NAMED]) + (" and more" if len(added) > _MOST_NAMED else "")
            raise InputError(
                f"{self._path}: holds what another program put into it, and going on would lose it: {named}",
                Remedy("lose additions", self._path),
            )

    def writer(self) -> JournalWriter:
        """Write the file back into a journal, complete before it appears, and return what writes on in that."""
        self._writer = writer = JournalWriter.begin(journal_path(self._path), self.header, self._stamp)
        try:
            row = np.empty(1, row_dtype(self.header.n_atoms, self.header.layout))
            for frame in self._frames:
                fill(row[0], frame)
                writer.frames(row)
            writer.publish(replace=False)
        except BaseException:
            writer.discard()
            raise
        self._frames.close()
        return writer

    def close(self) -> None:
        self._frames.close()
        if self._writer is not None:
            self._writer.close()
