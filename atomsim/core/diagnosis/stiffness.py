"""How stiff a scene is and how large a time step it allows; knows bonds, tethers and contacts, linearised."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from atomsim.core.forces import held_atoms
from atomsim.core.model import DampingForce, Floats, Indices, Model, State, TetherForce
from atomsim.core.pairs.collisions import CONTACT_SQUARED, table_pairs_near
from atomsim.core.pairs.near import STRETCH

TOLERANCE = 1e-7
"""The iteration stops when a product changes the estimate by less than this; the error is then well below 1 %."""

MOST_PRODUCTS, FEWEST_PRODUCTS = 2000, 30
"""The most are enough for any scene tried, the fewest come within a few per cent."""

MOST_PULLS = 1 << 25
"""Between the two, products stop when so many springs have been pulled: after a second or two."""


def largest_time_step(model: Model, state: State) -> float:
    """Return the time step from which on the linearised scheme is unstable: 4 / λmax of the stiffness at a state.

    Limitations: the limit of a scene with millions of bonds may be a few per cent too high. The stiffness is that of
    the given shape; a scene that crowds atoms together later grows stiffer, by up to 2 for each contact of an atom.

    Returns:
        The limit [time]; infinite where nothing is elastic.
    """
    stiffness = largest_stiffness(model, state)
    return 4.0 / stiffness if stiffness > 0.0 else np.inf


def is_surely_stable(model: Model, state: State, more: float = 0.0) -> bool:
    """Return whether a bound that is cheaper than λmax, the largest sum of a row (Gershgorin), allows the time step.

    Args:
        model: the compiled scene.
        state: the shape it has.
        more: stiffness to come on top of λmax.
    """
    with np.errstate(all="ignore"):
        return model.time_step * (_Springs(model, state).bound() + more) < 4.0


def largest_stiffness(model: Model, state: State) -> float:
    """Return the largest eigenvalue λmax of the linearised stiffness matrix K, by power iteration.

    Damping makes a scene stiffer. A motion of stiffness λ in which each round takes the share m of the velocity,
    v ← (1 − m)·v − λ·c, c ← c + τ·v, has a map with the determinant 1 − m and the trace 2 − m − τλ, so it is stable for
    τλ < 4 − 2m. With an m for each atom, an eigenvalue of the map becomes −1 where 4 − 2M − τK is singular, so K is
    taken relative to 1 − M/2: as (1 − M/2)^(−½) · K · (1 − M/2)^(−½).

    For a pair at distance d with desired distance r the potential (d² − r²)/2 − r² ln(d/r) has the stiffness
    1 + r²/d² along the pair and 1 − r²/d² across it. It is infinite where numbers are too large to tell.
    """
    with np.errstate(all="ignore"):
        return _largest_eigenvalue(_Springs(model, state))


def is_damped_too_much(model: Model, state: State) -> bool:
    """Return whether a time step that is too large would not be too large without damping."""
    undamped = tuple(force for force in model.forces if not isinstance(force, DampingForce))
    return undamped != model.forces and model.time_step < largest_time_step(replace(model, forces=undamped), state)


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
    """The stiffness matrix, relative to what damping leaves, as what it does to a displacement.

    Atoms that are held do not move.
    """

    def __init__(self, model: Model, state: State) -> None:
        position = np.ascontiguousarray(state.position.T)
        contacts = [table_pairs_near(table, position, 2.0) for table in model.collisions]
        self._position = position
        self._pairs = [(table.first, table.second, table.rest_squared) for table in model.bonds]
        self._pairs += [(first, second, np.full(first.size, CONTACT_SQUARED)) for first, second in contacts]
        self._tethers = [
            (force.atoms, *_linearised(force.target.T - position[:, force.atoms], force.rest_squared))
            for force in model.forces
            if isinstance(force, TetherForce)
        ]
        self._held = held_atoms(model.forces)
        self._left = _left_by_damping(model, self._held)
        self._scale = 1.0 / np.sqrt(self._left)
        self.n_atoms = model.n_atoms
        self.n_springs = sum(first.size for first, _, _ in self._pairs)
        self._kept = list(self._linearise()) if self.n_springs <= STRETCH else None

    def bound(self) -> float:
        """Return a number that no eigenvalue exceeds."""
        row = np.zeros(self.n_atoms)
        for spring in self._bundles():
            stiffest = np.maximum(spring.along, np.abs(spring.across))
            row += 2.0 * np.bincount(spring.first, weights=stiffest, minlength=self.n_atoms)
            row += 2.0 * np.bincount(spring.second, weights=stiffest, minlength=self.n_atoms)
        for atoms, along, across, _ in self._tethers:
            row[atoms] += np.maximum(along, np.abs(across))
        return float((row / self._left).max())

    def push(self, shape: Floats) -> Floats:
        """Return K · shape, both (3, n_atoms)."""
        shape = self._scale * shape
        force = np.zeros_like(shape)
        for spring in self._bundles():
            stretch = np.take(shape, spring.second, axis=1) - np.take(shape, spring.first, axis=1)
            pull = _pull(stretch, spring.along, spring.across, spring.direction)
            for component in range(3):
                force[component] += np.bincount(spring.second, weights=pull[component], minlength=self.n_atoms)
                force[component] -= np.bincount(spring.first, weights=pull[component], minlength=self.n_atoms)
        for atoms, along, across, direction in self._tethers:
            force[:, atoms] += _pull(shape[:, atoms], along, across, direction)
        force[:, self._held] = 0.0
        return self._scale * force

    def _bundles(self) -> Iterable[_Bundle]:
        """Return all springs; many of them are linearised anew each time rather than kept."""
        return self._linearise() if self._kept is None else self._kept

    def _linearise(self) -> Iterator[_Bundle]:
        for first, second, rest_squared in self._pairs:
            for start in range(0, first.size, STRETCH):
                pairs = slice(start, start + STRETCH)
                ends = [np.take(self._position, atoms[pairs], axis=1) for atoms in (first, second)]
                yield _Bundle(first[pairs], second[pairs], *_linearised(ends[1] - ends[0], rest_squared[pairs]))


def _left_by_damping(model: Model, held: Indices) -> Floats:
    """Return 1 − m/2 for each atom, m the sum of the coefficients that act on it; 0 where they are 2 or more."""
    left = np.ones(model.n_atoms)
    for force in model.forces:
        if isinstance(force, DampingForce):
            left[force.atoms] -= 0.5 * force.coefficient
    left[held] = 1.0
    return np.maximum(left, 0.0)


class _Bundle(NamedTuple):
    """Some springs: their atoms, their stiffness along and across, their directions (3, n_springs)."""

    first: Indices
    second: Indices
    along: Floats
    across: Floats
    direction: Floats


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
