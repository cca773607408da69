"""The plain NumPy loop: one table of all pairs, gathered, weighed and summed with `bincount`; knows no shortcut.

What a competent user of NumPy writes in an afternoon. It keeps to the order of evaluation, one bin per table and atom,
so it has to agree with atomsim to the last bit.
"""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Model, State
from benchmarks.pairs import pair_table


class PlainStepper:
    """Advances one state of a model."""

    def __init__(self, model: Model, state: State) -> None:
        pairs = pair_table(model)
        self._pairs = pairs
        self._time_step = model.time_step
        self._push = pairs.push.T.copy()
        self._bin = np.concatenate((pairs.second, pairs.first)) + np.tile(pairs.table * pairs.n_atoms, 2)
        self._round_index = state.round_index
        self._position = state.position.T.copy()  # one contiguous row per component
        self._velocity = state.velocity.T.copy()

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        pairs = self._pairs
        n_bins = pairs.n_tables * pairs.n_atoms
        for _ in range(n_rounds):
            difference = np.take(self._position, pairs.second, axis=1) - np.take(self._position, pairs.first, axis=1)
            squared = difference * difference
            distance_squared = (squared[0] + squared[1]) + squared[2]
            weight = np.minimum(1.0 - pairs.rest_squared * (1.0 / distance_squared), pairs.ceiling)
            force = weight * difference
            for component in range(3):
                both = np.concatenate((-force[component], force[component]))
                subtotal = np.bincount(self._bin, weights=both, minlength=n_bins)
                impulse = subtotal.reshape(pairs.n_tables, pairs.n_atoms).sum(axis=0) + self._push[component]
                self._velocity[component] += impulse
            self._position += self._time_step * self._velocity
        self._round_index += n_rounds

    def state(self) -> State:
        """Return a copy of the present state."""
        return State(self._round_index, self._position.T.copy(), self._velocity.T.copy())
