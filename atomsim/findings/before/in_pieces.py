"""Groups that fall to pieces, because a threshold binds only part of their neighbours."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.numbering import numbered
from atomsim.findings.before.gaps import places, widest_gap
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import counted, round_up
from atomsim.scene.language import DistanceThresholdBonds


def in_pieces(subject: Subject) -> Iterator[Symptom]:
    """Find groups that a rule by distance binds, but not to one body; bonds of other rules count, too."""
    for name, rule in subject.scene.bonds.items():
        if isinstance(rule, DistanceThresholdBonds):
            for expression in rule.within or ():
                yield from _in_pieces(subject, name, rule, expression)


def _in_pieces(subject: Subject, name: str, rule: DistanceThresholdBonds, expression: str) -> Iterator[Symptom]:
    """Look at the groups of one selection, each by itself: parts that are all bound by one rule stay apart."""
    selected = subject.selections.atoms((expression,))
    is_bound = subject.is_bound_by(name)
    for number in sorted(set(subject.group[selected].tolist())):
        is_here = subject.group[selected] == number
        atoms = selected[is_here]
        size = np.bincount(numbered(subject.body[atoms]))
        if size.size == 1 or not is_bound[atoms].any():
            continue
        group = subject.model.groups[number].name
        alone = int((size == 1).sum())
        gap = widest_gap(places(subject, rule, expression)[:, is_here], rule.threshold)
        yield Symptom(
            at=("bonds", name),
            names=(("bonds", name), ("groups", group)),
            message=(
                f"`threshold: {rule.threshold:g}` leaves {group} in {counted(size.size, 'piece')}"
                + (f", {counted(alone, 'atom')} of it alone" if alone else "")
                + (f": the widest gap to bridge is {gap:.3g}" if gap is not None else "")
            ),
            remedy={"bonds": {name: {"threshold": round_up(gap)}}} if gap is not None else {},
        )
