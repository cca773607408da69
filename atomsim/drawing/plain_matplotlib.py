"""matplotlib as it comes: with its own settings, out of reach of the user's, for one thread at a time."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import logging
import os
import sys
import threading
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from atomsim.errors import RunError

_LOCK = threading.Lock()


@contextlib.contextmanager
def plain_matplotlib(settings: Mapping[str, Any]) -> Iterator[Path]:
    """Lend matplotlib with its default settings; afterwards those of the user are as they were.

    There is one mapping of settings for all threads, so drawing threads take turns. Inside, draw on a `Figure` and name
    the backend of `savefig`: pyplot keeps a state that is the user's, and `matplotlib.style` reads files of theirs.

    Args:
        settings: what shall differ from the defaults, such as `{"svg.hashsalt": "atomsim"}`.

    Yields:
        The file of the font to write with. By its name, any font of the machine might be found.

    Raises:
        RunError: matplotlib cannot be loaded.
    """
    with _LOCK, _silence():
        matplotlib = _loaded()
        # Read and written as plain dicts: through matplotlib's methods, `backend` would load pyplot.
        ours = {**dict(dict.items(matplotlib.rcParamsDefault)), **settings}
        del ours["backend"]
        theirs = dict(dict.items(matplotlib.rcParams))
        dict.update(matplotlib.rcParams, ours)
        try:
            yield Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")
        finally:
            now = dict(dict.items(matplotlib.rcParams))
            # What another thread has changed meanwhile is newer than what we keep.
            untouched = {name: theirs[name] for name in ours if name in theirs and now.get(name) is ours[name]}
            dict.update(matplotlib.rcParams, untouched)


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Keep to itself what matplotlib logs: of settings it does not know, of folders it cannot write, of fonts."""
    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(level)


def _loaded() -> ModuleType:
    """Return matplotlib, imported with the user's settings, or, where these make that fail, without them."""
    try:
        if "matplotlib" in sys.modules or not _would_hang():
            with contextlib.suppress(Exception):
                return importlib.import_module("matplotlib")
        for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
            del sys.modules[name]  # what an import leaves that ended halfway
        with _settings_hidden():
            return importlib.import_module("matplotlib")
    except Exception as error:
        raise RunError(f"matplotlib, which draws pictures, cannot be loaded: {error}") from error


def _would_hang() -> bool:
    """Tell whether the settings are a pipe or a device, in which matplotlib would look for an end in vain."""
    chosen = Path(os.environ.get("MATPLOTLIBRC") or os.devnull)
    files = [file for file in (Path("matplotlibrc"), chosen, chosen / "matplotlibrc") if file.exists()]
    return not all(file.is_file() or file.is_dir() or file == Path(os.devnull) for file in files)


@contextlib.contextmanager
def _settings_hidden() -> Iterator[None]:
    """Let matplotlib find its own settings first; those of the current folder are found before all, so leave it."""
    found = importlib.util.find_spec("matplotlib")
    if found is None or found.origin is None:
        yield  # the import will say what is wrong
        return
    data = Path(found.origin).with_name("mpl-data")
    hidden = {"MATPLOTLIBRC": str(data / "matplotlibrc"), "MPLBACKEND": ""}
    before = {name: os.environ.get(name) for name in hidden}
    os.environ.update(hidden)
    try:
        with contextlib.chdir(data) if Path("matplotlibrc").exists() else contextlib.nullcontext():
            yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})
