"""The command line: what users type, what they read, and the exit codes; every command loads only what it needs."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Run the command line and end the process with its exit code: the entry point of `atomsim`."""
    from atomsim.cli.app import app
    from atomsim.errors import AtomsimError

    try:
        app()
    except AtomsimError as error:
        print(error, file=sys.stderr)
        sys.exit(error.exit_code)
    except MemoryError:
        print("not enough memory for this; fewer atoms, pairs or frames at a time need less", file=sys.stderr)
        sys.exit(1)
    except BrokenPipeError:  # whoever read our output has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:
        print(f"{error.filename or 'the system'}: {error.strerror or error}", file=sys.stderr)
        sys.exit(1)
