"""The command line: what users type, what they read, and the exit codes; every command loads only what it needs."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path

FAILED, INTERRUPTED = 1, 130
"""The exit codes of what is no error of ours."""

OBJECTS_PER_COLLECTION = 100_000
"""Loading modules makes many objects and no garbage; looking for it takes some hundredths of a command's start."""


def main() -> None:
    """Run the command line and end the process with its exit code: the entry point of `atomsim`."""
    gc.set_threshold(OBJECTS_PER_COLLECTION)
    # A scene means the same whatever else is installed, and looking for plugins takes time.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        code = _exit_code()
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


def _exit_code() -> int:
    """Do what was typed, until all that it printed has arrived."""
    from atomsim.cli.terminal.output import deliver, prepare

    prepare()
    try:
        code = _typed()
    except OSError as error:
        code = FAILED
        _tell_of(error)
    undelivered = deliver()
    if undelivered is not None and code == 0:
        code = FAILED
        _tell_of(undelivered)
        deliver()
    return code


def _typed() -> int:
    """Do what was typed; return the exit code, having said what went wrong."""
    from atomsim.cli.remedies import with_remedies
    from atomsim.cli.terminal.output import tell
    from atomsim.errors import AtomsimError

    try:
        from atomsim.cli.app import run_typed

        return run_typed()
    except AtomsimError as error:
        tell(with_remedies(error))
        return error.exit_code
    except MemoryError as error:
        tell(str(error) or "not enough memory for this; fewer atoms, pairs or frames at a time need less")
        return FAILED


def _tell_of(error: OSError) -> None:
    """Say what the system refused, unless whoever read our output has seen enough."""
    from atomsim.cli.terminal.output import tell

    if not isinstance(error, BrokenPipeError):
        tell(f"{error.filename or _nameless()}: {error.strerror or error}")


def _nameless() -> str:
    """Say what an error of the system is about when it names no file."""
    try:
        Path.cwd()
    except OSError:
        return "the current folder"
    return "the output"
