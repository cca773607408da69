"""Files of pictures: which names they may have, and which of them are ours."""

from __future__ import annotations

from pathlib import Path

from atomsim.disk import behind, check_regular
from atomsim.errors import InputError

MARK = "drawn by atomsim"
"""Stands as a comment in every picture of ours."""


def is_our_picture(path: Path) -> bool:
    """Tell whether a file is a picture that atomsim drew; one that cannot be read is not."""
    try:
        return MARK.encode() in path.read_bytes()
    except OSError:
        return False


def check_picture(path: Path, extensions: tuple[str, ...]) -> None:
    """Refuse a name that cannot become a file of ours, before any work is done for it.

    Args:
        path: the file to be.
        extensions: those allowed, with their dots; upper case is as good.

    Raises:
        InputError: another extension, a folder, a pipe, or a folder that does not exist.
    """
    if path.suffix.lower() not in extensions:
        allowed = ", ".join(extensions[:-1]) + f" or {extensions[-1]}"
        given = f"`{path.suffix}`" if path.suffix else "no extension"
        raise InputError(f"{path}: the extension tells the format; use {allowed} (got {given})")
    if path.is_dir():
        raise InputError(f"{path}: this is a folder; give the name of a file")
    check_regular(path)
    folder = behind(path).parent
    if not folder.is_dir():
        raise InputError(f"{path}: the folder {folder} does not exist")
