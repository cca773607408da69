"""What is measured of a state: energies, momenta, contacts; knows nothing of how states come about."""

from __future__ import annotations

import numpy as np

from atomsim.core.model import BondTable, Floats, Model, Observables, State
from atomsim.core.numpy_backend.bonds import joined
from atomsim.core.pairs.collisions import CONTACT_SQUARED
from atomsim.core.pairs.near import STRETCH, pair_squares
from atomsim.core.pairs.near_list import NearList


class Observer:
    """Measures states of one model; remembers which collision pairs are near from one state to the next.

    Args:
        model: the compiled scene.
    """

    def __init__(self, model: Model) -> None:
        self._time_step = model.time_step
        self._bonds = [_Bonds(table) for table in joined(model.bonds)]
        self._near = NearList(model.collisions, model.n_atoms, skin=2.0)  # atoms have moved far from frame to frame

    def observe(self, state: State) -> Observables:
        """Return the observables of a state.

        The potential of a bond is U(d) = (d² − r²)/2 − r² ln(d/r), of a contact the same with r = 2; they are divided
        by τ because the impulse is not multiplied by it, and so the sum of the energies is conserved as τ → 0.
        """
        with np.errstate(all="ignore"):  # on its way to a blow-up a state is finite and its energy may not be
            return self._observe(state)

    def _observe(self, state: State) -> Observables:
        position, velocity = np.ascontiguousarray(state.position.T), np.ascontiguousarray(state.velocity.T)
        touching = self._touching(position)
        yzx, zxy = [1, 2, 0], [2, 0, 1]
        moment = position.take(yzx, axis=0) * velocity.take(zxy, axis=0)
        moment -= position.take(zxy, axis=0) * velocity.take(yzx, axis=0)
        return Observables(
            kinetic_energy=0.5 * float((velocity * velocity).sum()),
            potential_energy_bonds=sum(table.energy(position) for table in self._bonds) / self._time_step,
            potential_energy_collisions=float(contact_potential(touching).sum()) / self._time_step,
            momentum=velocity.sum(axis=1),
            angular_momentum=moment.sum(axis=1),
            contacts=touching.size,
        )

    def _touching(self, position: Floats) -> Floats:
        """Return d² of the pairs in contact, (n_contacts,)."""
        self._near.update(position)
        squared = pair_squares(position, self._near.first, self._near.second)
        return squared[squared < CONTACT_SQUARED]


class _Bonds:
    """The bonds of a table, cut into stretches that bound the memory their energy takes."""

    def __init__(self, table: BondTable) -> None:
        rest_squared = table.rest_squared
        divisor = rest_squared if rest_squared.all() else np.where(rest_squared == 0.0, 1.0, rest_squared)
        stretches = [slice(start, start + STRETCH) for start in range(0, table.first.size, STRETCH)]
        self._stretches = [
            (table.first[pairs], table.second[pairs], rest_squared[pairs], divisor[pairs]) for pairs in stretches
        ]

    def energy(self, position: Floats) -> float:
        """Return Σ U."""
        return sum(
            float(_potential(pair_squares(position, first, second), rest_squared, divisor).sum())
            for first, second, rest_squared, divisor in self._stretches
        )


def contact_potential(squared: Floats) -> Floats:
    """Return U of pairs in contact, from d²."""
    return _potential(squared, CONTACT_SQUARED, CONTACT_SQUARED)


def _potential(squared: Floats, rest_squared: Floats | float, divisor: Floats | float) -> Floats:
    """Return U = ½ (d² − r² − r² ln(d²/r²)); where r is zero the divisor is one, and the logarithm's term vanishes."""
    logarithm = squared / divisor
    np.log(logarithm, out=logarithm)
    logarithm *= rest_squared
    energy = squared - rest_squared
    energy -= logarithm
    energy *= 0.5
    return energy
