"""From a scene written as Python data, or a scene file, to states; knows no expectations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from atomsim.compiler import compile_scene
from atomsim.core.digest import state_digest
from atomsim.core.model import Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.errors import SceneError
from atomsim.scene import LoadedScene
from atomsim.scene.language import Scene
from atomsim.scene.loader import load

SCENES = Path(__file__).parents[2] / "scenes"

PAPER_SCENES = ["rods", "rod-thread", "threads", "balls", "ring", "ring-elastic", "ring-soft"]


def scene_of(groups: dict[str, Any], time_step: float = 0.05, **sections: Any) -> Scene:
    """Validate a scene written as Python data."""
    return Scene.model_validate({"atomsim": 1, "time_step": time_step, "rounds": 100, "groups": groups, **sections})


def paper_scene(name: str) -> Scene:
    """Load one of the seven scenes of the paper."""
    return load(SCENES / f"{name}.yaml").scene


def compiled(groups: dict[str, Any], time_step: float = 0.05, **sections: Any) -> tuple[Model, State]:
    """Compile a scene written as Python data."""
    return compile_scene(LoadedScene(scene_of(groups, time_step, **sections)))


def without_mistakes(data: dict[str, Any]) -> tuple[Scene, Model, State]:
    """Compile random data without the declarations that make no sense for the groups they name.

    A group whose atoms are at one place becomes one of atoms that are not, so that there is always one.
    """
    while True:
        scene = scene_of(**data)
        try:
            return scene, *compile_scene(LoadedScene(scene))
        except SceneError as error:
            for section, name in {tuple(problem.path.split(".")[:2]) for problem in error.problems}:
                instead = {name: atoms_at((0, 0, 9), (2, 0, 9), (4, 1, 9))} if section == "groups" else {}
                kept = {key: value for key, value in data[section].items() if key != name or instead}
                data = {**data, section: kept | instead}


def after(model: Model, state: State, n_rounds: int) -> State:
    """Return the state so many rounds later."""
    stepper = NumpyStepper(model, state)
    stepper.advance(n_rounds)
    return stepper.state()


def is_finite(state: State) -> bool:
    """Return whether every number of a state is finite."""
    return bool(np.isfinite(state.position).all() and np.isfinite(state.velocity).all())


def digest_of(state: State) -> str:
    """Return the digest of a state."""
    return state_digest(state.position, state.velocity)


def atoms_at(*positions: tuple[float, float, float], **keys: Any) -> dict[str, Any]:
    """Write a group of atoms at given places."""
    return {"shape": "atoms", "positions": positions, **keys}
