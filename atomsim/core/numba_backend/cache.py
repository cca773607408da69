"""Where compiled kernels are kept from one process to the next; knows neither Numba nor what the kernels compute.

Numba would keep them beside the package, which may be read-only, and would not notice when a file changes that a kernel
only calls into. So they go to the user's cache, into a folder named by the sources of the whole core.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from pathlib import Path


def folder() -> Path | None:
    """Return the folder for the kernels of these sources, or None where there are no source files (inside a zip)."""
    sources = sorted(Path(__file__).parents[1].rglob("*.py"))
    digest = hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()
    chosen = os.environ.get("NUMBA_CACHE_DIR") or _absolute(os.environ.get("XDG_CACHE_HOME"))
    try:
        base = Path(chosen) if chosen else Path.home() / ".cache"
    except RuntimeError:  # a user without a home
        return None
    return base / f"atomsim-kernels-{digest[:16]}" if sources else None


def _absolute(folder: str | None) -> str | None:
    """Leave out a folder that depends on where one happens to be, as the standard for such folders asks."""
    return folder if folder and Path(folder).is_absolute() else None


def writable_folder() -> Path | None:
    """Return the folder, made if need be, or None if nothing can be kept: then every process compiles anew."""
    place = folder()
    if place is None:
        return None
    try:
        place.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=place).close()
    except OSError:
        return None
    return place


def has_kernels() -> bool:
    """Return whether an earlier process seems to have left its kernels."""
    place = folder()
    return place is not None and any(place.glob("*/*.nbc"))


def clear() -> None:
    """Remove what is kept; it may be damaged."""
    place = folder()
    if place is not None:
        shutil.rmtree(place, ignore_errors=True)
