"""A trajectory as an ordinary Python sequence of frames, whether its run is finished or not."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any, overload

import numpy as np

from atomsim import arguments
from atomsim.core.model import Floats, Frame, Indices, State
from atomsim.errors import InputError, Notice, Remedy
from atomsim.trajectory.door import Source, open_source
from atomsim.trajectory.guard import DamageError, reading
from atomsim.trajectory.header import Header
from atomsim.trajectory.journal.form import journal_path
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.rows import OBSERVABLES, recorded_frame
from atomsim.version import __version__


def later_version(path: Path, header: Header) -> Notice:
    """Return what to know of a trajectory that a later version of the program wrote."""
    return Notice(
        f"{path}: written by atomsim {header.program_version}, this is {__version__}: what the two compute may differ, "
        "and what is new in the file is not read"
    )


class Frames(Sequence[Frame]):
    """Some frames of a trajectory, each read when it is asked for; a slice of them is such a sequence again."""

    def __init__(self, trajectory: Trajectory, indices: Sequence[int]) -> None:
        self._trajectory = trajectory
        self._indices = indices

    def __len__(self) -> int:
        return len(self._indices)

    @overload
    def __getitem__(self, index: int) -> Frame: ...

    @overload
    def __getitem__(self, index: slice) -> Frames: ...

    def __getitem__(self, index: int | slice) -> Frame | Frames:
        if isinstance(index, slice):
            return Frames(self._trajectory, self._indices[index])
        return self._trajectory[self._indices[index]]


class Trajectory(Sequence[Frame]):
    """The frames of a run, read one by one from `out.h5`, or from its journal if there is nothing else.

    A context manager. Every frame is checked against its digest when it is read. Several threads may read one
    trajectory; it may be pickled to other processes, which open it again.

    Args:
        path: the trajectory as the user named it.

    Raises:
        InputError: it is missing, damaged or not a trajectory, or holds no frame yet.

    Attributes:
        path: as the user named it.
        header: scene, groups, bonds: all that stays constant.
        end: how the run ended; `killed` for a journal that was not ended.
        from_journal: whether the frames come from the journal, because the run is not finished, or was killed.
        has_journal: whether there is a journal; next to a finished file, it belongs to a newer run, or to this one
            going on.
        lost_bytes: how much at the end of a journal is torn or damaged, and left out.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = arguments.path("path", path)
        self._lock = threading.RLock()
        self._is_closed = False
        journal = journal_path(self.path)
        with reading(self.path):
            self.has_journal = journal.exists()
            self._found = journal if self.has_journal and not self.path.exists() else self.path
            if not self._found.exists():
                raise InputError(f"{self.path}: no such file")
        self._source: Source = open_source(self._found, self.path)
        self.header = self._source.header
        self.end = self._source.end
        self.from_journal = isinstance(self._source, Journal)
        self.lost_bytes = self._source.lost if isinstance(self._source, Journal) else 0

    def __enter__(self) -> Trajectory:
        self._require_open()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Close the file; what was read stays."""
        with self._lock:
            self._is_closed = True
            self._source.close()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the path alone: whoever unpickles opens the file again, and it must hold these frames."""
        self._require_open()
        return _open_again, (str(self.path.absolute()), len(self), self.digests[-1])

    def _require_open(self) -> None:
        if self._is_closed:
            raise InputError(f"{self.path}: this trajectory was closed; use it inside its `with`, or open it again")

    def __len__(self) -> int:
        return len(self._source.series)

    @overload
    def __getitem__(self, index: int) -> Frame: ...

    @overload
    def __getitem__(self, index: slice) -> Frames: ...

    def __getitem__(self, index: int | slice) -> Frame | Frames:
        indices = range(len(self))[index]
        return Frames(self, indices) if isinstance(indices, range) else self._frame(indices)

    def __iter__(self) -> Iterator[Frame]:
        return (self._frame(index) for index in range(len(self)))

    @property
    def rounds(self) -> Indices:
        """The round of each frame, (n_frames,) int64."""
        return self._source.series["round"].astype(np.int64)

    @property
    def time(self) -> Floats:
        """The time of each frame, round · τ, (n_frames,) float64."""
        times: Floats = self.rounds * np.float64(self.header.time_step)
        return times

    @property
    def digests(self) -> list[str]:
        """The state digest of each frame."""
        return [digest.decode() for digest in self._source.series["digest"].tolist()]

    @cached_property
    def observables(self) -> Mapping[str, Any]:
        """By name as in `Observables`, what was measured of each frame, (n_frames,) or (n_frames, 3)."""
        return {name: np.ascontiguousarray(self._source.series[name]) for name in OBSERVABLES}

    def notices(self) -> list[Notice]:
        """Return what a user should know about where the frames come from; empty for a finished file alone."""
        notices = []
        if self.header.is_later:
            notices.append(later_version(self.path, self.header))
        if self.from_journal:
            notices.append(
                Notice(
                    f"{self.path}: read from its journal up to round {self.rounds[-1]}",
                    (Remedy("go on", self.path), Remedy("recover", self.path)),
                )
            )
        elif self.has_journal:
            notices.append(
                Notice(
                    f"{self.path}: there is also a journal of a newer run that has not finished",
                    (Remedy("go on", self.path),),
                )
            )
        if self.lost_bytes and not self.header.is_later:
            torn = f"{self.path}: the last {self.lost_bytes:,} bytes of its journal are torn and left out"
            notices.append(Notice(torn))
        return notices

    def additions(self) -> list[str]:
        """Return the paths of what another program has added to the file, or changed in it where no digest tells.

        Raises:
            InputError: the trajectory was closed.
        """
        with self._lock, reading(self._found):
            self._require_open()
            return self._source.additions()

    def verify(self) -> None:
        """Read every frame and check it against its digest.

        Raises:
            InputError: a frame is damaged; the message names its round.
        """
        for _ in self:
            pass

    def state(self, index: int) -> State:
        """Return the state of a frame, checked, without what was observed of it.

        Raises:
            InputError: it is damaged.
        """
        with self._lock, reading(self._found):
            self._require_open()
            state = self._source.state(index)
            is_finite = np.isfinite(state.position).all() and np.isfinite(state.velocity).all()
            if not is_finite and self.end.kind != "blew up":
                raise DamageError(f"damaged: the state at round {state.round_index} is not finite")
            return state

    def _frame(self, index: int) -> Frame:
        return recorded_frame(self._source.series[index], self.state(index), self.header.time_step)


def _open_again(path: str, n_frames: int, last_digest: str) -> Trajectory:
    """Return the trajectory that was pickled.

    Raises:
        InputError: it cannot be read, or is another one now.
    """
    trajectory = Trajectory(path)
    if trajectory.digests[n_frames - 1 : n_frames] != [last_digest]:
        trajectory.close()
        raise InputError(f"{path}: holds another run than when it was pickled")
    return trajectory
