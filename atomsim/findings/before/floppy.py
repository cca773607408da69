"""Bodies that give way, because their bonds leave motions free beside moving and turning as a whole."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from atomsim.compiler.pairs import expand
from atomsim.core.diagnosis.bodies import bodies
from atomsim.core.diagnosis.clusters import Bars
from atomsim.core.diagnosis.rigidity import Rigidity, joint_rigidity, rigidity
from atomsim.core.model import BondTable, Indices
from atomsim.core.pairs.near import distinct
from atomsim.findings.finding import Remedy, Symptom
from atomsim.findings.subject import MOST_FOLLOWED, Subject, TooLargeError
from atomsim.findings.words import counted, listed
from atomsim.scene.language import (
    Bonds,
    DistanceThresholdBonds,
    ListedBonds,
    NeighbourBonds,
    PlaneGroup,
    StringGroup,
)

MOST_BODIES = 500
"""In scenes with more bodies none is looked at."""

WIDER = (1.3, 1.6, 2.0, 2.5)
"""How many times a threshold is tried to find one that makes a body stiff."""

MOST_REACH = 12
"""The longest reach that is tried."""


@dataclass(frozen=True, slots=True, eq=False)
class Loose:
    """A body that gives way.

    Attributes:
        atoms: ascending.
        groups: the numbers of the groups that they belong to, ascending.
        bars: the bonds between them, by their places in `atoms`.
        found: how floppy it is.
    """

    atoms: Indices
    groups: tuple[int, ...]
    bars: Bars
    found: Rigidity


def floppy(subject: Subject) -> Iterator[Symptom]:
    """Find rings, polygons, blocks and bodies of atoms that are not stiff; threads and cloths are not meant to be."""
    for loose in loose_bodies(subject, joints=False):
        yield _floppy(subject, loose)


def loose_joint(subject: Subject) -> Iterator[Symptom]:
    """Find bodies of several groups that can move against each other, each taken to be stiff: hinges, perhaps."""
    for loose in loose_bodies(subject, joints=True):
        yield _loose_joint(subject, loose)


def loose_bodies(subject: Subject, *, joints: bool, with_mode: bool = False) -> Iterator[Loose]:
    """Yield bodies of one group that are floppy, or of several groups that are loosely joined.

    Raises:
        TooLargeError: there are too many atoms or bodies, or one body is too large; what was found before is right.
    """
    model = subject.model
    size = np.bincount(subject.body, minlength=model.n_atoms)
    names = np.flatnonzero(size > 1)
    if model.n_atoms > MOST_FOLLOWED or names.size > MOST_BODIES:
        raise TooLargeError
    first, second = np.divmod(subject.bond_keys, model.n_atoms)
    is_open, told = False, set()
    for name in names.tolist():
        atoms = np.flatnonzero(subject.body == name)
        groups = tuple(distinct([subject.group[atoms]]).tolist())
        mine = subject.body[first] == name
        bars = Bars(np.searchsorted(atoms, first[mine]), np.searchsorted(atoms, second[mine]))
        if (len(groups) > 1) != joints or (not joints and _may_bend(subject, groups[0], atoms.size, bars)):
            continue
        position, is_held = subject.placed[atoms], subject.is_held[atoms]
        if joints:
            part = _parts(subject.group[atoms], bars)
            found = joint_rigidity(position, part, bars, is_held, with_mode=with_mode)
        else:
            found = rigidity(position, bars, is_held, with_mode=with_mode)
        if found.n_modes and (alike := (groups, atoms.size, found.n_modes)) not in told:  # copies are told once
            told.add(alike)
            yield Loose(atoms, groups, bars, found)
        is_open |= not found.is_exact and not found.n_modes
    if is_open:
        raise TooLargeError


def _may_bend(subject: Subject, group: int, n_atoms: int, bars: Bars) -> bool:
    """Return whether a body is a cloth or a thread: a plane, or a string with up to two bonds for each atom."""
    declared = subject.scene.groups[subject.model.groups[group].name]
    is_thread = isinstance(declared, StringGroup) and bars.first.size <= 2 * n_atoms
    return is_thread or isinstance(declared, PlaneGroup)


def _parts(group: Indices, bars: Bars) -> Indices:
    """Return the part of every atom of a body: what of one group hangs together by itself."""
    inside = group[bars.first] == group[bars.second]
    return bodies([(bars.first[inside], bars.second[inside])], group.size)


def _floppy(subject: Subject, loose: Loose) -> Symptom:
    span = subject.model.groups[loose.groups[0]]
    rules = [table for table in subject.model.bonds if np.isin(table.first, loose.atoms).any()]
    return Symptom(
        at=("bonds", rules[0].origin.name),
        names=(*(("bonds", table.origin.name) for table in rules), ("groups", span.name)),
        message=(
            f"{span.name} is floppy: the {counted(loose.bars.first.size, 'bond')} of its {loose.atoms.size:,} atoms "
            f"leave {_how_many(loose.found)} free, beside moving and turning as a whole"
        ),
        remedy=_stiffer(subject, rules, loose),
    )


def _loose_joint(subject: Subject, loose: Loose) -> Symptom:
    across = [
        table
        for table in subject.model.bonds
        if (np.isin(table.first, loose.atoms) & (subject.group[table.first] != subject.group[table.second])).any()
    ]
    groups = [subject.model.groups[number].name for number in loose.groups]
    return Symptom(
        at=("bonds", across[0].origin.name),
        names=(*(("bonds", table.origin.name) for table in across), *(("groups", name) for name in groups)),
        message=(
            f"{listed([f'bonds.{table.origin.name}' for table in across])} "
            f"{'joins' if len(across) == 1 else 'join'} {listed(groups)} loosely: {_how_many(loose.found)} of one part "
            f"against another {'is' if loose.found.n_modes == 1 else 'are'} free, as in a hinge"
        ),
        remedy=_stiffer(subject, across, loose),
    )


def _how_many(found: Rigidity) -> str:
    return f"{'' if found.is_exact else 'at least '}{counted(found.n_modes, 'motion')}"


def _stiffer(subject: Subject, rules: list[BondTable], loose: Loose) -> Remedy:
    """Return the smallest change of one of the rules that makes the body stiff, if a simple one does."""
    for table in rules:
        name = table.origin.name
        for keys, changed in _changes(subject.scene.bonds[name]):
            if not _is_loose_with(subject, table, changed, loose):
                return {"bonds": {name: keys}}
    return {}


def _changes(rule: Bonds) -> Iterator[tuple[dict[str, object], Bonds]]:
    """Yield changes of a rule that bind more, the smallest first: the keys to write, and the changed rule."""
    if isinstance(rule, NeighbourBonds):
        for reach in range(rule.reach + 1, MOST_REACH + 1):
            yield {"reach": reach}, rule.model_copy(update={"reach": reach})
    elif isinstance(rule, DistanceThresholdBonds):
        for times in WIDER:
            threshold = float(f"{times * rule.threshold:.2g}")
            yield {"threshold": threshold}, rule.model_copy(update={"threshold": threshold})
    elif isinstance(rule, ListedBonds):
        return


def _is_loose_with(subject: Subject, table: BondTable, changed: Bonds, loose: Loose) -> bool:
    """Return whether the body is still loose with another rule in place of one of its own."""
    n_atoms = subject.model.n_atoms
    others = [(other.first, other.second) for other in subject.model.bonds if other is not table]
    pairs = [*others, expand(changed, subject.selections, subject.placed)]
    key = distinct([one * n_atoms + other for one, other in pairs])
    first, second = np.divmod(key, n_atoms)
    inside = np.isin(first, loose.atoms) & np.isin(second, loose.atoms)
    ends = [np.searchsorted(loose.atoms, atoms[inside]) for atoms in (first, second)]
    bars, position, is_held = Bars(*ends), subject.placed[loose.atoms], subject.is_held[loose.atoms]
    if len(loose.groups) == 1:
        return bool(rigidity(position, bars, is_held).n_modes)
    return bool(joint_rigidity(position, _parts(subject.group[loose.atoms], bars), bars, is_held).n_modes)
