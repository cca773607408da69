"""Pairs that two rules declare, and which are so bound, or pushed apart, twice."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from atomsim.core.model import BondTable, Indices, atom_name
from atomsim.findings.before.declared import common_pair
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import counted


def declared_twice(subject: Subject) -> Iterator[Symptom]:
    """Find pairs in two bond rules, and pairs in two collisions; the later rule is the one to look at."""
    n_atoms = subject.model.n_atoms
    keys = [(table, table.first * n_atoms + table.second) for table in subject.model.bonds]
    for (one, known), (other, new) in combinations(keys, 2):
        common = new[np.isin(new, known, assume_unique=True)]
        if common.size:
            yield _bound_twice(subject, one, other, common)
    for first, second in combinations(subject.model.collisions, 2):
        pair = common_pair(first, second)
        if pair is not None:
            names = [atom_name(atom, subject.model.groups) for atom in pair]
            yield Symptom(
                at=("collisions", second.origin.name),
                names=(
                    ("collisions", first.origin.name),
                    ("collisions", second.origin.name),
                    *subject.group_paths(np.array(pair)),
                ),
                message=(
                    f"collisions.{first.origin.name} declares pairs of this one, too, such as {names[0]} and "
                    f"{names[1]}, so they push each other twice"
                ),
                remedy={"collisions": {second.origin.name: None}},
            )


def _bound_twice(subject: Subject, one: BondTable, other: BondTable, common: Indices) -> Symptom:
    ends = np.concatenate((common // subject.model.n_atoms, common % subject.model.n_atoms))
    pair = [atom_name(int(ends[place]), subject.model.groups) for place in (0, common.size)]
    return Symptom(
        at=("bonds", other.origin.name),
        names=(("bonds", one.origin.name), ("bonds", other.origin.name), *subject.group_paths(ends)),
        message=(
            f"bonds.{one.origin.name} binds {counted(common.size, 'pair')} of this one, too, such as {pair[0]} and "
            f"{pair[1]}, so they are bound twice as stiffly"
        ),
        remedy={"bonds": {other.origin.name: None}},
    )
