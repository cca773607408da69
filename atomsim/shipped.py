"""Where the scenes and the docs are that come with the program, in an installed package and in a checkout."""

from __future__ import annotations

from pathlib import Path

PACKAGE = Path(__file__).parent


def shipped(folder: str) -> Path:
    """Return a folder that comes with atomsim, `scenes` or `docs`: inside an installed package, beside a checkout's."""
    inside = PACKAGE / folder
    return inside if inside.is_dir() else PACKAGE.parent / folder
