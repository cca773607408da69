"""The way from a journal to the finished file under its name, in whose place nothing of another program may stand."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

from atomsim import disk
from atomsim.disk import Stamp
from atomsim.errors import Remedy, RunError
from atomsim.trajectory.guard import reading
from atomsim.trajectory.journal.form import journal_path
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.journal.write import JournalWriter


def build(writer: JournalWriter, path: Path, report: Callable[[int, int], object] | None = None) -> None:
    """Build the finished file `path`, or the one behind that link, from its journal.

    What stood under the name stays until the new file is complete, and for good if it is not the one that the run was
    to replace or go on with. Safe to repeat and to kill; the journal is left to the caller.

    Args:
        writer: holds the journal.
        path: the file to be.
        report: hears how many frames of how many are in it.

    Raises:
        RunError: there is no frame, or the file cannot be written; the message says where the frames are.
    """
    with reading(writer.path):
        journal = writer.read()
    with contextlib.closing(journal):
        writer.settle(journal)
        if len(journal.series) == 0:
            raise RunError(
                f"{path}: nothing to build: its journal {writer.path.name} holds no frame yet", Remedy("begin", path)
            )
        require_own(path, journal)
        try:
            _build(writer, journal, path, report)
        except OSError as error:
            raise _unwritten(path, error) from error


def require_own(path: Path, journal: Journal) -> None:
    """Refuse to put a finished file in the place of one that another program wrote since the run began.

    Raises:
        RunError: there is such a file.
    """
    if Stamp.of(path) not in (None, *journal.replaceable):
        raise _not_own(path)


def _not_own(path: Path) -> RunError:
    return RunError(
        f"{path}: another program wrote it after the run began; all frames of the run are safe in "
        f"{journal_path(path)}: move {disk.behind(path)} away first",
        Remedy("recover", path),
    )


def _build(writer: JournalWriter, journal: Journal, path: Path, report: Callable[[int, int], object] | None) -> None:
    # Deferred because HDF5 takes longer to import than a small scene to run.
    from atomsim.trajectory.hdf5.write import write

    target = disk.behind(path)
    temporary = disk.beside(writer.path, ".built")
    try:
        write(journal, temporary, report)
        built = Stamp.of(temporary)
        if built is not None:  # if a kill leaves both file and journal, the next build has to know the file again
            writer.may_replace(built)
        require_own(target, journal)
        if target.exists():
            disk.replace(temporary, target)
        else:
            disk.publish(temporary, target)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            raise _not_own(path) from None
        raise


def _unwritten(path: Path, error: OSError) -> RunError:
    """Say where the frames are now."""
    facts = f"{path}: cannot be written: {error.strerror}"
    journal = journal_path(path)
    if journal.exists():
        return RunError(f"{facts}; all frames are safe in {journal}: make room first", Remedy("recover", path))
    return RunError(f"{facts}; its folder or its journal is gone, and the frames with it")
