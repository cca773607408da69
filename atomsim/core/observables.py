"""What is measured of a state: energies, momenta, contacts; knows nothing of how states come about."""

from __future__ import annotations

import numpy as np

from atomsim.core.collisions import CONTACT_SQUARED, NearList
from atomsim.core.model import BondTable, Floats, Model, Observables, State
from atomsim.core.near import squared_distance


class Observer:
    """Measures states of one model; remembers which collision pairs are near from one state to the next.

    Args:
        model: the compiled scene.
    """

    def __init__(self, model: Model) -> None:
        self._time_step = model.time_step
        self._bonds = model.bonds
        self._near = NearList(model.collisions, model.n_atoms)

    def observe(self, state: State) -> Observables:
        """Return the observables of a state.

        The potential of a bond is U(d) = (d² − r²)/2 − r² ln(d/r), of a contact the same with r = 2; they are divided
        by τ because the impulse is not multiplied by it, and so the sum of the energies is conserved as τ → 0.
        """
        with np.errstate(all="ignore"):  # on its way to a blow-up a state is finite and its energy may not be
            return self._observe(state)

    def _observe(self, state: State) -> Observables:
        position = np.ascontiguousarray(state.position.T)
        velocity = state.velocity
        bonds = sum(_bond_energy(table, position) for table in self._bonds)
        self._near.update(position)
        collisions, contacts = 0.0, 0
        for first, second in self._near.pairs:
            squared = squared_distance(position[:, first], position[:, second])
            squared = squared[squared < CONTACT_SQUARED]
            contacts += squared.size
            collisions += float(potential(squared, CONTACT_SQUARED).sum())
        return Observables(
            kinetic_energy=0.5 * float((velocity * velocity).sum()),
            potential_energy_bonds=float(bonds) / self._time_step,
            potential_energy_collisions=collisions / self._time_step,
            momentum=velocity.sum(axis=0),
            angular_momentum=np.cross(state.position, velocity).sum(axis=0),
            contacts=contacts,
        )


def _bond_energy(table: BondTable, position: Floats) -> float:
    """Return Σ U over the bonds of a table."""
    squared = squared_distance(np.take(position, table.first, axis=1), np.take(position, table.second, axis=1))
    return float(potential(squared, table.rest_squared).sum())


def potential(squared: Floats, rest_squared: Floats | float) -> Floats:
    """Return U = ½ (d² − r² − r² ln(d²/r²)); the logarithm's term vanishes with r."""
    ratio = squared / np.where(np.equal(rest_squared, 0.0), 1.0, rest_squared)
    energy: Floats = 0.5 * (squared - rest_squared - rest_squared * np.log(ratio))
    return energy
