"""Processes that tests start, each in a clean environment: `atomsim` itself, or a program in Python."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO, Any

COMMAND = (sys.executable, "-m", "atomsim")

KEPT = ("PATH", "HOME", "TMPDIR", "LD_LIBRARY_PATH", "XDG_CACHE_HOME", "ATOMSIM_LONG")
"""What a child inherits. All else is left out: a `PYTHONUNBUFFERED` or `NUMBA_…` of whoever runs the tests would decide
whether they pass, and what fails for users would go unseen."""


def clean_environment(**variables: str) -> dict[str, str]:
    """Return what is kept of this environment, and some variables besides."""
    return {**{name: os.environ[name] for name in KEPT if name in os.environ}, **variables}


def python(code: str) -> tuple[str, ...]:
    """Return the command that runs a program in Python."""
    return (sys.executable, "-c", code)


def heed() -> None:
    """Let signals end the process that is about to begin; behind `nohup` or in the background it inherits deafness."""
    for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def finish(
    *arguments: str | Path,
    program: Sequence[str | Path] = COMMAND,
    cwd: Path | None = None,
    before: Callable[[], None] | None = None,
    said: str | None = None,
    stdin: int | IO[Any] = subprocess.DEVNULL,
    stdout: int | IO[Any] = subprocess.PIPE,
    stderr: int | IO[Any] = subprocess.PIPE,
    timeout: float = 120.0,
    **variables: str,
) -> Any:
    """Run a command to its end; return code, stdout and stderr as text.

    Args:
        arguments: what is typed after the command.
        program: the command; `atomsim`, unless another is given.
        cwd: the folder it runs in.
        before: what the process does before it becomes the command.
        said: what is typed or piped into it, instead of `stdin`.
        stdin: where it reads from.
        stdout: where its results go.
        stderr: where its messages go.
        timeout: how long it may take [s].
        variables: of its environment.
    """
    return subprocess.run(
        [*program, *arguments],
        cwd=cwd,
        env=clean_environment(**variables),
        preexec_fn=before,
        **({"stdin": stdin} if said is None else {"input": said}),
        stdout=stdout,
        stderr=stderr,
        encoding="utf-8",
        errors="surrogateescape",
        timeout=timeout,
        check=False,
    )


def start(
    *arguments: str | Path,
    program: Sequence[str | Path] = COMMAND,
    cwd: Path,
    before: Callable[[], None] = heed,
    **variables: str,
) -> subprocess.Popen[str]:
    """Start a command that heeds signals, and return at once; see `finish`."""
    return subprocess.Popen(
        [*program, *arguments],
        cwd=cwd,
        env=clean_environment(**variables),
        preexec_fn=before,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
