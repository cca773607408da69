"""Motion that a damping stifles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from atomsim.core.diagnosis.flight import Drive, Flight, Mover
from atomsim.core.model import DampingForce
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, verb
from atomsim.scene.language.forces import Gravity

SHORT_WAY = 1.0
"""Who gets less far than this in a run [length] stands still."""

FARTHER = 4.0
"""So many times as far without damping: then the damping is to blame."""


def over_damped(subject: Subject) -> Iterator[Symptom]:
    """Find bodies that would get far in the run, and that a damping keeps where they are.

    Gravity that only presses a body onto what carries it does not count.
    """
    rounds = float(subject.scene.rounds)
    for ahead in subject.outlooks:
        mover = ahead.mover
        damping = _heaviest(subject, mover)
        if damping is None:
            continue
        lands = ahead.first is not None and ahead.first.round_index <= rounds
        drives = [drive for drive in mover.flight.drives if not lands or not _is_gravity(subject, drive)]
        way, free = (_way(mover.flight, drives, rounds, is_damped) for is_damped in (True, False))
        if way < SHORT_WAY and free >= FARTHER * SHORT_WAY:
            yield _symptom(subject, mover, damping, drives, way, free)


def _is_gravity(subject: Subject, drive: Drive) -> bool:
    return isinstance(subject.scene.forces[drive.force.origin.name], Gravity)


def _heaviest(subject: Subject, mover: Mover) -> DampingForce | None:
    """Return the damping that takes most from a body, of those that act on all of it."""
    forces = [
        force
        for force in subject.model.forces
        if isinstance(force, DampingForce) and force.coefficient and np.isin(mover.atoms, force.atoms).all()
    ]
    return max(forces, key=lambda force: force.coefficient, default=None)


def _way(flight: Flight, drives: Sequence[Drive], rounds: float, is_damped: bool) -> float:
    """Return how far a body gets from where it starts."""
    alone = flight.with_drives(drives)
    way, _ = (alone if is_damped else alone.without_damping()).at(rounds)
    return float(np.sqrt(way @ way))


def _symptom(
    subject: Subject, mover: Mover, damping: DampingForce, drives: Sequence[Drive], way: float, free: float
) -> Symptom:
    groups, name = subject.groups_of(mover.atoms), damping.origin.name
    coefficient = float(f"{damping.coefficient * max(way, 1e-3) / min(free, 20.0):.1g}")
    return Symptom(
        at=("forces", name),
        names=(
            ("forces", name),
            *subject.group_paths(mover.atoms),
            *(("forces", drive.force.origin.name) for drive in drives),
        ),
        message=(
            f"`coefficient: {damping.coefficient:g}` takes {damping.coefficient:.0%} of the velocity each round, so "
            f"{listed(groups)} {verb(groups, 'gets', 'get')} {way:.2g} far in {subject.scene.rounds:,} rounds; without "
            f"it, {free:.3g}"
        ),
        remedy={"forces": {name: {"coefficient": coefficient}}},
    )
