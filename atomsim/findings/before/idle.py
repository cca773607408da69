"""Groups that nothing concerns, and scenes in which nothing happens."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import DampingForce, HoldForce, TetherForce
from atomsim.core.pairs.collisions import involved_atoms, table_pairs_near
from atomsim.core.pairs.near import pair_squares
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Mask, Subject

STRESS = 1e-6
"""Bonds that are this much off their rest set something in motion [length]."""


def idle(subject: Subject) -> Iterator[Symptom]:
    """Find scenes without force, speed or stress, or else groups that no rule names and that do not move."""
    if not _anything_moves(subject):
        first = next(iter(subject.scene.groups))
        yield Symptom(
            at=("forces",),
            names=(("forces",),),
            message="no force, no speed and no stress: nothing ever moves in this scene",
            remedy={"forces": {"weight": {"kind": "gravity", "acts_on": first, "impulse": [0, 0, -0.001]}}},
        )
        return
    is_named = _named_by_a_rule(subject)
    for span in subject.model.groups:
        atoms = slice(span.start, span.stop)
        if not is_named[atoms].any() and not subject.state.velocity[atoms].any():
            yield Symptom(
                at=("groups", span.name),
                names=(("groups", span.name),),
                message=f"no bond, no collision and no force names {span.name}, and it does not move",
                remedy={"groups": {span.name: None}},
            )


def _anything_moves(subject: Subject) -> bool:
    """Return whether anything can set the atoms in motion, apart from the trace of stress that jitter makes."""
    model, state = subject.model, subject.state
    if state.velocity.any():
        return True
    if any(not isinstance(force, (DampingForce, HoldForce, TetherForce)) for force in model.forces):
        return True
    placed = subject.placed.T
    for force in model.forces:
        if isinstance(force, TetherForce):
            away = np.sqrt(((placed[:, force.atoms] - force.target.T) ** 2).sum(axis=0))
            if (np.abs(away - np.sqrt(force.rest_squared)) > STRESS).any():
                return True
    for table in model.bonds:
        stretch = np.sqrt(pair_squares(placed, table.first, table.second)) - np.sqrt(table.rest_squared)
        if (np.abs(stretch) > STRESS).any():
            return True
    return any(
        table_pairs_near(table, np.ascontiguousarray(placed), 2.0 - STRESS)[0].size for table in model.collisions
    )


def _named_by_a_rule(subject: Subject) -> Mask:
    """Return whether a bond, a collision or a force acts on each atom, (n_atoms,)."""
    model = subject.model
    is_named = np.zeros(model.n_atoms, dtype=bool)
    is_named[involved_atoms(model.collisions, model.n_atoms)] = True
    for table in model.bonds:
        is_named[table.first] = is_named[table.second] = True
    for force in model.forces:
        is_named[force.atoms] = True
    return is_named
