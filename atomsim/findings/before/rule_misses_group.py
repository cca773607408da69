"""Bond rules that name a selection and bind no atom of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import Indices
from atomsim.findings.before.gaps import nearest, places, widest_gap
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import round_up
from atomsim.scene.language import Bonds, DistanceThresholdBonds, NeighbourBonds


def rule_misses_group(subject: Subject) -> Iterator[Symptom]:
    """Find selections that a bond rule names in vain; one atom by itself has nothing to be bound to inside."""
    for name, rule in subject.scene.bonds.items():
        table = subject.bonds(name)
        is_bound = subject.is_bound_by(name)
        for expression in rule.within or ():
            atoms = subject.selections.atoms((expression,))
            if atoms.size > 1 and not (np.isin(table.first, atoms) & np.isin(table.second, atoms)).any():
                gap = None
                if isinstance(rule, DistanceThresholdBonds):
                    one = subject.selections.by_copy((expression,))[0]
                    gap = widest_gap(places(subject, rule, expression, one), rule)
                yield _symptom(subject, name, rule, expression, gap)
        for side, others in _sides(rule):
            for expression in side:
                atoms = subject.selections.atoms((expression,))
                if not is_bound[atoms].any():
                    yield _symptom(subject, name, rule, expression, _distance(subject, rule, atoms, others))


def _sides(rule: Bonds) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Yield each side of `between` with the other one."""
    if not isinstance(rule, NeighbourBonds) and rule.between is not None:
        yield rule.between
        yield rule.between[::-1]


def _distance(subject: Subject, rule: Bonds, atoms: Indices, others: tuple[str, ...]) -> float | None:
    if not isinstance(rule, DistanceThresholdBonds):
        return None
    right = subject.selections.atoms(others)
    return nearest(subject.placed[atoms].T, subject.placed[right].T, rule.threshold)


def _symptom(subject: Subject, name: str, rule: Bonds, expression: str, gap: float | None) -> Symptom:
    atoms = subject.selections.atoms((expression,))
    why, remedy = "", {}
    if isinstance(rule, DistanceThresholdBonds):
        why = f": nothing there is less than {rule.threshold:g} apart"
    if gap is not None:
        why += f", but {gap:.3g}"
        remedy = {"bonds": {name: {"threshold": round_up(gap)}}}
    return Symptom(
        at=("bonds", name),
        names=(("bonds", name), *subject.group_paths(atoms)),
        message=f"this rule binds no atom of {expression}{why}",
        remedy=remedy,
    )
