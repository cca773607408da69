"""Proves that a backend works on this machine: it loads, and it gives the bits of the NumPy stepper."""

from __future__ import annotations

import numpy as np

from atomsim.core.backend import MakeStepper
from atomsim.core.digest import state_digest
from atomsim.core.model import BondTable, CollisionTable, DampingForce, Model, Origin, State, Within
from atomsim.core.numpy_backend.stepper import NumpyStepper

N_ATOMS = 40
N_ROUNDS = 20


def prove(make_stepper: MakeStepper) -> None:
    """Load or compile all that a backend needs, and compare some rounds of a small model with the NumPy stepper.

    Args:
        make_stepper: the backend.

    Raises:
        ArithmeticError: the bits differ.
    """
    model, state = _model(), _state()
    steppers = NumpyStepper(model, state), make_stepper(model, state)
    digests = set()
    for stepper in steppers:
        stepper.advance(N_ROUNDS // 2)
        stepper.set_forces(0.01 * state.position)
        stepper.advance(N_ROUNDS - N_ROUNDS // 2)
        reached = stepper.state()
        digests.add(state_digest(reached.position, reached.velocity))
    if len(digests) > 1:
        raise ArithmeticError("its arithmetic is not that of NumPy on this machine")


def _model() -> Model:
    """Return a model that every form of bonds, collisions and a force take part in."""
    origin = Origin("bonds", "proof", "<proof>", 1)
    atom = np.arange(N_ATOMS)
    first, second = np.triu_indices(N_ATOMS, 1)
    tables = (
        BondTable(origin, first, second, 0.3 * np.square(second - first)),
        BondTable(origin, atom[:-1], atom[1:], np.full(N_ATOMS - 1, 0.25)),
        BondTable(origin, atom[:1], atom[-1:], np.ones(1)),
    )
    collisions = CollisionTable(origin, (Within(atom, 2),))
    return Model("proof", 0.05, N_ATOMS, (), tables, (collisions,), (DampingForce(origin, atom, 0.1),))


def _state() -> State:
    """Return atoms on a curve that crosses itself nearly."""
    atom = np.arange(N_ATOMS)[:, None]
    position = np.hstack((0.4 * atom, (0.7 * atom) % 3.0, (0.3 * atom) % 2.0))
    return State(0, position, np.zeros_like(position))
