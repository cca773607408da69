"""How stiff a scene is and how large a time step it allows; knows bonds, tethers and contacts, linearised."""

from __future__ import annotations

import numpy as np

from atomsim.core.collisions import CONTACT_SQUARED, table_pairs_near
from atomsim.core.forces import held_atoms
from atomsim.core.model import Floats, Indices, Model, State, TetherForce

TOLERANCE = 1e-7
"""The iteration stops when a product changes the estimate by less than this; the error is then well below 1 %."""

MOST_PRODUCTS, FEWEST_PRODUCTS = 2000, 30
"""The most are enough for any scene tried, the fewest come within a few per cent."""

MOST_PULLS = 1 << 25
"""Between the two, products stop when so many springs have been pulled: after a second or two."""


def largest_time_step(model: Model, state: State) -> float:
    """Return the time step from which on the undamped scheme is unstable: 4 / λmax of the stiffness at a state.

    Limitations: the limit of a scene with millions of bonds may be a few per cent too high. The stiffness is that of
    the given shape. A scene that crowds atoms together later grows stiffer: each
    contact adds up to 2 to the stiffness of its atoms.

    Returns:
        The limit [time]; infinite where nothing is elastic.
    """
    stiffness = largest_stiffness(model, state)
    return 4.0 / stiffness if stiffness > 0.0 else np.inf


def is_surely_stable(model: Model, state: State) -> bool:
    """Return whether a bound that is cheaper than λmax, the largest sum of a row (Gershgorin), allows the time step."""
    with np.errstate(all="ignore"):
        return model.time_step * _Springs(model, state).bound() < 4.0


def largest_stiffness(model: Model, state: State) -> float:
    """Return the largest eigenvalue λmax of the linearised stiffness matrix K, by power iteration.

    For a pair at distance d with desired distance r the potential (d² − r²)/2 − r² ln(d/r) has the stiffness
    1 + r²/d² along the pair and 1 − r²/d² across it. It is infinite where numbers are too large to tell.
    """
    with np.errstate(all="ignore"):
        return _largest_eigenvalue(_Springs(model, state))


def _largest_eigenvalue(springs: _Springs) -> float:
    shape = np.random.default_rng(1).standard_normal((3, springs.n_atoms))
    largest = 0.0
    for _ in range(max(FEWEST_PRODUCTS, min(MOST_PRODUCTS, MOST_PULLS // max(1, springs.n_springs)))):
        shape = springs.push(shape)
        length = float(np.sqrt((shape * shape).sum()))
        if length == 0.0:
            return 0.0
        if not np.isfinite(length):
            return np.inf
        shape /= length
        if abs(length - largest) <= TOLERANCE * length:
            return length
        largest = length
    return largest


class _Springs:
    """The stiffness matrix as what it does to a displacement; atoms that are held do not move."""

    def __init__(self, model: Model, state: State) -> None:
        position = np.ascontiguousarray(state.position.T)
        contacts = [table_pairs_near(table, position, 2.0) for table in model.collisions]
        pairs = [(table.first, table.second, table.rest_squared) for table in model.bonds]
        pairs += [(first, second, np.full(first.size, CONTACT_SQUARED)) for first, second in contacts]
        none = np.empty(0, dtype=np.int64)
        self._first: Indices = np.concatenate([none, *(first for first, _, _ in pairs)])
        self._second: Indices = np.concatenate([none, *(second for _, second, _ in pairs)])
        rest_squared = np.concatenate([np.empty(0), *(rest for _, _, rest in pairs)])
        difference = position[:, self._second] - position[:, self._first]
        self._along, self._across, self._direction = _linearised(difference, rest_squared)
        self._tethers = [
            (force.atoms, *_linearised(np.array(force.target)[:, None] - position[:, force.atoms], force.rest_squared))
            for force in model.forces
            if isinstance(force, TetherForce)
        ]
        self._held = held_atoms(model.forces)
        self.n_atoms = model.n_atoms
        self.n_springs = self._first.size

    def bound(self) -> float:
        """Return a number that no eigenvalue exceeds."""
        stiffest = np.maximum(self._along, np.abs(self._across))
        row = 2.0 * np.bincount(self._first, weights=stiffest, minlength=self.n_atoms)
        row += 2.0 * np.bincount(self._second, weights=stiffest, minlength=self.n_atoms)
        for atoms, along, across, _ in self._tethers:
            row[atoms] += np.maximum(along, np.abs(across))
        return float(row.max())

    def push(self, shape: Floats) -> Floats:
        """Return K · shape, both (3, n_atoms)."""
        force = np.zeros_like(shape)
        stretch = shape[:, self._second] - shape[:, self._first]
        pull = _pull(stretch, self._along, self._across, self._direction)
        n_atoms = shape.shape[1]
        for component in range(3):
            force[component] += np.bincount(self._second, weights=pull[component], minlength=n_atoms)
            force[component] -= np.bincount(self._first, weights=pull[component], minlength=n_atoms)
        for atoms, along, across, direction in self._tethers:
            force[:, atoms] += _pull(shape[:, atoms], along, across, direction)
        force[:, self._held] = 0.0
        return force


def _linearised(difference: Floats, rest_squared: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the stiffness along and across each spring, and its direction."""
    squared = (difference * difference).sum(axis=0)
    squared[squared == 0.0] = 1.0  # a tether at its target, which the limit treats as a spring of stiffness one
    ratio = rest_squared / squared
    return 1.0 + ratio, 1.0 - ratio, difference / np.sqrt(squared)


def _pull(stretch: Floats, along: Floats, across: Floats, direction: Floats) -> Floats:
    """Return what springs answer to a stretch: along · n(n·s) + across · (s − n(n·s))."""
    part = direction * (direction * stretch).sum(axis=0)
    answer: Floats = along * part + across * (stretch - part)
    return answer
