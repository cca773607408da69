"""How much energy a run can account for: what it starts with and what pushes put in; knows no stepper."""

from __future__ import annotations

import math
from typing import assert_never

import numpy as np

from atomsim.core.model import (
    DampingForce,
    HoldForce,
    Model,
    Observables,
    OscillateForce,
    PushForce,
    State,
    TetherForce,
    TorqueForce,
)

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
        for force in model.forces:
            match force:
                case PushForce() | OscillateForce():
                    push[force.atoms] += math.hypot(*force.impulse)
                case TorqueForce() | TetherForce():
                    self._is_known = False
                case HoldForce():
                    self._is_known &= not first.velocity[force.atoms].any()
                case DampingForce():
                    pass
                case _:
                    assert_never(force)
        largest = float(push.max()) or 1.0
        share = push / largest  # squares of the pushes themselves may not be finite
        self._push = largest * float(np.sqrt((share * share).sum()))

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


def total_energy(observables: Observables) -> float:
    """Return H, the sum of the three energies."""
    return observables.kinetic_energy + observables.potential_energy_bonds + observables.potential_energy_collisions
