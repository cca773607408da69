"""Welds: bonds between parts that are meant to touch, or to move apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.overlaps import sparing
from atomsim.core.model import BondTable, CollisionTable, atom_name
from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.findings.before.declared import is_declared
from atomsim.findings.before.overlap_at_start import DEEP, remedy
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Mask, Subject
from atomsim.findings.words import counted, listed
from atomsim.scene.language import DistanceThresholdBonds

SHORTEST_REST = 1.9
"""Bound pairs that collide want to be 2 apart; a tenth less is a trifle, or the work of jitter."""


def weld(subject: Subject) -> Iterator[Symptom]:
    """Find rules that glue groups together, and bonds that pull together what a collision pushes apart."""
    for table in subject.model.bonds:
        is_across = subject.group[table.first] != subject.group[table.second]
        rule = subject.scene.bonds[table.origin.name]
        if is_across.any() and isinstance(rule, DistanceThresholdBonds) and rule.within is not None:
            yield _glued(subject, table, is_across)
            continue  # that they then fight with collisions goes without saying
        for collision in subject.model.collisions:
            collides = is_declared(collision, table.first, table.second)
            if not collides.any():
                continue
            if (is_fighting := collides & (table.rest_squared < SHORTEST_REST * SHORTEST_REST)).any():
                yield _fighting(subject, table, collision, is_fighting)
            elif isinstance(rule, DistanceThresholdBonds) and rule.between is not None:
                yield _bound_partners(subject, table, collision, collides)


def _glued(subject: Subject, table: BondTable, is_across: Mask) -> Symptom:
    """A rule inside a selection of several groups binds across their borders."""
    ends = np.concatenate((table.first[is_across], table.second[is_across]))
    selected = subject.groups_of(np.concatenate((table.first, table.second)))
    return Symptom(
        at=("bonds", table.origin.name),
        names=(("bonds", table.origin.name), *subject.group_paths(ends)),
        message=(
            f"{counted(int(is_across.sum()), 'bond')} of this rule "
            f"{'joins' if is_across.sum() == 1 else 'join'} {listed(subject.groups_of(ends))} to one body"
        ),
        remedy={"bonds": {table.origin.name: {"within": selected}}},
    )


def _fighting(subject: Subject, table: BondTable, collision: CollisionTable, is_fighting: Mask) -> Symptom:
    """Bonds keep pairs nearer than a collision lets them be."""
    first, second = table.first[is_fighting], table.second[is_fighting]
    near = table_pairs_near(collision, np.ascontiguousarray(subject.state.position.T), DEEP)
    rest = np.sqrt(table.rest_squared[is_fighting])
    shortest = int(rest.argmin())
    one, other = (atom_name(int(atoms[shortest]), subject.model.groups) for atoms in (first, second))
    return Symptom(
        at=("collisions", collision.origin.name),
        names=(
            ("collisions", collision.origin.name),
            ("bonds", table.origin.name),
            *subject.group_paths(np.concatenate((first, second))),
        ),
        message=(
            f"{counted(first.size, 'pair')} that bonds.{table.origin.name} keeps {rest[shortest]:.3g} apart or more "
            f"should be 2 apart here, such as {one} and {other}: the two pull and push for ever"
        ),
        remedy=remedy(collision, sparing(subject.model, collision, *(near if near[0].size else (first, second)))),
    )


def _bound_partners(subject: Subject, table: BondTable, collision: CollisionTable, collides: Mask) -> Symptom:
    """Parts that may collide are bound by distance, as they happen to stand near each other."""
    first, second = table.first[collides], table.second[collides]
    groups = np.concatenate((first, second))
    return Symptom(
        at=("bonds", table.origin.name),
        names=(
            ("bonds", table.origin.name),
            ("collisions", collision.origin.name),
            *subject.group_paths(groups),
        ),
        message=(
            f"this rule binds {counted(first.size, 'pair')} of {listed(subject.groups_of(groups))}, which "
            f"collisions.{collision.origin.name} lets collide: they are glued where they start"
        ),
        remedy={"bonds": {table.origin.name: None}},
    )
