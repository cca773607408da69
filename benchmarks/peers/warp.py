"""The rounds in Warp, on the CPU in float64: a thread per atom, a loop over its partners; knows no other engine."""

from __future__ import annotations

import numpy as np
import warp as wp

from atomsim.core.model import Floats, Model, State
from benchmarks.pairs import pair_table

wp.config.log_level = wp.LOG_ERROR
wp.config.enable_backward = False  # no derivatives, so no code for them


class WarpStepper:
    """Advances one state of a model."""

    def __init__(self, model: Model, state: State) -> None:
        pairs = pair_table(model)
        atom, partner, rest_squared, ceiling = pairs.seen_from_every_atom()
        first_entry = np.searchsorted(atom, np.arange(pairs.n_atoms + 1))
        self._here, self._there = _vectors(state.position), _vectors(state.position)
        self._velocity = _vectors(state.velocity)
        constant = [
            wp.array(first_entry, dtype=wp.int32, device="cpu"),
            wp.array(partner, dtype=wp.int32, device="cpu"),
            wp.array(rest_squared, dtype=wp.float64, device="cpu"),
            wp.array(ceiling, dtype=wp.float64, device="cpu"),
            _vectors(pairs.push),
            wp.float64(model.time_step),
        ]
        self._even, self._odd = (
            wp.launch(
                _advance,
                dim=pairs.n_atoms,
                inputs=[*constant, here],
                outputs=[there, self._velocity],
                device="cpu",
                record_cmd=True,  # a recorded launch takes a fraction of the time of a fresh one
            )
            for here, there in ((self._here, self._there), (self._there, self._here))
        )
        self._round_index = state.round_index

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        for _ in range(n_rounds):
            self._even.launch()
            self._even, self._odd = self._odd, self._even
            self._here, self._there = self._there, self._here
        self._round_index += n_rounds

    def state(self) -> State:
        """Return a copy of the present state."""
        return State(self._round_index, self._here.numpy().copy(), self._velocity.numpy().copy())


def _vectors(rows: Floats) -> wp.array:
    return wp.array(rows, dtype=wp.vec3d, device="cpu")


@wp.kernel
def _advance(
    first_entry: wp.array(dtype=wp.int32),
    partner: wp.array(dtype=wp.int32),
    rest_squared: wp.array(dtype=wp.float64),
    ceiling: wp.array(dtype=wp.float64),
    push: wp.array(dtype=wp.vec3d),
    time_step: wp.float64,
    here: wp.array(dtype=wp.vec3d),
    there: wp.array(dtype=wp.vec3d),
    velocity: wp.array(dtype=wp.vec3d),
):
    atom = wp.tid()
    impulse = push[atom]
    for entry in range(first_entry[atom], first_entry[atom + 1]):
        difference = here[partner[entry]] - here[atom]
        weight = wp.float64(1.0) - rest_squared[entry] / wp.dot(difference, difference)
        impulse += wp.min(weight, ceiling[entry]) * difference
    velocity[atom] = velocity[atom] + impulse
    there[atom] = here[atom] + time_step * velocity[atom]
