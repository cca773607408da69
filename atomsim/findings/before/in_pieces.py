"""Groups that fall to pieces, because a threshold binds only part of their neighbours."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.numbering import numbered
from atomsim.core.model import Indices
from atomsim.core.pairs.near import distinct
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
    """Look at the groups of one selection, each copy by itself: parts that are all bound by one rule stay apart."""
    selected = subject.selections.atoms((expression,))
    is_bound = subject.is_bound_by(name)
    told = set()
    for part in distinct([subject.part[selected]]).tolist():
        atoms = selected[subject.part[selected] == part]
        group = subject.model.groups[int(subject.group[atoms[0]])].name
        size = np.bincount(numbered(subject.body[atoms]))
        if size.size > 1 and is_bound[atoms].any() and group not in told:
            told.add(group)
            yield _symptom(name, rule, group, size, widest_gap(places(subject, rule, expression, atoms), rule))


def _symptom(name: str, rule: DistanceThresholdBonds, group: str, size: Indices, gap: float | None) -> Symptom:
    alone = int((size == 1).sum())
    return Symptom(
        at=("bonds", name),
        names=(("bonds", name), ("groups", group)),
        message=(
            f"`threshold: {rule.threshold:g}` leaves {group} in {counted(size.size, 'piece')}"
            + (f", {counted(alone, 'atom')} of it alone" if alone else "")
            + (f": the widest gap to bridge is {gap:.3g}" if gap is not None else "")
        ),
        remedy={"bonds": {name: {"threshold": round_up(gap)}}} if gap is not None else {},
    )
