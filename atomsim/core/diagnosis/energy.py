"""How much energy a run can account for: what it starts with and what pushes put in; knows no stepper."""

from __future__ import annotations

import math

import numpy as np

from atomsim.core.forces import acting, held_atoms, strength
from atomsim.core.model import Floats, Model, Observables, State

SLACK = 1000.0
"""How far above its budget the energy must be; it swings by such factors only close to the stability limit."""

TRIFLE = 1.0
"""Less energy than this per atom is never too much."""


class EnergyBudget:
    """The most energy that a run can have at a round, or infinity where that cannot be told.

    Without external forces H = ½ Σ|v|² + (1/τ) Σ U is conserved as τ → 0. An impulse g_i per round on atom i changes H
    by at most |G|·|V| ≤ |G|·√(2H), with |G|² = Σ|g_i|², so that √(2H) grows by at most |G| per round. Damping and
    holding atoms at rest only take energy away. Torques, tethers and held atoms that move are not accounted for.

    Args:
        model: the compiled scene.
        first: where the scene begins.
        observables: what was measured of it.
    """

    def __init__(self, model: Model, first: State, observables: Observables) -> None:
        self._begin = math.sqrt(2.0 * total_energy(observables)) if total_energy(observables) > 0.0 else 0.0
        self._first_round = first.round_index
        self._trifle = TRIFLE * model.n_atoms
        push = np.zeros(model.n_atoms)
        self._is_known = True
        for force in acting(model.forces):
            most = strength(force)
            self._is_known &= most is not None
            push[force.atoms] += most or 0.0
        self._is_known &= not first.velocity[held_atoms(model.forces)].any()
        self._push = size(push)

    def at(self, round_index: int, driven: float = 0.0) -> float:
        """Return the most energy that can be explained at a round.

        Args:
            round_index: the round.
            driven: Σ |G| over all rounds in which atoms were pushed from outside, besides what the model does.
        """
        if not self._is_known:
            return math.inf
        root = self._begin + self._push * (round_index - self._first_round) + driven
        return SLACK * 0.5 * root * root + self._trifle  # a power would raise where a product becomes infinite


def size(numbers: Floats) -> float:
    """Return √Σ x² of all numbers, also where a square alone would not be finite."""
    largest = float(np.abs(numbers).max()) or 1.0
    share = numbers / largest
    return largest * float(np.sqrt((share * share).sum()))


def total_energy(observables: Observables) -> float:
    """Return H, the sum of the three energies."""
    return observables.kinetic_energy + observables.potential_energy_bonds + observables.potential_energy_collisions
