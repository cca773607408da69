"""Observables of a state: energies, momenta, contacts.

A frame is measured every few rounds, so this is as much in the way of a run as its rounds are. The atoms of a pair are
gathered as rows of four numbers, which NumPy copies several times faster than three numbers from three places, and
pairs are looked at a block at a time, which stays in the cache. Energies are summed in longer stretches: their length
decides about the last bits of a sum, that of the blocks about none.
"""

from __future__ import annotations

import numpy as np

from atomsim.core.model import BondTable, Floats, Indices, Model, Observables, State
from atomsim.core.numpy_backend.bonds import joined
from atomsim.core.pairs.collisions import CONTACT_SQUARED
from atomsim.core.pairs.near import STRETCH
from atomsim.core.pairs.near_list import NearList

BLOCK = 1 << 13
"""Pairs looked at together."""


class Observer:
    """Measures states of one model; remembers which collision pairs are near from one state to the next.

    Args:
        model: the compiled scene.
    """

    def __init__(self, model: Model) -> None:
        self._time_step = model.time_step
        self._bonds = [_Bonds(table) for table in joined(model.bonds)]
        self._near = NearList(model.collisions, model.n_atoms, skin=2.0)  # atoms have moved far from frame to frame
        self._rows = np.zeros((model.n_atoms, 4))
        self._position, self._velocity = np.empty((2, 5, model.n_atoms))

    def observe(self, state: State) -> Observables:
        """Return the observables of a state.

        The potential of a bond is U(d) = (d² − r²)/2 − r² ln(d/r), of a contact the same with r = 2; they are divided
        by τ because the impulse is not multiplied by it, and so the sum of the energies is conserved as τ → 0.
        """
        with np.errstate(all="ignore"):  # on its way to a blow-up a state is finite and its energy may not be
            return self._observe(state)

    def _observe(self, state: State) -> Observables:
        self._rows[:, :3] = state.position
        position, velocity = _cyclic(self._position, state.position), _cyclic(self._velocity, state.velocity)
        touching = self._touching(position[:3])
        moment = position[1:4] * velocity[2:5]
        moment -= position[2:5] * velocity[1:4]
        return Observables(
            kinetic_energy=0.5 * float((velocity[:3] * velocity[:3]).sum()),
            potential_energy_bonds=sum(table.energy(self._rows) for table in self._bonds) / self._time_step,
            potential_energy_collisions=float(contact_potential(touching).sum()) / self._time_step,
            momentum=velocity[:3].sum(axis=1),
            angular_momentum=moment.sum(axis=1),
            contacts=touching.size,
        )

    def _touching(self, position: Floats) -> Floats:
        """Return d² of the pairs in contact, (n_contacts,)."""
        self._near.update(position)
        first, second = self._near.first, self._near.second
        squared = np.empty(first.size)
        ends = np.empty((2, min(first.size, BLOCK), 4))
        for start in range(0, first.size, BLOCK):
            block = slice(start, start + BLOCK)
            _squares(self._rows, first[block], second[block], ends, squared[block])
        return squared[squared < CONTACT_SQUARED]


class _Bonds:
    """The bonds of a table, and the room to compute their energy in."""

    def __init__(self, table: BondTable) -> None:
        self._first, self._second, self._rest_squared = table.first, table.second, table.rest_squared
        # Where the rest is zero the divisor is one, and the logarithm's term vanishes.
        is_bound_to_meet = table.rest_squared == 0.0
        self._divisor = (
            np.where(is_bound_to_meet, 1.0, table.rest_squared) if is_bound_to_meet.any() else table.rest_squared
        )
        size = table.first.size
        self._stretches = [range(start, min(size, start + STRETCH)) for start in range(0, size, STRETCH)]
        self._energy = np.empty(min(size, STRETCH))
        self._ends = np.empty((2, min(size, BLOCK), 4))
        self._logarithm = np.empty(min(size, BLOCK))

    def energy(self, rows: Floats) -> float:
        """Return Σ U.

        Args:
            rows: atom centres and a zero, (n_atoms, 4).
        """
        return sum(self._energy_of(stretch, rows) for stretch in self._stretches)

    def _energy_of(self, stretch: range, rows: Floats) -> float:
        for start in stretch[::BLOCK]:
            block = slice(start, min(stretch.stop, start + BLOCK))
            energy = self._energy[block.start - stretch.start : block.stop - stretch.start]
            _squares(rows, self._first[block], self._second[block], self._ends, energy)
            logarithm = self._logarithm[: energy.size]
            _to_potential(energy, self._rest_squared[block], self._divisor[block], logarithm)
        return float(self._energy[: len(stretch)].sum())


def _cyclic(room: Floats, vectors: Floats) -> Floats:
    """Fill the rows x, y, z, x, y, (5, n_atoms), with vectors, (n_atoms, 3): rows 1 to 3 are y, z, x, and so on."""
    room[:3] = vectors.T
    room[3:] = room[:2]
    return room


def _squares(rows: Floats, first: Indices, second: Indices, ends: Floats, out: Floats) -> None:
    """Set `out` to d² = (dx·dx + dy·dy) + dz·dz of pairs of atoms.

    Args:
        rows: atom centres and a zero, (n_atoms, 4).
        first: one atom of each pair, (n_pairs,).
        second: the other.
        ends: room for both, (2, n_pairs or more, 4).
        out: (n_pairs,).
    """
    difference, from_first = ends[:, : out.size]
    rows.take(second, axis=0, out=difference, mode="clip")  # all atoms exist, and this mode does not ask again
    rows.take(first, axis=0, out=from_first, mode="clip")
    difference -= from_first
    difference *= difference
    np.add(difference[:, 0], difference[:, 1], out=out)
    out += difference[:, 2]


def contact_potential(squared: Floats) -> Floats:
    """Return U of pairs in contact, from d²."""
    energy = squared.copy()
    _to_potential(energy, CONTACT_SQUARED, CONTACT_SQUARED, np.empty_like(squared))
    return energy


def _to_potential(energy: Floats, rest_squared: Floats | float, divisor: Floats | float, logarithm: Floats) -> None:
    """Turn d² into U = ½ (d² − r² − r² ln(d²/r²)), using room for the logarithm."""
    np.divide(energy, divisor, out=logarithm)
    np.log(logarithm, out=logarithm)
    logarithm *= rest_squared
    energy -= rest_squared
    energy -= logarithm
    energy *= 0.5
