"""Forces and collisions in vain, because all they act on is held."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.forces import acting
from atomsim.core.model import HoldForce, Indices
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.core.pairs.near import distinct
from atomsim.findings.finding import Remedy, Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, verb
from atomsim.scene.language.selection import parse_selection


def force_on_held(subject: Subject) -> Iterator[Symptom]:
    """Find forces all of whose atoms are held; a hold that takes away several forces is the one to look at."""
    acted_on: dict[str, list[Indices]] = {}
    for force in acting(subject.model.forces):  # one that goes copy by copy is several
        acted_on.setdefault(force.origin.name, []).append(force.atoms)
    by_holds: dict[tuple[str, ...], dict[str, Indices]] = {}
    for name, parts in acted_on.items():
        if all(subject.is_held[atoms].all() for atoms in parts):
            atoms = distinct(parts)
            by_holds.setdefault(_holds_of(subject, atoms), {})[name] = atoms
    for holds, dead in by_holds.items():
        names, atoms = list(dead), distinct(list(dead.values()))
        groups = subject.groups_of(atoms)
        yield Symptom(
            at=("forces", holds[0] if len(names) > 1 else names[0]),
            names=(*(("forces", name) for name in (*names, *holds)), *subject.group_paths(atoms)),
            message=(
                f"{listed([f'forces.{name}' for name in names])} {verb(names, 'acts', 'act')} on atoms of "
                f"{listed(groups)} only, which forces.{holds[0]} holds: nothing comes of {verb(names, 'it', 'them')}"
            ),
            remedy=_remedy(subject, holds[0], names, groups),
        )


def _holds_of(subject: Subject, atoms: Indices) -> tuple[str, ...]:
    """Return the names of the forces that hold some of the atoms, in order."""
    holds = (hold for hold in subject.model.forces if isinstance(hold, HoldForce))
    return tuple(dict.fromkeys(hold.origin.name for hold in holds if np.isin(atoms, hold.atoms).any()))


def _remedy(subject: Subject, hold: str, forces: list[str], groups: list[str]) -> Remedy:
    """Hold what is left when the groups of these forces are let go, or, of a single force, leave it out."""
    if len(forces) == 1:
        return {"forces": {forces[0]: None}}
    kept = [part for part in subject.scene.forces[hold].acts_on if parse_selection(part).group not in groups]
    return {"forces": {hold: {"acts_on": kept} if kept else None}}


def collision_of_held(subject: Subject) -> Iterator[Symptom]:
    """Find collisions of nothing but held atoms, which pass through each other as if nothing were declared."""
    for table in subject.model.collisions:
        atoms = involved_atoms([table], subject.model.n_atoms)
        if subject.is_held[atoms].all():
            yield Symptom(
                at=("collisions", table.origin.name),
                names=(("collisions", table.origin.name), *subject.group_paths(atoms)),
                message=(
                    f"all of {listed(subject.groups_of(atoms))} that may collide here is held, and what is held gives "
                    "way to nothing: they pass through each other"
                ),
                remedy={"collisions": {table.origin.name: None}},
            )
