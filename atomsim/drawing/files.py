"""Files that appear whole under their name or not at all; knows nothing of what is in them but our mark."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from atomsim.errors import InputError, RunError

MARK = "drawn by atomsim"
"""Stands as a comment in every picture of ours."""


def is_our_picture(path: Path) -> bool:
    """Tell whether a file is a picture that atomsim drew; one that cannot be read is not."""
    try:
        return MARK.encode() in path.read_bytes()
    except OSError:
        return False


def check_target(path: Path, extensions: tuple[str, ...]) -> None:
    """Refuse a name that cannot become a file of ours, before any work is done for it.

    Args:
        path: the file to be.
        extensions: those allowed, with their dots; upper case is as good.

    Raises:
        InputError: another extension, a folder, or a folder that does not exist.
    """
    if path.suffix.lower() not in extensions:
        allowed = ", ".join(extensions[:-1]) + f" or {extensions[-1]}"
        given = f"`{path.suffix}`" if path.suffix else "no extension"
        raise InputError(f"{path}: the extension tells the format; use {allowed} (got {given})")
    if path.is_dir():
        raise InputError(f"{path}: this is a folder; give the name of a file")
    if not path.parent.is_dir():
        raise InputError(f"{path}: the folder {path.parent} does not exist")


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that its name never stands for half of it: under another name first, then moved into place.

    Raises:
        RunError: the disk does not take it; what stood under the name before is untouched.
    """
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(content)
        part.replace(path)
    except OSError as error:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise RunError(f"{path}: cannot be written: {error.strerror or error}") from error
