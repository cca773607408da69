"""When a run has blown up, and what pushed whom: a report that a designer can act on; knows no files."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.energy import SLACK, EnergyBudget, total_energy
from atomsim.core.diagnosis.stiffness import is_damped_too_much, largest_time_step
from atomsim.core.forces import acting, law
from atomsim.core.model import DampingForce, Floats, Indices, Model, Observables, Origin, State, atom_name
from atomsim.core.pairs.collisions import CONTACT_SQUARED, table_pairs_near
from atomsim.core.pairs.near import pair_squares, squared_distance

FLOWN_APART = 1e6
"""An atom that moves further than this in one round [length] is no longer part of anything."""


def loss(model: Model, state: State, observables: Observables, budget: EnergyBudget, driven: float = 0.0) -> str | None:
    """Return what is wrong with the fastest atom of a state, or None while the run is sound.

    Args:
        model: the compiled scene.
        state: what was reached.
        observables: what was measured of it.
        budget: how much energy the scene accounts for.
        driven: Σ |G| over all rounds in which atoms were pushed from outside; see `EnergyBudget.at`.
    """
    if not (_is_surely_sound(model, observables) or is_sound(model, state)):
        return "flew off"
    energy, explained = total_energy(observables), budget.at(state.round_index, driven)
    if energy <= explained:
        return None
    return f"is the fastest, and the energy is {energy:.3g}, where the scene accounts for {explained / SLACK:.3g}"


def _is_surely_sound(model: Model, observables: Observables) -> bool:
    """Return whether the observables alone tell, which is cheaper than looking at every atom.

    No atom is faster than the root of twice the kinetic energy, and an infinite coordinate leaves no Σ c × v finite.
    """
    fastest = math.sqrt(2.0 * observables.kinetic_energy) * model.time_step
    return fastest <= FLOWN_APART and all(map(math.isfinite, observables.angular_momentum.tolist()))


def is_sound(model: Model, state: State) -> bool:
    """Return whether every number of a state is finite and no atom has flown off."""
    with np.errstate(all="ignore"):
        fastest = float(np.abs(state.velocity).max()) * model.time_step  # NaN and infinity pass through
    return bool(fastest <= FLOWN_APART) and bool(np.isfinite(state.position).all())


def explain(
    model: Model, first: State, before: State, after: State, lost: str = "flew off", forces: Floats | None = None
) -> str:
    """Say what happened in the round from a sound state to one that is not.

    Args:
        model: the compiled scene.
        first: where the run began.
        before: the last sound state.
        after: the state one round later.
        lost: what is wrong with its fastest atom.
        forces: what pushed the atoms from outside, (n_atoms, 3).

    Returns:
        A few lines: round, atom and group; the declaration that pushed it hardest, and against which atom; the largest
        time step that the stiffness allows, unless two atoms at one place or damping alone did it; what to change.
    """
    with np.errstate(all="ignore"):
        met = _meeting(model, before) or _meeting(model, after)
        if met is not None:
            return met
        atom = _first_lost(after)
        head = f"the simulation blew up in round {after.round_index}: {atom_name(atom, model.groups)} {lost}"
        overshoot = _overshoot(model, atom)
        if overshoot is not None:
            return f"{head}\n{overshoot}"
        pushes = _pushes(model, before, atom, forces)
        size, origin, partner = max(pushes, key=lambda push: push[0], default=(0.0, None, None))
    lines = [head]
    if origin is not None:
        against = f", against {atom_name(partner, model.groups)}" if partner is not None else ""
        lines.append(f"  pushed hardest by {origin}{against}, with an impulse of {size:.3g} in one round")
    return "\n".join([*lines, *_remedy(model, first, before)])


def not_again(model: Model, before: State, after: State, lost: str) -> str:
    """Say that what was lost between two states was not when the same rounds were computed again."""
    name = atom_name(_first_lost(after), model.groups)
    return (
        f"the simulation blew up between rounds {before.round_index} and {after.round_index}: {name} {lost}\n"
        "  these rounds were computed again, and nothing of it came back: the same sums had two results\n"
        "  remedy: run it again; if that helps now and then only, have the memory of this machine tested"
    )


def _remedy(model: Model, first: State, before: State) -> list[str]:
    """Compare the time step with what the stiffness allowed at first and just before, and say what to change."""
    time_step, limit = model.time_step, math.inf
    for when, state in (("of the scene", first), ("it had by then", before)):
        limit = largest_time_step(model, state)
        if time_step >= limit:
            damping, less = "", ""
            if is_damped_too_much(model, state):
                damping, less = " with its damping", ", or less damping"
            return [
                f"  time_step is {time_step:g}; the stiffness {when} allows less than {limit:.3g}{damping}",
                f"  remedy: a smaller time_step or fewer bonds per atom{less}",
            ]
    stiff = f"time_step {time_step:g} is below {limit:.3g}, the limit of the stiffness"
    return [
        f"  {'nothing here is elastic' if math.isinf(limit) else stiff}: look at speeds",
        "  remedy: weaker external forces, lower velocities, more damping, or a smaller time_step",
    ]


def _first_lost(state: State) -> int:
    """Return the first atom that is not finite, or else the fastest."""
    is_lost = ~(np.isfinite(state.position) & np.isfinite(state.velocity)).all(axis=1)
    return int(is_lost.argmax()) if is_lost.any() else int(np.abs(state.velocity).max(axis=1).argmax())


def _meeting(model: Model, state: State) -> str | None:
    """Report two atoms, bound or colliding, that are at one place, where their force is 0/0, if there are any."""
    if not np.isfinite(state.position).all():
        return None
    position = np.ascontiguousarray(state.position.T)
    pairs = [(table.origin, table.first, table.second) for table in model.bonds]
    pairs += [(table.origin, *table_pairs_near(table, position, 2.0)) for table in model.collisions]
    for origin, first, second in pairs:
        same = np.flatnonzero(pair_squares(position, first, second) == 0.0)
        if same.size:
            one, other = (atom_name(int(atoms[same[0]]), model.groups) for atoms in (first, second))
            return (
                f"the simulation blew up in round {state.round_index}: {one} and {other} met exactly\n"
                f"  {origin} acts between them, and at one place a force has no direction\n"
                "  remedy: another time_step or a tiny jitter, so that they miss each other; for a bond, a larger rest"
            )
    return None


def _overshoot(model: Model, atom: int) -> str | None:
    """Report damping that takes so much of an atom's velocity in a round that it comes back larger, if it does.

    v ← (1 − m) · v grows where m, the sum of all coefficients, is above 2, and at 2 with the weakest bond.
    """
    damping = [force for force in model.forces if isinstance(force, DampingForce) and atom in force.atoms]
    taken = sum(force.coefficient for force in damping)
    if taken < 2.0:
        return None
    return (
        f"  {', '.join(str(force.origin) for force in damping)} take {taken:g} times its velocity in a round\n"
        "  remedy: less damping, so that the coefficients on an atom add up to less than 2"
    )


def _pushes(
    model: Model, state: State, atom: int, forces: Floats | None
) -> Iterator[tuple[float, Origin | str, int | None]]:
    """Yield the strongest single force of every declaration on an atom: its size, where from, and the partner.

    Damping is none of them: what it resists is pushed by something else.
    """
    position = np.ascontiguousarray(state.position.T)
    velocity = np.ascontiguousarray(state.velocity.T)
    for table in model.bonds:
        yield from _strongest(table.origin, position, atom, table.first, table.second, table.rest_squared)
    for collision in model.collisions:
        first, second = table_pairs_near(collision, position, 2.0)
        rest_squared = np.full(first.size, CONTACT_SQUARED)
        yield from _strongest(collision.origin, position, atom, first, second, rest_squared)
    for force in acting(model.forces):
        if isinstance(force, DampingForce):
            continue
        impulse = np.zeros_like(position)
        law(force)(state.round_index, position, velocity, impulse)
        yield float(np.sqrt((impulse[:, atom] * impulse[:, atom]).sum())), force.origin, None
    if forces is not None:
        yield float(np.sqrt((forces[atom] * forces[atom]).sum())), "forces from outside", None


def _strongest(
    origin: Origin, position: Floats, atom: int, first: Indices, second: Indices, rest_squared: Floats
) -> Iterator[tuple[float, Origin, int | None]]:
    """Yield the strongest pair force of a table on an atom, if it has any."""
    mine = np.flatnonzero((first == atom) | (second == atom))
    if mine.size:
        squared = squared_distance(position[:, first[mine]], position[:, second[mine]])
        size = np.abs(1.0 - rest_squared[mine] / squared) * np.sqrt(squared)
        worst = int(np.argmax(size))
        yield float(size[worst]), origin, int(first[mine][worst] + second[mine][worst] - atom)
