"""Holes: surfaces whose atoms are so far apart that what they should carry fits between them."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.outlook import may_touch
from atomsim.core.model import Floats, GroupSpan, Indices
from atomsim.core.pairs.near import distinct
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed
from atomsim.scene.language import PlaneGroup, StringGroup

CONTACT = 2.0
"""Who is farther than this from all corners of a cell touches nothing [length]."""


def hole(subject: Subject) -> Iterator[Symptom]:
    """Find planes with cells that atoms, threads and cloths fit through, or stiff bodies that are small."""
    for span in subject.model.groups:
        plane = subject.scene.groups[span.name]
        if not isinstance(plane, PlaneGroup) or min(plane.counts) < 2:
            continue
        reach = circumradius(np.array(plane.step_x), np.array(plane.step_y))
        if reach < CONTACT:
            continue
        atoms = np.arange(span.start, span.stop)
        passing = [group for group in _partners(subject, atoms) if reach >= CONTACT + _half_extent(subject, group)]
        passing = [group for group in passing if not is_backed(subject, span, plane, group)]
        if passing:
            yield _symptom(subject, span, plane, reach, [group.name for group in passing])


def circumradius(step_x: Floats, step_y: Floats) -> float:
    """Return how far the middle of a cell is from its nearest atoms: the circumradius of the lattice's acute triangle.

    Args:
        step_x: from each atom of a plane to the next [length], (3,).
        step_y: likewise along the other side of the grid.
    """
    a, b = step_x, step_y
    for _ in range(64):  # Lagrange's reduction to the shortest steps
        if a @ a > b @ b:
            a, b = b, a
        if not a @ a > 0.0:
            return 0.0
        times = round(float(a @ b) / float(a @ a))
        if not times:
            break
        b = b - times * a
    if a @ b < 0.0:
        b = -b
    area = float(np.sqrt(np.square(np.cross(a, b)).sum()))
    sides = [math.sqrt(float(side @ side)) for side in (a, b, b - a)]
    return math.prod(sides) / (2.0 * area) if area > 0.0 else 0.0


def _partners(subject: Subject, atoms: Indices) -> list[GroupSpan]:
    """Return the other groups that a surface may touch, where not both are held."""
    partners = may_touch(subject.model.collisions, atoms, subject.model.n_atoms)
    if subject.is_held[atoms].all():
        partners = partners[~subject.is_held[partners]]
    return [subject.model.groups[number] for number in distinct([subject.group[partners]]).tolist()]


def _half_extent(subject: Subject, span: GroupSpan) -> float:
    """Return half the extent of a stiff body; 0 for what bends: loose atoms, threads and cloths."""
    atoms = np.arange(span.start, span.stop)
    n_bonds = int(np.isin(subject.bond_keys // subject.model.n_atoms, atoms).sum())
    declared = subject.scene.groups[span.name]
    bends = isinstance(declared, PlaneGroup) or (isinstance(declared, StringGroup) and n_bonds <= 2 * atoms.size)
    if bends or not n_bonds:
        return 0.0
    position = subject.state.position[atoms]
    return float(np.sqrt(np.square(position - position.mean(axis=0)).sum(axis=1).max()))


def is_backed(subject: Subject, span: GroupSpan, plane: PlaneGroup, group: GroupSpan) -> bool:
    """Return whether something else that a group may touch lies behind the middle of every cell."""
    atoms = np.arange(group.start, group.stop)
    others = may_touch(subject.model.collisions, atoms, subject.model.n_atoms)
    others = others[(others < span.start) | (others >= span.stop)]
    if not others.size:
        return False
    one = subject.state.position[span.start : span.start + subject.layouts[span.name].n_atoms_each]
    grid = one.reshape(plane.counts[1], plane.counts[0], 3)
    middle = (0.25 * (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:])).reshape(-1, 3)
    normal = np.cross(grid[0, 1] - grid[0, 0], grid[1, 0] - grid[0, 0])
    normal = normal / np.sqrt(normal @ normal)
    side = float(normal @ (subject.state.position[atoms].mean(axis=0) - grid[0, 0]))
    behind = -math.copysign(1.0, side) * normal
    away = subject.state.position[others][None, :, :] - middle[:, None, :]
    depth = away @ behind
    across = np.sqrt(np.maximum(np.square(away).sum(axis=2) - depth * depth, 0.0))
    return bool(((depth > 0.0) & (across < CONTACT)).any(axis=1).all())


def _symptom(subject: Subject, span: GroupSpan, plane: PlaneGroup, reach: float, passing: list[str]) -> Symptom:
    return Symptom(
        at=("groups", span.name),
        names=(("groups", span.name), *(("groups", name) for name in passing)),
        message=(
            f"the middle of a cell of {span.name} is {reach:.3g} from its corners, so {listed(passing)} can pass "
            "through without touching (contact is at 2)"
        ),
        remedy={"groups": {span.name: _finer(plane, reach)}},
    )


def _finer(plane: PlaneGroup, reach: float) -> dict[str, object]:
    """Return the keys of the same surface with more atoms: half the diagonal becomes at most 1.2."""
    times = math.ceil(reach / 1.2)
    return {
        "counts": [times * (count - 1) + 1 for count in plane.counts],
        "step_x": [float(f"{part / times:.4g}") for part in plane.step_x],
        "step_y": [float(f"{part / times:.4g}") for part in plane.step_y],
    }
