"""The command line: what users type, what they read, and the exit codes; every command loads only what it needs."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path

INTERRUPTED = 130

OBJECTS_PER_COLLECTION = 100_000
"""Loading modules makes many objects and no garbage; looking for it takes some hundredths of a command's start."""


def main() -> None:
    """Run the command line and end the process with its exit code: the entry point of `atomsim`."""
    gc.set_threshold(OBJECTS_PER_COLLECTION)
    # A scene means the same whatever else is installed, and looking for plugins takes time.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        from atomsim.cli.remedies import with_remedies
        from atomsim.cli.terminal.output import prepare, tell
        from atomsim.errors import AtomsimError

        prepare()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    try:
        _run_command()
    except KeyboardInterrupt:
        code = INTERRUPTED
    except AtomsimError as error:
        tell(with_remedies(error))
        code = error.exit_code
    except MemoryError as error:
        tell(str(error) or "not enough memory for this; fewer atoms, pairs or frames at a time need less")
        code = 1
    except BrokenPipeError:  # whoever read our output has seen enough
        code = 1
    except OSError as error:
        tell(f"{error.filename or _nameless()}: {error.strerror or error}")
        code = 1
    _give_output_up()
    sys.exit(code)


def _nameless() -> str:
    """Say what an error of the system is about when it names no file."""
    try:
        Path.cwd()
    except OSError:
        return "the current folder"
    return "the output"


def _run_command() -> None:
    """Do what was typed, until all that it printed has arrived; ends in SystemExit or in an error."""
    from atomsim.cli.app import app

    try:
        app()
    finally:
        if sys.stdout is not None:
            sys.stdout.flush()


def _give_output_up() -> None:
    """Forget what cannot be printed, or Python would try again at the very end, in vain and loudly."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
