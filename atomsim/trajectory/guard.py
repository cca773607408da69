"""Rules that every reader of a stranger's file keeps to.

A file that was damaged, or made to do damage, ends in one line that says what is wrong with it: never in a traceback,
never in a request for more memory than there is.
"""

from __future__ import annotations

import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from atomsim.core.free_memory import free_memory
from atomsim.errors import AtomsimError, InputError


class DamageError(Exception):
    """A file is not what it should be; the message completes the sentence that begins with its name."""


def odd(detail: str) -> DamageError:
    """Return the error for a file of which nobody can tell whether it was damaged or written by another program."""
    return DamageError(f"damaged, or not a trajectory of atomsim ({detail})")


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn whatever goes wrong while `path` is read into one line about it.

    HDF5 answers damaged files with nearly every exception that Python has, so all of them are caught here.

    Raises:
        InputError: the file cannot be read; the message is `path: what is wrong`.
    """
    try:
        yield
    except AtomsimError:
        raise
    except DamageError as error:
        raise InputError(f"{path}: {error}") from error
    except MemoryError as error:
        raise InputError(f"{path}: needs more memory than there is") from error
    except Exception as error:
        raise InputError(f"{path}: {_in_words(error)}") from error


def _in_words(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror and not error.strerror.startswith("Unable to"):
        return error.strerror
    # A KeyError would put its text in quotes.
    text = " ".join(str(error.args[0] if isinstance(error, KeyError) and error.args else error).split())
    if "truncated file" in text:
        return "damaged: the end of the file is missing"
    hdf5 = re.fullmatch(r"(?:Unable to|Can't) [^(]*\((.*)\)", text)
    detail = f"HDF5 says: {hdf5[1]}" if hdf5 else text or type(error).__name__
    return str(odd(detail[:200]))


def first_bytes(path: Path, count: int) -> bytes:
    """Return the first bytes of a regular file, by which its format is known.

    Opening a pipe would wait for a writer that may never come, so what is not a regular file is refused unopened.
    """
    mode = path.stat().st_mode
    if stat.S_ISDIR(mode):
        raise DamageError("this is a folder, not a trajectory")
    if not stat.S_ISREG(mode):
        raise DamageError("this is not a regular file")
    with path.open("rb") as file:
        return file.read(count)


def check_room(n_bytes: int) -> None:
    """Refuse to read more than the free memory holds.

    Raises:
        MemoryError: it does not fit.
    """
    if n_bytes > free_memory():
        raise MemoryError
