"""What a run is likely to do wrong, told from its model and first state before it begins; knows no files."""

from __future__ import annotations

import math

import numpy as np

from atomsim.core.collisions import table_pairs_near
from atomsim.core.model import Between, CollisionTable, Indices, Model, State, atom_name
from atomsim.core.near import squared_distance
from atomsim.core.observables import contact_potential
from atomsim.core.stiffness import is_surely_stable, largest_time_step


def forecast(model: Model, state: State) -> list[str]:
    """Return warnings for the designer, each with the number behind it and what to change; empty if all is well.

    Args:
        model: the compiled scene.
        state: where the run begins.
    """
    with np.errstate(all="ignore"):  # infinite is a fair answer to absurd numbers
        return [*_instability(model, state), *_tunnelling(model, state), *_overlaps(model, state)]


def _instability(model: Model, state: State) -> list[str]:
    """The undamped scheme is stable only for τ · λmax < 4."""
    if is_surely_stable(model, state):
        return []
    limit = largest_time_step(model, state)
    if model.time_step < limit:
        return []
    return [
        f"time_step {model.time_step:g} is at or above {limit:.3g}, the largest that the stiffness of this scene "
        f"allows; expect it to blow up{_advice(0.5 * limit)}"
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
            warnings.append(
                f"{table.origin}: {first.size} pairs overlap at the start, most {one} and {other} "
                f"{np.sqrt(squared[deepest]):.3g} apart (contact is at 2); that releases the energy {energy:.3g}"
            )
    return warnings


def _atoms_of(table: CollisionTable) -> Indices:
    """Return all atoms that a table lets collide."""
    sides = ((block.left, block.right) if isinstance(block, Between) else (block.atoms,) for block in table.blocks)
    return np.unique(np.concatenate([atoms for side in sides for atoms in side]))


def _advice(limit: float) -> str:
    """Advise a time step of one digit, not above the limit: what a person would try; none for an absurd limit."""
    if not 1e-300 < limit < math.inf:
        return ""
    power = 10.0 ** math.floor(math.log10(limit))
    return f"; try time_step {math.floor(limit / power) * power:g}"
