"""Forces and collisions in vain, because all they act on is held."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import ExternalForce, HoldForce
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed


def force_on_held(subject: Subject) -> Iterator[Symptom]:
    """Find forces all of whose atoms are held; a hold that takes away several forces is the one to look at."""
    dead = [
        force
        for force in subject.model.forces
        if not isinstance(force, HoldForce) and subject.is_held[force.atoms].all()
    ]
    by_holds: dict[tuple[str, ...], list[ExternalForce]] = {}
    for force in dead:
        by_holds.setdefault(_holds_of(subject, force), []).append(force)
    for holds, forces in by_holds.items():
        names = [f"forces.{force.origin.name}" for force in forces]
        atoms = np.concatenate([force.atoms for force in forces])
        plural = len(forces) > 1
        yield Symptom(
            at=("forces", holds[0] if plural else forces[0].origin.name),
            names=(
                *(("forces", force.origin.name) for force in forces),
                *(("forces", hold) for hold in holds),
                *subject.group_paths(atoms),
            ),
            message=(
                f"{listed(names)} {'act' if plural else 'acts'} on atoms of {listed(subject.groups_of(atoms))} only, "
                f"which forces.{holds[0]} holds: nothing comes of {'them' if plural else 'it'}"
            ),
            remedy=_remedy(subject, holds[0], forces),
        )


def _holds_of(subject: Subject, force: ExternalForce) -> tuple[str, ...]:
    """Return the names of the forces that hold atoms of a force, in order."""
    return tuple(
        hold.origin.name
        for hold in subject.model.forces
        if isinstance(hold, HoldForce) and np.isin(force.atoms, hold.atoms).any()
    )


def _remedy(subject: Subject, hold: str, forces: list[ExternalForce]) -> dict[str, object]:
    """Hold what is left when the groups of these forces are let go, or, of a single force, leave it out."""
    if len(forces) == 1:
        return {"forces": {forces[0].origin.name: None}}
    freed = {group for force in forces for group in subject.groups_of(force.atoms)}
    kept = [part for part in subject.scene.forces[hold].acts_on if part.partition("[")[0].strip() not in freed]
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
