"""A file to which HDF5 can write without ever seeing an error.

An input/output error inside HDF5 can crash the interpreter. So the first one is kept back, HDF5 is told that all is
well until it has finished, and only then is the error raised.
"""

from __future__ import annotations

import os
from pathlib import Path
from types import TracebackType

from atomsim.disk import write_all


class Sink:
    """A new file in the form that h5py takes; as a context manager it raises what went wrong, at the end.

    Args:
        path: the file; one that is there loses this name.

    Raises:
        OSError: the file cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        path.unlink(missing_ok=True)  # it may be left from a kill, and the finished file under its second name
        self._fd = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
        self._position = 0
        self._size = 0
        self._error: OSError | None = None

    def __enter__(self) -> Sink:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        os.close(self._fd)
        self.check()

    def check(self) -> None:
        """Raise what went wrong so far; to be called while HDF5 is not calling."""
        if self._error is not None:
            raise self._error

    def sync(self) -> None:
        """See that the file is on the disk."""
        self.check()
        os.fsync(self._fd)

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Move, from the start or from the end; HDF5 asks for the size this way."""
        self._position = offset + (self._size if whence == os.SEEK_END else 0)
        return self._position

    def tell(self) -> int:
        """Return the position."""
        return self._position

    def write(self, data: bytes | memoryview) -> int:
        """Write all of the data, or after an error pretend to."""
        data = memoryview(data)
        if self._error is None:
            try:
                write_all(self._fd, data, at=self._position)
            except OSError as error:
                self._error = error
        self._position += len(data)
        self._size = max(self._size, self._position)
        return len(data)

    def read(self, size: int) -> bytes:
        """Return that many bytes, zeros where nothing was written."""
        data = b""
        try:
            data = os.pread(self._fd, size, self._position)
        except OSError as error:
            self._error = self._error or error
        self._position += size
        return data.ljust(size, b"\0")

    def truncate(self, size: int) -> int:
        """Set the size."""
        if self._error is None:
            try:
                os.ftruncate(self._fd, size)
            except OSError as error:
                self._error = error
        self._size = size
        return size

    def flush(self) -> None:
        """Do nothing: there is no buffer."""
