"""Lays forces from outside out for the kernels; knows no positions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import assert_never

import numpy as np

from atomsim.core.forces import is_pushing, oscillation
from atomsim.core.model import (
    ActingForce,
    DampingForce,
    Floats,
    Indices,
    OscillateForce,
    PushForce,
    TetherForce,
    TorqueForce,
    TowardsForce,
)
from atomsim.core.plans.records import Forces

DAMPING, PUSH, TORQUE, TETHER, TOWARDS = range(5)
"""What `Forces.kind` holds; a push is any force that is the same vector for all its atoms."""

AHEAD = 256
"""Rounds that pushes are computed for at a time."""

Numbers = tuple[float, ...]


def plan_forces(forces: Sequence[ActingForce], held: Indices, margin: int) -> Forces:
    """Lay out forces in their order, and the atoms that are held after them; slots begin at `margin`."""
    none = np.empty(0, dtype=np.int64)
    acts_on = [runs_of(force.atoms, margin) for force in forces]
    centres = [_centre_of(force) for force in forces]
    about = [runs_of(centre, margin) for centre in centres]
    coded = [_code(force) for force in forces]
    held_start, held_stop = runs_of(held, margin)
    tethers = [force for force in forces if isinstance(force, TetherForce)]
    rest_squared = [force.rest_squared if isinstance(force, TetherForce) else np.empty(0) for force in forces]
    first_rest = []
    n_rest = 0
    for (start, stop), rest in zip(acts_on, rest_squared, strict=True):
        first_rest.append(n_rest + np.cumsum(stop - start) - (stop - start))
        n_rest += rest.size
    return Forces(
        kind=np.array([kind for kind, _ in coded], dtype=np.int64),
        number=np.array([[*number, *[0.0] * (4 - len(number))] for _, number in coded]).reshape(-1, 4),
        first_run=_firsts([start.size for start, _ in acts_on]),
        run_start=np.concatenate([none, *(start for start, _ in acts_on)]),
        run_stop=np.concatenate([none, *(stop for _, stop in acts_on)]),
        first_about_run=_firsts([start.size for start, _ in about]),
        about_start=np.concatenate([none, *(start for start, _ in about)]),
        about_stop=np.concatenate([none, *(stop for _, stop in about)]),
        n_about=np.array([float(centre.size) for centre in centres]),
        rest_squared=np.concatenate([np.empty(0), *rest_squared]),
        target=np.concatenate([np.empty((3, 0)), *(force.target.T for force in tethers)], axis=1),
        first_rest=np.concatenate([none, *first_rest]),
        held_start=held_start,
        held_stop=held_stop,
    )


def _code(force: ActingForce) -> tuple[int, Numbers]:
    """Return a force's kind and its constants."""
    match force:
        case DampingForce():
            return DAMPING, (force.coefficient,)
        case PushForce() | OscillateForce():
            return PUSH, ()
        case TorqueForce():
            return TORQUE, (*force.axis, force.magnitude)
        case TowardsForce():
            return TOWARDS, (*force.target, force.magnitude)
        case TetherForce():
            return TETHER, ()
        case _:
            assert_never(force)


def _centre_of(force: ActingForce) -> Indices:
    """Return the atoms whose centroid a force needs."""
    match force:
        case TorqueForce():
            return force.about
        case TowardsForce():
            return force.centre
        case _:
            return np.empty(0, dtype=np.int64)


class Pushes:
    """The vectors that forces add uniformly, computed for some rounds ahead.

    Of a push towards something x tells whether it acts, as 1 or 0.
    """

    def __init__(self, forces: Sequence[ActingForce]) -> None:
        self._forces = forces
        self._rounds = range(0)
        self._vectors = np.empty((0, len(forces), 3))

    def ahead(self, round_index: int, n_rounds: int) -> Floats:
        """Return the vectors of the coming rounds, at most so many, (n, n_forces, 3); zero for other kinds of force."""
        if round_index not in self._rounds:
            self._rounds = range(round_index, round_index + AHEAD)
            self._vectors = np.zeros((AHEAD, len(self._forces), 3))
            for number, force in enumerate(self._forces):
                if isinstance(force, (PushForce, OscillateForce)):
                    share = np.array([_share_of(force, each) for each in self._rounds])
                    self._vectors[:, number] = share[:, None] * force.impulse
                elif isinstance(force, TowardsForce):
                    self._vectors[:, number, 0] = [is_pushing(force, each) for each in self._rounds]
        place = round_index - self._rounds.start
        return self._vectors[place : place + n_rounds]


def _share_of(force: PushForce | OscillateForce, round_index: int) -> float:
    """Return how much of its impulse a force adds in one round."""
    if isinstance(force, OscillateForce):
        return oscillation(force, round_index)
    return float(is_pushing(force, round_index))


def runs_of(atoms: Indices, margin: int) -> tuple[Indices, Indices]:
    """Return ascending atoms as runs of consecutive slots, start ≤ slot < stop."""
    if not atoms.size:
        return atoms, atoms
    breaks = np.flatnonzero(np.diff(atoms) > 1)
    start = atoms[np.concatenate(([0], breaks + 1))]
    stop = atoms[np.concatenate((breaks, [atoms.size - 1]))] + 1
    return start + margin, stop + margin


def _firsts(counts: list[int]) -> Indices:
    return np.concatenate(([0], np.cumsum(counts, dtype=np.int64)))
