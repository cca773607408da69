"""The door by which trajectories come in, whoever made them: what is behind it is what it says, or was refused.

Behind it, `guard` turns whatever goes wrong into one line; `foreign` calls the files of other programs what they are;
`journal.read` and `hdf5.hardening` read plain bytes of the expected form and size; `header` checks that values make
sense, and `rows` that frames follow each other and have their digests.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Protocol

from atomsim.core.model import State
from atomsim.errors import InputError, Remedy
from atomsim.trajectory.foreign import HDF5_SIGNATURE, N_BYTES, require_hdf5
from atomsim.trajectory.guard import first_bytes, reading
from atomsim.trajectory.header import End, Header
from atomsim.trajectory.journal.form import HEAD
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.rows import Series


class Source(Protocol):
    """What is in a journal or in a finished file."""

    header: Header
    series: Series
    end: End

    def state(self, index: int) -> State:
        """Return the state of a frame, checked against its digest."""

    def additions(self) -> list[str]:
        """Return the paths of what another program has put into the file."""

    def close(self) -> None:
        """Close the file."""


def open_source(path: Path, asked: Path) -> Source:
    """Open a journal or a finished file, read and check all but positions and velocities.

    Args:
        path: the file.
        asked: the trajectory that the user named, whose journal it may be.

    Raises:
        InputError: it is missing, damaged or neither of the two, or holds no frame yet.
    """
    with reading(path):
        start = first_bytes(path, N_BYTES)
        if start.startswith(HEAD):
            journal = Journal(os.open(path, os.O_RDONLY | os.O_CLOEXEC))
            if len(journal.series) == 0:
                journal.close()
                raise InputError(f"{path}: holds no frame yet", Remedy("begin", asked))
            return journal
        require_hdf5(path, start)
        # Deferred because HDF5 takes longer to import than a small scene to run.
        from atomsim.trajectory.hdf5.read import Finished

        return Finished(path)


def is_ours(path: Path) -> bool:
    """Tell whether a regular file is a trajectory or a journal of ours, though it may be damaged."""
    start = first_bytes(path, N_BYTES)
    if not start.startswith(HDF5_SIGNATURE):
        return start.startswith(HEAD)
    from atomsim.trajectory.hdf5.read import has_ours

    # What cannot be opened is judged by the name that stands near the beginning of each file of ours.
    return b"atomsim" in start if (answer := has_ours(path)) is None else answer
