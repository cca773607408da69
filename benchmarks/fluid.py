"""A free fluid of any number of atoms: one block of colliding balls in random motion; knows no backend and no clock."""

from __future__ import annotations

import random
from typing import Any

import numpy as np

from atomsim.compiler import compile_scene
from atomsim.core.model import Model, State
from atomsim.scene import LoadedScene
from atomsim.scene.language import Scene

SPACING = 2.1
"""Distance between neighbours at the start [length]: an atom then has about seven others within 2.5."""

TIME_STEP = 0.02

SPEED = 0.5
"""Standard deviation of each velocity component at the start [length per unit of time]."""


def fluid_scene(n_atoms: int) -> dict[str, Any]:
    """Return the scene, at rest, as data: a block as near to a cube as the number of atoms allows."""
    return {
        "atomsim": 1,
        "title": f"A free fluid of {n_atoms} atoms",
        "time_step": TIME_STEP,
        "rounds": 100,
        "groups": {"fluid": {"shape": "block", "counts": _counts(n_atoms), "spacing": SPACING}},
        "collisions": {"contact": {"within": "fluid"}},
    }


def free_fluid(n_atoms: int, seed: int = 1) -> tuple[Model, State]:
    """Compile the scene and set its atoms in random motion, which the scene language has no word for."""
    model, state = compile_scene(LoadedScene(Scene.model_validate(fluid_scene(n_atoms))))
    normal = random.Random(seed).gauss
    velocity = np.array([normal(0.0, SPEED) for _ in range(3 * n_atoms)]).reshape(n_atoms, 3)
    return model, State(0, state.position, velocity)


def _counts(n_atoms: int) -> list[int]:
    """Return three factors of a number that are as equal as can be."""
    divisors = [number for number in range(1, n_atoms + 1) if n_atoms % number == 0]
    first = min(divisors, key=lambda number: abs(number**3 - n_atoms))
    rest = n_atoms // first
    second = min((number for number in divisors if rest % number == 0), key=lambda number: abs(number**2 - rest))
    return sorted([first, second, rest // second])
