"""Atoms that overlap at the start and are pushed apart with the energy of the overlap."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.overlaps import Sparing, overlapping_groups, sparing
from atomsim.core.model import CollisionTable, Indices, atom_name
from atomsim.core.observables import contact_potential
from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.core.pairs.near import pair_squares
from atomsim.findings.finding import Remedy, Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import counted, round_up
from atomsim.scene.language import BlockGroup

DEEP = 1.9
"""Pairs nearer than this overlap [length]; a tenth less than contact is a trifle, or the work of jitter."""


def overlap_at_start(subject: Subject) -> Iterator[Symptom]:
    """Find pairs that may collide, are not bound to each other, and overlap before anything has moved."""
    position = np.ascontiguousarray(subject.state.position.T)
    jitter = subject.scene.jitter.amplitude if subject.scene.jitter is not None else 0.0
    for table in subject.model.collisions:
        first, second = table_pairs_near(table, position, max(0.0, DEEP - 2.0 * jitter))
        is_loose = ~subject.are_bound(first, second)
        first, second = first[is_loose], second[is_loose]
        if first.size:
            yield _symptom(subject, table, first, second)


def _symptom(subject: Subject, table: CollisionTable, first: Indices, second: Indices) -> Symptom:
    squared = pair_squares(subject.state.position.T, first, second)
    deepest = int(squared.argmin())
    energy = float(contact_potential(squared).sum()) / subject.model.time_step
    one, other = (atom_name(int(atoms[deepest]), subject.model.groups) for atoms in (first, second))
    spared = sparing(subject.model, table, first, second)
    looser = _looser_block(subject, first, second, math.sqrt(float(squared[deepest])))
    return Symptom(
        at=("collisions", table.origin.name),
        names=(("collisions", table.origin.name), *subject.group_paths(np.concatenate((first, second)))),
        message=(
            f"{counted(first.size, 'pair')} {'overlaps' if first.size == 1 else 'overlap'} at the start "
            f"({', '.join(overlapping_groups(subject.model, first, second))}), most {one} and {other}, "
            f"{np.sqrt(squared[deepest]):.3g} apart (contact is at 2); that releases the energy {energy:.3g}; "
            f"move them apart{'' if looser else in_words(spared)}"
        ),
        remedy=looser or remedy(table, spared),
        rounds=(0,),
    )


def _looser_block(subject: Subject, first: Indices, second: Indices, nearest: float) -> Remedy:
    """Return a larger spacing, where all that overlaps are loose atoms of one block, as of a fluid; else nothing."""
    names = subject.groups_of(np.concatenate((first, second)))
    declared = subject.scene.groups[names[0]]
    span = next(span for span in subject.model.groups if span.name == names[0])
    if len(names) > 1 or not isinstance(declared, BlockGroup) or not subject.is_loose[span.start : span.stop].all():
        return {}
    return {"groups": {names[0]: {"spacing": round_up(declared.spacing * 2.0 / nearest)}}}


def in_words(spared: Sparing) -> str:
    """Say which key leaves pairs out, as the end of a sentence."""
    if not spared.keys:
        return ""
    ((key, value),) = spared.keys.items()
    written = f"`{key}: {str(value).lower()}`"
    return f"; {written} would leave out all but {spared.n_left:,}" if spared.n_left else f", or write {written}"


def remedy(table: CollisionTable, spared: Sparing) -> Remedy:
    """Return what to write so that pairs are left out; nothing where no key does."""
    return {"collisions": {table.origin.name: spared.keys}} if spared.keys else {}
