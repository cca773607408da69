"""In what two scenes would run differently, value by value; knows neither files nor trajectories."""

from __future__ import annotations

from typing import Any

from atomsim.scene.language import Scene
from atomsim.scene.mistakes.wording import shown
from atomsim.scene.source import KeyPath, dotted

ONLY_WORDS_AND_PICTURES = {"title", "description", "rounds", "render", "silence", "expect"}
"""What may change while a run goes on: it moves no atom."""

MOST_LINES = 12
"""Further differences are counted, not listed."""


def differences(before: Scene, now: Scene) -> list[str]:
    """Return one line for every value in which two scenes run differently; none if they give the same frames.

    Args:
        before: a scene.
        now: the scene that it is compared with.
    """
    one, other = (scene.model_dump(exclude=ONLY_WORDS_AND_PICTURES) for scene in (before, now))
    lines = _differences((), one, other)
    more = len(lines) - MOST_LINES
    return lines if more <= 0 else [*lines[:MOST_LINES], f"and {more} more"]


def _differences(path: KeyPath, before: Any, now: Any) -> list[str]:
    if not isinstance(before, dict) or not isinstance(now, dict):
        return [] if before == now else [f"{dotted(path)}: {shown(before)} before, {shown(now)} now"]
    lines = [f"{dotted((*path, key))}: no longer there" for key in before if key not in now]
    lines += [f"{dotted((*path, key))}: new" for key in now if key not in before]
    common = [key for key in before if key in now]
    if common != [key for key in now if key in before]:
        lines.append(f"{dotted(path)}: in another order")
    for key in common:
        lines += _differences((*path, key), before[key], now[key])
    return lines
