"""A time step to begin with, for scenes that say none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from atomsim.compiler import compile_scene
from atomsim.core.diagnosis.stiffness import largest_stiffness
from atomsim.errors import AtomsimError, SceneError
from atomsim.findings.words import round_down
from atomsim.scene import LoadedScene

GENTLE = 0.05
"""The largest time step that anyone is advised to begin with, however soft the scene is."""

FURTHEST = 0.5
"""So far the fastest atom may move in a round to begin with: two that approach each other cannot miss [length]."""

PROVISIONAL = ("time_step=1e-9", "rounds=1")
"""Settings with which a scene that says neither can be compiled."""


def with_time_step(error: SceneError, load_with: Callable[[tuple[str, ...]], LoadedScene]) -> SceneError:
    """Return the error of a scene that says no time step with one that the scene allows.

    Args:
        error: what loading the scene raised.
        load_with: loads the scene once more with further settings.

    Returns:
        The same error where a time step is no matter, or where other mistakes hide what the scene is.
    """
    is_missing = {problem.path for problem in error.problems if problem.message.startswith("missing")}
    if "time_step" not in is_missing:
        return error
    try:
        stable_below, advised = _time_step(load_with(PROVISIONAL[: 2 if "rounds" in is_missing else 1]))
    except (AtomsimError, MemoryError):
        return error
    advice = f"this scene is stable below {stable_below:.3g}: begin with `time_step: {advised:g}`"
    return SceneError(
        [
            replace(problem, message=f"{problem.message.partition('; begin with')[0]}; {advice}")
            if problem.path == "time_step"
            else problem
            for problem in error.problems
        ],
        *error.remedies,
    )


def _time_step(loaded: LoadedScene) -> tuple[float, float]:
    """Return the time step from which on a scene is unstable, and one to begin with: half as large at most.

    Raises:
        SceneError: the scene does not compile, or nothing in it sets a limit.
    """
    model, state = compile_scene(loaded)
    stiffness = largest_stiffness(model, state)
    if not 0.0 < stiffness < math.inf:
        raise SceneError([])
    with np.errstate(over="ignore"):
        speed = float(np.sqrt((state.velocity * state.velocity).sum(axis=1).max()))
    limits = [GENTLE, 0.5 * 4.0 / stiffness, *([FURTHEST / speed] if speed else [])]
    return 4.0 / stiffness, round_down(max(min(limits), 1e-300))
