"""Groups that come near each other though nothing is said of it: they will pass through one another."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.model import Indices
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.core.pairs.near import distinct, near_pairs, pair_squares
from atomsim.findings.before.declared import is_mentioned
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import MOST_FOLLOWED, Mask, Subject, TooLargeError

GRAZE = 1.5
"""Nearer than this is no graze [length]: contact is at 2."""


def ghost_contact(subject: Subject) -> Iterator[Symptom]:
    """Find groups that overlap at the start, or that a body which may touch nothing moves into."""
    if subject.model.n_atoms > MOST_FOLLOWED:
        raise TooLargeError
    told = set()
    for one, other, distance, round_index in (*_overlapping(subject), *_crossed(subject)):
        if (one, other) not in told:
            told.add((one, other))
            yield _symptom(subject, one, other, distance, round_index)


def _overlapping(subject: Subject) -> Iterator[tuple[int, int, float, int]]:
    """Yield pairs of groups that overlap at the start, with the smallest distance."""
    position = np.ascontiguousarray(subject.state.position.T)
    first, second = near_pairs(position, None, GRAZE)
    passing = may_pass(subject, first, second)
    first, second = first[passing], second[passing]
    squared = pair_squares(position, first, second)
    key = subject.group[first] * len(subject.model.groups) + subject.group[second]
    for pair in distinct([key]).tolist():
        one, other = divmod(pair, len(subject.model.groups))
        yield one, other, math.sqrt(float(squared[key == pair].min())), 0


def may_pass(subject: Subject, first: Indices, second: Indices) -> Mask:
    """Return which pairs of different groups, not both held, nothing is said of: no collision, no common bond."""
    one, other = subject.group[first], subject.group[second]
    passing: Mask = (one != other) & ~subject.are_joined[one, other]
    passing &= ~(subject.is_held[first] & subject.is_held[second])
    for table in subject.model.collisions:
        passing[passing] = ~is_mentioned(table, first[passing], second[passing])
    return passing


def _crossed(subject: Subject) -> Iterator[tuple[int, int, float, int]]:
    """Yield groups that a body meets before it touches anything, with the distance and the round."""
    is_turning = np.zeros(subject.model.n_atoms, dtype=bool)
    for mover in subject.movers:
        is_turning[mover.atoms] = mover.is_turning
    for ahead in subject.outlooks:
        mover = ahead.mover
        if mover.is_turning:
            continue
        last = min(float(subject.scene.rounds), ahead.first.round_index if ahead.first is not None else math.inf)
        own, partners = distinct([subject.group[mover.atoms]]), distinct([subject.group[ahead.partners]])
        is_stranger: Mask = ~np.asarray(subject.are_joined[own].any(axis=0))
        is_stranger[own] = is_stranger[partners] = False
        strangers = np.flatnonzero(is_stranger[subject.group] & ~is_turning)
        for meeting in subject.surroundings.meetings(mover, strangers, GRAZE, last):
            one, other = sorted((int(subject.group[meeting.one]), int(subject.group[meeting.other])))
            yield one, other, meeting.distance, math.ceil(meeting.round_index)


def _symptom(subject: Subject, one: int, other: int, distance: float, round_index: int) -> Symptom:
    names = [subject.model.groups[number].name for number in (one, other)]
    near = f"are {distance:.2f} apart at the start (contact is at 2)"
    if round_index:
        near = f"come nearer than {GRAZE:g} in round {round_index}"
    return Symptom(
        at=("groups", names[lacking(subject, one, other)]),
        names=tuple(("groups", name) for name in names),
        message=(f"{names[0]} and {names[1]} {near} and may not touch: they pass through one another"),
        remedy={"collisions": {subject.new_name("collisions", "_".join(names)): {"between": names}}},
        rounds=(round_index,),
    )


def lacking(subject: Subject, one: int, other: int) -> int:
    """Return which of two groups lacks the collision: the one without any, or else the one that moves; else the later.

    Returns:
        0 for the first, 1 for the other.
    """
    spans = [subject.model.groups[number] for number in (one, other)]
    involved = involved_atoms(subject.model.collisions, subject.model.n_atoms)
    has_any = [bool(((involved >= span.start) & (involved < span.stop)).any()) for span in spans]
    if has_any[0] != has_any[1]:
        return has_any.index(False)
    is_held = [bool(subject.is_held[span.start : span.stop].all()) for span in spans]
    return is_held.index(False) if is_held[0] != is_held[1] else 1
