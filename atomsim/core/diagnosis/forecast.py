"""What a run is likely to do wrong, told from its model and first state before it begins; knows no files."""

from __future__ import annotations

import math

import numpy as np

from atomsim.core.diagnosis.overlaps import overlapping_groups, without_overlaps
from atomsim.core.diagnosis.stiffness import is_damped_too_much, is_surely_stable, largest_time_step
from atomsim.core.model import Between, CollisionTable, Indices, Model, State, TorqueForce, atom_name
from atomsim.core.observables import contact_potential
from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.core.pairs.near import distinct, squared_distance

SHORTEST_LEVER = 1e-6
"""Atoms nearer than this to the axis of a torque lie on it [length]: what is left is rounding, or jitter."""


def forecast(model: Model, state: State) -> list[str]:
    """Return warnings for the designer, each with the number behind it and what to change; empty if all is well.

    Args:
        model: the compiled scene.
        state: where the run begins.
    """
    with np.errstate(all="ignore"):  # infinite is a fair answer to absurd numbers
        return [
            *_instability(model, state),
            *_tunnelling(model, state),
            *_overlaps(model, state),
            *_idle_torques(model, state),
        ]


def _instability(model: Model, state: State) -> list[str]:
    """The scheme is stable only for τ · λmax < 4."""
    if is_surely_stable(model, state):
        return []
    limit = largest_time_step(model, state)
    if model.time_step < limit:
        return []
    damping = " with its damping" if is_damped_too_much(model, state) else ""
    return [
        f"time_step {model.time_step:g} is at or above {limit:.3g}, the largest that the stiffness of this scene "
        f"allows{damping}; expect it to blow up{_advice(0.5 * limit)}"
    ]


def _tunnelling(model: Model, state: State) -> list[str]:
    """Two atoms that move further per round than they are wide can pass through each other unseen."""
    speed_squared = (state.velocity * state.velocity).sum(axis=1)
    warnings = []
    for table in model.collisions:
        atoms = _atoms_of(table)
        fastest = int(atoms[np.argmax(speed_squared[atoms])])
        reach = 2.0 * model.time_step * float(np.sqrt(speed_squared[fastest]))
        if reach >= 2.0:
            warnings.append(
                f"{table.origin}: atoms of {model.group_of(fastest).name} move {reach / 2.0:.3g} per round, so two of "
                f"them may pass through each other (contact is at distance 2){_advice(model.time_step / reach)}"
            )
    return warnings


def _overlaps(model: Model, state: State) -> list[str]:
    """Atoms that overlap at the start and collide are pushed apart with the energy of the overlap."""
    position = np.ascontiguousarray(state.position.T)
    warnings = []
    for table in model.collisions:
        first, second = table_pairs_near(table, position, 2.0)
        if first.size:
            squared = squared_distance(position[:, first], position[:, second])
            deepest = int(squared.argmin())
            energy = float(contact_potential(squared).sum()) / model.time_step
            one, other = (atom_name(int(atoms[deepest]), model.groups) for atoms in (first, second))
            overlap = "1 pair overlaps" if first.size == 1 else f"{first.size} pairs overlap"
            warnings.append(
                f"{table.origin}: {overlap} at the start ({', '.join(overlapping_groups(model, first, second))}), most "
                f"{one} and {other} {np.sqrt(squared[deepest]):.3g} apart (contact is at 2); that releases the energy "
                f"{energy:.3g}; move them apart{without_overlaps(model, table, first, second)}"
            )
    return warnings


def _idle_torques(model: Model, state: State) -> list[str]:
    """A torque needs a lever: atoms off its axis."""
    warnings = []
    for force in model.forces:
        if isinstance(force, TorqueForce) and force.magnitude != 0.0:
            centre = state.position[force.about].mean(axis=0)
            lever = np.cross(force.axis, state.position[force.atoms] - centre)
            if np.abs(lever).max() < SHORTEST_LEVER:
                warnings.append(
                    f"{force.origin}: all its atoms lie on the axis, where a torque does nothing, or, a hair beside "
                    "it, throws them away; choose another `axis` or `about`"
                )
    return warnings


def _atoms_of(table: CollisionTable) -> Indices:
    """Return all atoms that a table lets collide."""
    sides = ((block.left, block.right) if isinstance(block, Between) else (block.atoms,) for block in table.blocks)
    return distinct([atoms for side in sides for atoms in side])


def _advice(limit: float) -> str:
    """Advise a time step of one digit, not above the limit: what a person would try; none for an absurd limit."""
    if not 1e-300 < limit < math.inf:
        return ""
    power = 10.0 ** math.floor(math.log10(limit))
    return f"; try time_step {math.floor(limit / power) * power:g}"
