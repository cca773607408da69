"""Scenes as they are named on the command line: files, and `-` for standard input."""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from atomsim.cli.terminal.output import tell
from atomsim.errors import InputError, SceneError

if TYPE_CHECKING:
    from atomsim.scene import LoadedScene

STANDARD_INPUT = Path("-")


def named_scene(path: Path, settings: Sequence[str] | None = None) -> LoadedScene:
    """Load the scene that a name stands for.

    Raises:
        SceneError: as `atomsim.scene.load` does.
    """
    from atomsim.scene import load, load_stream

    if path != STANDARD_INPUT:
        try:
            return load(path, settings or ())
        except SceneError as error:
            from atomsim.tasks.begin import with_time_step  # only a mistake needs it

            raise with_time_step(error, lambda more: load(path, (*(settings or ()), *more))) from None
    if sys.stdin is not None and sys.stdin.isatty():
        tell("reading a scene from standard input; Ctrl-D ends it")
    stream = io.BytesIO() if sys.stdin is None else sys.stdin.buffer
    return load_stream(stream, "standard input", settings or ())


def check_streams(scenes: Sequence[Path]) -> None:
    """Refuse to read standard input twice: the second time there is nothing left.

    Raises:
        InputError: as said.
    """
    if scenes.count(STANDARD_INPUT) > 1:
        raise InputError("- stands for standard input, which can be read only once")
