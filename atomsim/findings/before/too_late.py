"""Bodies that reach what they may touch only long after the run is over."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, round_up

LATE = 2.0
"""A first contact after so many times the rounds is no matter of a run that was cut short."""


def too_late(subject: Subject) -> Iterator[Symptom]:
    """Find bodies on their way to a first contact that the run is far too short for."""
    rounds = subject.scene.rounds
    for ahead in subject.outlooks:
        if ahead.first is None or ahead.first.round_index <= LATE * rounds:
            continue
        groups = subject.groups_of(ahead.mover.atoms)
        partners = subject.groups_of(np.array([ahead.first.other]))
        when = math.ceil(ahead.first.round_index)
        yield Symptom(
            at=("groups", groups[0]),
            names=(
                *subject.group_paths(ahead.mover.atoms),
                *subject.group_paths(np.array([ahead.first.other])),
                ("rounds",),
            ),
            message=(
                f"{listed(groups)} would first touch {listed(partners)} in round {when:,}, and the run ends at "
                f"{rounds:,}: place it nearer, push it harder, or run longer"
            ),
            remedy={"rounds": int(round_up(1.1 * when))},
            rounds=(when,),
        )
