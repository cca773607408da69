"""Balls that fall exactly onto others, so that a rounding error decides to which side they roll."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.meeting import Meeting
from atomsim.core.diagnosis.outlook import Outlook
from atomsim.core.model import Indices
from atomsim.core.pairs.near import distinct, near_pairs
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, verb

OFF_AXIS = 1e-9
"""Who falls onto another this far off its middle [length] falls exactly onto it."""


def symmetric(subject: Subject) -> Iterator[Symptom]:
    """Find single atoms that fall exactly onto others in a scene without jitter."""
    if subject.scene.jitter is not None and subject.scene.jitter.amplitude > 0.0:
        return
    for ahead in subject.outlooks:
        meeting = ahead.first
        if meeting is None or not ahead.mover.is_loose or not ahead.mover.flight.lasting.any():
            continue
        exact = _exactly_below(subject, ahead, meeting)
        if exact.size:
            yield _symptom(subject, ahead, exact)


def _exactly_below(subject: Subject, ahead: Outlook, meeting: Meeting) -> Indices:
    """Return the single atoms that atoms of the mover hit in their very middle when the first one touches."""
    partners = subject.surroundings.alike(ahead.partners, meeting.other)
    partners = partners[subject.is_loose[partners]]
    position = subject.surroundings.position
    along = meeting.speed / np.sqrt(meeting.speed @ meeting.speed)
    moving, met = position[:, ahead.mover.atoms] + meeting.way[:, None], position[:, partners]
    across = [atoms - along[:, None] * (along @ atoms) for atoms in (moving, met)]
    one, other = near_pairs(across[0], across[1], OFF_AXIS)
    is_ahead = along @ (met[:, other] - moving[:, one]) > 0.0
    return partners[distinct([other[is_ahead]])]


def _symptom(subject: Subject, ahead: Outlook, exact: Indices) -> Symptom:
    groups, partners = subject.groups_of(ahead.mover.atoms), subject.groups_of(exact)
    return Symptom(
        at=("groups", groups[0]),
        names=(*subject.group_paths(ahead.mover.atoms), *subject.group_paths(exact)),
        message=(
            f"{listed(groups)} {verb(groups, 'falls', 'fall')} exactly onto atoms of {listed(partners)}, so a rounding "
            "error decides to which side it rolls off, if at all"
        ),
        remedy={"jitter": {"amplitude": 0.001}},
        rounds=(int(np.ceil(ahead.first.round_index)),) if ahead.first is not None else (),
    )
