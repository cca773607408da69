"""What carries a falling body without being carried itself."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import OscillateForce, PushForce, TetherForce, TorqueForce, TowardsForce
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, verb


def floating_support(subject: Subject) -> Iterator[Symptom]:
    """Find bodies that something falls onto, and that nothing holds, pushes or tethers; damping holds nothing."""
    is_acted_on = subject.is_held.copy()
    for force in subject.model.forces:
        if isinstance(force, (OscillateForce, PushForce, TetherForce, TorqueForce, TowardsForce)):
            is_acted_on[force.atoms] = True
    carried = np.isin(subject.body, subject.body[is_acted_on])
    told = set()
    for ahead in subject.outlooks:
        if not ahead.mover.flight.lasting.any() or ahead.first is None:
            continue
        support = ahead.first.other
        if carried[support] or subject.body[support] in told:
            continue
        told.add(subject.body[support])
        atoms = np.flatnonzero(subject.body == subject.body[support])
        groups, falling = subject.groups_of(atoms), subject.groups_of(ahead.mover.atoms)
        yield Symptom(
            at=("groups", groups[0]),
            names=(*subject.group_paths(atoms), *subject.group_paths(ahead.mover.atoms)),
            message=(
                f"{listed(falling)} {verb(falling, 'falls', 'fall')} onto {listed(groups)}, which nothing holds: "
                f"{verb(groups, 'it', 'they')} will sink and drift away with the load"
            ),
            remedy={
                "forces": {subject.new_name("forces", "ground"): {"kind": "hold", "acts_on": groups[0]}},
            },
        )
