"""Atoms so fast that two of them can pass through each other between two rounds."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.meeting import Meeting
from atomsim.core.diagnosis.outlook import Outlook
from atomsim.core.model import CollisionTable, Floats
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.findings.before.declared import is_mentioned, sides
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, round_down, verb

FASTEST = 1.0
"""Two atoms that each move so far per round [length] can change places: contact is at distance 2."""


def tunnelling(subject: Subject) -> Iterator[Symptom]:
    """Find groups that are too fast for what they may touch: from the start, or by the time they first touch it."""
    told: set[str] = set()
    for symptom in _fast_from_the_start(subject):
        told.update(str(name) for section, name in symptom.names if section == "groups")
        yield symptom
    for ahead in sorted(subject.outlooks, key=_speed, reverse=True):  # the faster of two is to blame
        groups = subject.groups_of(ahead.mover.atoms)
        if told.isdisjoint(groups) and ahead.first is not None and ahead.first.round_index <= subject.scene.rounds:
            way = subject.model.time_step * float(np.sqrt(ahead.first.speed @ ahead.first.speed))
            if way >= FASTEST:
                told.update(groups, subject.groups_of(np.array([ahead.first.other])))
                yield _fast_at_contact(subject, ahead, ahead.first, way)


def _fast_from_the_start(subject: Subject) -> Iterator[Symptom]:
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


def _speed(ahead: Outlook) -> float:
    """Return the squared speed of a body at its first contact, if it has one."""
    velocity = ahead.mover.flight.at(ahead.first.round_index if ahead.first is not None else 0.0)[1]
    return float(velocity @ velocity)


def _fast_at_contact(subject: Subject, ahead: Outlook, meeting: Meeting, way: float) -> Symptom:
    """A body that is driven for so long, or so hard, that it passes through what it should touch."""
    groups, partner = subject.groups_of(ahead.mover.atoms), np.array([meeting.other])
    drives = sorted(ahead.mover.flight.drives, key=lambda drive: -float(drive.impulse @ drive.impulse))
    forces = [drive.force.origin.name for drive in drives[:1]]
    one = np.array([meeting.one])
    tables = [table for table in subject.model.collisions if is_mentioned(table, one, partner)[0]]
    when = math.ceil(meeting.round_index)
    time_step = round_down(0.5 * subject.model.time_step / way)
    return Symptom(
        at=("forces", forces[0]) if forces else ("groups", groups[0]),
        names=(
            *(("forces", name) for name in forces),
            *(("groups", name) for name in groups),
            *subject.group_paths(partner),
            *(("collisions", table.origin.name) for table in tables),
        ),
        message=(
            f"{listed(groups)} {verb(groups, 'moves', 'move')} {way:.3g} per round at the first contact with "
            f"{listed(subject.groups_of(partner))}, in round {when}, and so may pass through unseen (contact is at "
            f"distance 2); try time_step {time_step:g}, or a weaker force"
        ),
        remedy={"time_step": time_step},
        rounds=(when,),
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
