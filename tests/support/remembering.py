"""A model that remembers, and a stepper that changes what is remembered in every round: a toy for what carries it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from atomsim.core.memory import Memory, MemoryArray
from atomsim.core.model import Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from support.running import atoms_at, compiled

LAYOUT = (
    MemoryArray("controllers.gait.phase", "float64", (2,)),
    MemoryArray("controllers.gait.random", "int64", ()),
    MemoryArray("bonds.cup.broken", "bool", (3,)),
)


def remembering(**sections: object) -> tuple[Model, State]:
    """Return two falling atoms whose model remembers three arrays, and their first state."""
    model, state = compiled(
        {"a": atoms_at((0, 0, 0), (0, 3, 0))}, forces={"g": {"kind": "gravity", "impulse": [0, 0, -1]}}, **sections
    )
    first = {
        "controllers.gait.phase": np.zeros(2),
        "controllers.gait.random": np.int64(2**60),
        LAYOUT[2].name: [False] * 3,
    }
    memory = Memory({name: np.asarray(array) for name, array in first.items()})
    return replace(model, memory=LAYOUT), replace(state, memory=memory)


class RememberingStepper(NumpyStepper):
    """Turns two phases, counts in whole numbers no float64 can tell apart, and breaks a bond in every third round."""

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        for _ in range(n_rounds):
            super().advance(1)
            phase, random, broken = self._memory.values()
            self._memory = Memory(
                {
                    LAYOUT[0].name: phase + np.array([0.1, 1 / 3]),
                    LAYOUT[1].name: random + 1,
                    LAYOUT[2].name: broken | (np.arange(3) * 3 == self._round_index),
                }
            )
