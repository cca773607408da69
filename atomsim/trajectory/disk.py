"""The few dealings with the file system that must not go wrong halfway; knows nothing of trajectories."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
from pathlib import Path

from atomsim.errors import RunError

_NO_LOCKS_HERE = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}
_NO_HARD_LINKS_HERE = {errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK}


def beside(path: Path, suffix: str) -> Path:
    """Return the path whose name is longer by `suffix`."""
    return path.with_name(path.name + suffix)


def open_locked(path: Path, *, create: bool = False) -> int:
    """Open a file for reading and writing and keep every other writer out until it is closed.

    Some network file systems have no locks; there, the user has to take care.

    Returns:
        The file descriptor.

    Raises:
        RunError: another process holds the file.
        OSError: the file cannot be opened.
    """
    fd = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW | (os.O_CREAT if create else 0), 0o666)
    try:
        _lock(fd, path)
    except BaseException:
        os.close(fd)
        raise
    return fd


def _lock(fd: int, path: Path) -> None:
    in_use = RunError(f"{path}: another atomsim is writing it; wait for that to end, or choose another name with -o")
    try:
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise in_use from None
    except OSError as error:
        if error.errno not in _NO_LOCKS_HERE:
            raise
    # Between opening and locking, the writer that held the lock may have moved or removed the file.
    if not (path.exists() and os.path.samestat(os.fstat(fd), path.stat())):
        raise in_use


def write_all(fd: int, *parts: bytes | memoryview, at: int) -> int:
    """Write the parts one after the other from the offset `at` on; return the offset after them."""
    for part in parts:
        rest = memoryview(part)
        while rest:
            written = os.pwrite(fd, rest, at)
            at += written
            rest = rest[written:]
    return at


def publish(temporary: Path, path: Path) -> None:
    """Give a finished file its name, unless something has that name already.

    Raises:
        FileExistsError: something has.
    """
    try:
        os.link(temporary, path)
    except OSError as error:
        if error.errno not in _NO_HARD_LINKS_HERE:
            raise
        if path.exists():
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path)) from None
        os.rename(temporary, path)  # noqa: PTH104 - the whole file speaks the system's language
        return
    temporary.unlink()


def replace(temporary: Path, path: Path) -> None:
    """Put a finished file in the place of another so that, whatever happens, one of the two stands there."""
    os.replace(temporary, path)  # noqa: PTH105
    sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Make new names in a folder survive a power cut, where the file system knows how to."""
    with contextlib.suppress(OSError):
        fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(fd)
        finally:
            os.close(fd)
