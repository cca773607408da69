"""Dealings with the file system that must not go wrong halfway: locks, whole files, names given to finished ones."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from atomsim.errors import InputError, Remedy, RunError

_NO_LOCKS_HERE = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}
_PIECE = 1 << 20
_NO_HARD_LINKS_HERE = {errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK}


@dataclass(frozen=True, slots=True)
class Stamp:
    """By what a file is known again that nobody has written to since: its size and when it was last written [ns]."""

    size: int
    written: int

    @classmethod
    def of(cls, path: Path) -> Stamp | None:
        """Return the stamp of a file, or None where there is none."""
        try:
            found = path.stat()
        except FileNotFoundError:
            return None
        return cls(found.st_size, found.st_mtime_ns)


def beside(path: Path, suffix: str) -> Path:
    """Return the path whose name is longer by `suffix`."""
    return path.with_name(path.name + suffix)


def behind(path: Path) -> Path:
    """Return the file that a path leads to: itself, or what its symbolic links end at, which need not exist yet.

    Raises:
        InputError: the links lead in a circle.
    """
    if not os.path.islink(path):  # noqa: PTH114 - Path.is_symlink fails where the folder may not be looked into
        return path
    end = Path(os.path.realpath(path))
    if end.is_symlink():
        raise InputError(f"{path}: its links lead in a circle")
    return end


def is_protected(path: Path) -> bool:
    """Tell whether a file is there that may not be written to; replacing it would not ask."""
    return path.exists() and not os.access(path, os.W_OK)


def open_locked(path: Path, *, create: bool = False) -> int:
    """Open a file for reading and writing and keep every other writer out until it is closed.

    Some network file systems have no locks; there, the user has to take care.

    Returns:
        The file descriptor.

    Raises:
        InputError: it is a pipe or a device.
        RunError: another process holds the file.
        OSError: the file cannot be opened.
    """
    fd = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW | (os.O_CREAT if create else 0), 0o666)
    try:
        if not stat.S_ISREG(os.fstat(fd).st_mode):
            raise _not_regular(path)
        _lock(fd, path)
    except BaseException:
        os.close(fd)
        raise
    return fd


def begin_locked(path: Path) -> int:
    """Open a file as `open_locked` does, empty; what was in it is lost, unless the file has another name, too.

    A kill may leave it with two: between getting its final name and losing this one.
    """
    fd = open_locked(path, create=True)
    try:
        if os.fstat(fd).st_nlink > 1:
            path.unlink()
            os.close(fd)
            fd = open_locked(path, create=True)
        os.ftruncate(fd, 0)
    except BaseException:
        os.close(fd)
        raise
    return fd


def _lock(fd: int, path: Path) -> None:
    in_use = RunError(f"{path}: another atomsim is writing it; wait for that to end", Remedy("rename"))
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


def copy(source: int, target: int, n_bytes: int) -> None:
    """Copy so many bytes from the beginning of one open file to that of another."""
    for start in range(0, n_bytes, _PIECE):
        write_all(target, os.pread(source, min(_PIECE, n_bytes - start), start), at=start)


def publish(temporary: Path, path: Path) -> None:
    """Give a finished file its name for good, unless something has that name already.

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
    else:
        temporary.unlink()
    sync_folder(path.parent)


def replace(temporary: Path, path: Path) -> None:
    """Put a finished file in the place of another so that, whatever happens, one of the two stands there.

    Who may read and write the new file is as with the old one.
    """
    _inherit_access(temporary, path)
    os.replace(temporary, path)  # noqa: PTH105
    sync_folder(path.parent)


def _inherit_access(temporary: Path, path: Path) -> None:
    """Give a new file the group and the permissions of the one whose place it takes, or less if they are refused."""
    with contextlib.suppress(OSError):
        old, new = path.stat(), temporary.stat()
        mode = stat.S_IMODE(old.st_mode)
        if old.st_gid != new.st_gid:
            try:
                os.chown(temporary, -1, old.st_gid)
            except OSError:
                mode &= ~stat.S_IRWXG  # they were meant for another group
        temporary.chmod(mode)


def check_regular(path: Path) -> None:
    """Refuse what is there and no file that could be replaced: a pipe, a device.

    Raises:
        InputError: as said.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise _not_regular(path)


def _not_regular(path: Path) -> InputError:
    return InputError(f"{path}: is not a regular file")


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Open a file to be written, or the one behind a link, so that its name never stands for half of it.

    It is written under another name first, and moved into place when all went well.

    Raises:
        InputError: a pipe or a device has that name.
        RunError: the disk does not take it; what stood under the name before is untouched.
    """
    try:
        target = behind(path)
        check_regular(path)
        if is_protected(target):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        temporary = beside(target, f".{os.getpid()}.tmp")
        try:
            with temporary.open("wb") as file:
                yield file
            _inherit_access(temporary, target)
            temporary.replace(target)
        except BaseException:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise RunError(f"{path}: cannot be written: {error.strerror or error}") from error


def write_whole(path: Path, content: bytes) -> None:
    """Write a file that is at hand whole; see `whole_file`."""
    with whole_file(path) as file:
        file.write(content)


def sync_folder(folder: Path) -> None:
    """Make new names in a folder survive a power cut, where the file system knows how to."""
    with contextlib.suppress(OSError):
        fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(fd)
        finally:
            os.close(fd)
