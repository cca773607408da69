"""Real `atomsim` processes, for what cannot be tried inside a test: signals, limits, closed streams."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

COMMAND = [sys.executable, "-m", "atomsim"]


def heed() -> None:
    """Let signals end the process that is about to begin; behind `nohup` or in the background it inherits deafness."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def finish(*arguments: str | Path, cwd: Path, before: Callable[[], None] | None = None, **variables: str) -> Any:
    """Run a command to its end; return code, stdout and stderr as text.

    Args:
        arguments: what is typed after `atomsim`.
        cwd: the folder it runs in.
        before: what the process does before it becomes the command.
        variables: of its environment, besides ours.
    """
    return subprocess.run(
        [*COMMAND, *arguments],
        cwd=cwd,
        env={**os.environ, **variables},
        preexec_fn=before,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        errors="surrogateescape",
        timeout=120,
        check=False,
    )


def start(*arguments: str | Path, cwd: Path) -> subprocess.Popen[str]:
    """Start a command that heeds signals, and return at once."""
    return subprocess.Popen(
        [*COMMAND, *arguments],
        cwd=cwd,
        preexec_fn=heed,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
