"""The scene inside a trajectory, read and compiled again with a stranger's file in mind.

A damaged or hostile file may hold any text for a scene, or a scene of other atoms than its frames.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from atomsim.compiler import compile_scene
from atomsim.compiler.selections import lay_out
from atomsim.core.model import Model, State
from atomsim.errors import InputError, SceneError
from atomsim.scene import LoadedScene, loads
from atomsim.trajectory import Header
from atomsim.version import __version__


def scene_inside(header: Header, path: Path) -> LoadedScene:
    """Return the scene that a trajectory holds.

    Args:
        header: what the trajectory says besides its frames.
        path: the trajectory, for messages.

    Raises:
        InputError: it is no valid scene.
    """
    try:
        return loads(header.scene, header.scene_name)
    except SceneError as error:
        raise broken(header, path, error.problems[0]) from None


def laid_out_inside(header: Header, path: Path) -> LoadedScene:
    """Return the scene that a trajectory holds, with the groups that the frames have: enough to find atoms by name.

    Args:
        header: what the trajectory says besides its frames.
        path: the trajectory, for messages.

    Raises:
        InputError: it is no valid scene, or not that of the frames.
    """
    loaded = scene_inside(header, path)
    spans = [(name, layout.start, layout.stop) for name, layout in lay_out(loaded.scene).items()]
    if spans[-1][-1] != header.n_atoms:
        raise _misleading(header, path, "atoms")
    if spans != [(group.name, group.start, group.stop) for group in header.groups]:
        raise _misleading(header, path, "groups")
    return loaded


def compile_inside(header: Header, path: Path) -> tuple[LoadedScene, Model, State]:
    """Return the scene that a trajectory holds, compiled: its model and first state.

    Args:
        header: what the trajectory says besides its frames.
        path: the trajectory, for messages.

    Raises:
        InputError: it is no valid scene, or not that of the frames.
    """
    loaded = laid_out_inside(header, path)  # before any atoms are made: a liar may ask for as many as memory holds
    try:
        model, state = compile_scene(loaded)
    except SceneError as error:
        raise broken(header, path, error.problems[0]) from None
    recompiled = Header.of(
        model,
        group_color=header.group_color,
        scene_text=header.scene,
        scene_name=header.scene_name,
        rounds=header.rounds,
        record_every=loaded.scene.record_every,
    )
    differing = _differing(header, recompiled)
    if differing is not None:
        raise _misleading(header, path, differing)
    return loaded, model, state


def broken(header: Header, path: Path, problem: object) -> InputError:
    """Return the error for a trajectory whose scene nobody could have run, because of a problem in it."""
    reason = f"the scene inside: {problem}"
    return _later(header, path, reason) or InputError(f"{path}: damaged, or not a trajectory of atomsim ({reason})")


def _misleading(header: Header, path: Path, what: str) -> InputError:
    reason = f"the scene inside has other {what} than the frames"
    return _later(header, path, reason) or InputError(f"{path}: damaged, or made to mislead: {reason}")


def _later(header: Header, path: Path, reason: str) -> InputError | None:
    """Return what is wrong with a scene of a later version of the language; None if it is of this one or an earlier."""
    if not header.is_later:
        return None
    return InputError(
        f"{path}: written by atomsim {header.program_version}, this is {__version__}: a later one is needed ({reason})"
    )


def _differing(one: Header, other: Header) -> str | None:
    """Say in what two headers of the same groups differ, if they do; rounds may, they are asked for with each run."""
    if not (np.array_equal(one.bond, other.bond) and np.array_equal(one.bond_table, other.bond_table)):
        return "bonds"
    if one.time_step != other.time_step:
        return "time steps"
    if one.record_every != other.record_every:
        return "rounds to record"
    return "memories" if one.memory != other.memory else None
