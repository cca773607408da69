"""The NumPy stepper: one iteration round as in the paper, section 2.2; knows no files and no scenes.

This is the reference backend. Inside, arrays are (3, n_atoms), one contiguous row per component.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from atomsim.core.forces import acting, held_atoms, law
from atomsim.core.model import Floats, Model, State
from atomsim.core.numpy_backend.bond_forms import Scatter
from atomsim.core.numpy_backend.bonds import bond_forms, joined
from atomsim.core.pairs.collisions import CONTACT_SQUARED, as_index
from atomsim.core.pairs.near_list import NearList


class NumpyStepper:
    """Advances one state of a model, to the order of evaluation that makes every backend give the same bits.

    Args:
        model: what stays constant.
        state: where to begin; it is copied.
    """

    def __init__(self, model: Model, state: State) -> None:
        self._time_step = model.time_step
        held = held_atoms(model.forces)
        self._bonds = [bond_forms(table, held) for table in joined(model.bonds)]
        self._near = NearList(model.collisions, model.n_atoms)
        self._forces = [law(force) for force in acting(model.forces)]
        self._outside: Floats | None = None
        self._held = as_index(held) if held.size else None
        self._round_index = state.round_index
        self._position = np.array(state.position.T, order="C")  # a copy even of a single atom
        self._velocity = np.array(state.velocity.T, order="C")
        self._memory = state.memory
        self._impulse = np.empty_like(self._position)
        self._step = np.empty_like(self._position)

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        with np.errstate(all="ignore"):  # a blow-up is found, with the round and the atom, by whoever reads the state
            for _ in range(n_rounds):
                self._advance_one_round()

    def set_forces(self, impulse: Floats | None) -> None:
        """Add an impulse to each atom in every round to come, (n_atoms, 3); None for nothing. It is copied."""
        self._outside = None if impulse is None else np.array(impulse.T, order="C")

    def state(self) -> State:
        """Return a copy of the present state."""
        position, velocity = (np.array(array.T, order="C") for array in (self._position, self._velocity))
        return State(self._round_index, position, velocity, self._memory)

    def _advance_one_round(self) -> None:
        """j(n) = Σ forces;  v(n+1) = v(n) + j(n);  c(n+1) = c(n) + τ · v(n+1)."""
        position, velocity, impulse = self._position, self._velocity, self._impulse
        impulse.fill(0.0)
        for forms in self._bonds:
            for form in forms:
                impulse[:, form.atoms] += form.subtotal(position)
        self._near.update(position)
        add_collisions(impulse, position, self._near)
        for apply in self._forces:
            apply(self._round_index, position, velocity, impulse)
        if self._outside is not None:
            impulse += self._outside
        if self._held is not None:
            impulse[:, self._held] = 0.0
        velocity += impulse
        np.multiply(velocity, self._time_step, out=self._step)
        position += self._step
        self._round_index += 1


def add_collisions(impulse: Floats, position: Floats, near: NearList) -> None:
    """Add collision forces fc(i, k) = (c_k − c_i) · min(0, 1 − 4/d²), the subtotal of one table after the other.

    Args:
        impulse: changed in place, (3, n_atoms).
        position: atom centres [length], (3, n_atoms).
        near: the pairs that may touch, up to date.
    """
    if not near.first.size:
        return
    difference = position.take(near.second, axis=1)
    difference -= position.take(near.first, axis=1)
    squared = difference * difference
    distance_squared = (squared[0] + squared[1]) + squared[2]
    touching = np.flatnonzero(~(distance_squared >= CONTACT_SQUARED))
    if not touching.size:
        return
    inverse = 1.0 / distance_squared[touching]
    force = np.minimum(0.0, 1.0 - CONTACT_SQUARED * inverse) * difference[:, touching]
    first, second = near.first[touching], near.second[touching]
    for start, stop in pairwise(touching.searchsorted(near.bounds).tolist()):
        if start < stop:
            scatter = Scatter(first[start:stop], second[start:stop], impulse.shape[1])
            impulse += scatter.total(force[:, start:stop])
