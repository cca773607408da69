"""Atoms so fast that two of them can pass through each other between two rounds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import CollisionTable, Floats
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.findings.before.declared import sides
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, round_down, verb

FASTEST = 1.0
"""Two atoms that each move so far per round [length] can change places: contact is at distance 2."""


def tunnelling(subject: Subject) -> Iterator[Symptom]:
    """Find groups that are too fast from the start for what they may touch."""
    velocity = subject.state.velocity
    speed = subject.model.time_step * np.sqrt((velocity * velocity).sum(axis=1))
    by_groups: dict[tuple[str, ...], list[CollisionTable]] = {}
    for table in subject.model.collisions:
        atoms = involved_atoms([table], subject.model.n_atoms)
        fast = atoms[speed[atoms] >= FASTEST]
        if fast.size and not _moves_as_one(table, velocity):
            by_groups.setdefault(tuple(subject.groups_of(fast)), []).append(table)
    for groups, tables in by_groups.items():
        yield _symptom(subject, list(groups), tables, speed)


def _moves_as_one(table: CollisionTable, velocity: Floats) -> bool:
    """Return whether no two atoms that may collide approach each other."""
    return all(
        bool((velocity[left] == velocity[left[0]]).all() and (velocity[right] == velocity[left[0]]).all())
        for left, right in sides(table)
    )


def _symptom(subject: Subject, fast: list[str], tables: list[CollisionTable], speed: Floats) -> Symptom:
    atoms = involved_atoms(tables, subject.model.n_atoms)
    furthest = float(speed[atoms].max())
    advice, remedy = "", {}
    if 1e-300 < (time_step := 0.5 * subject.model.time_step / furthest) < np.inf:
        advice, remedy = f"; try time_step {round_down(time_step):g}", {"time_step": round_down(time_step)}
    collisions = [f"collisions.{table.origin.name}" for table in tables]
    others = tuple(path for path in subject.group_paths(atoms) if path[1] not in fast)
    return Symptom(
        at=("groups", fast[0]),
        names=(
            *(("groups", name) for name in fast),
            *(("collisions", table.origin.name) for table in tables),
            *others,
        ),
        message=(
            f"atoms of {listed(fast)} move {furthest:.3g} per round, so they may pass unseen through what "
            f"{listed(collisions)} "
            f"{verb(collisions, 'lets', 'let')} them touch (contact is at distance 2){advice}"
        ),
        remedy=remedy,
        rounds=(0,),
    )
