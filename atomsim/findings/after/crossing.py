"""Surfaces that atoms went through which they may touch: too fast to be stopped, through a hole, or by force."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from atomsim.core.model import Floats, Frame, GroupSpan, Indices
from atomsim.core.pairs.near import near_pairs
from atomsim.findings.after.look import Look, Run
from atomsim.findings.before.declared import sides
from atomsim.findings.before.hole import is_backed
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.scene.language import PlaneGroup
from atomsim.scene.source import KeyPath

How: TypeAlias = Literal["tunnelling", "hole", "overpowered"]

FAST = 1.0
"""Who goes through a surface at this speed per round, half the contact distance, may not have been felt [length]."""

FREE = 1.6
"""Who is this far from all corners of a cell goes through a hole; nearer, it is pushed through [length]."""

FARTHEST = 8.0
"""An atom farther than this from all atoms of a surface does not cross it between two frames, unless it is faster."""


class Crossing(NamedTuple):
    """The first time that an atom of a group went through a surface.

    Attributes:
        how: as what kind it counts.
        round_index: the frame after it.
        speed: across the surface [length per round].
    """

    how: How
    round_index: int
    speed: float


@dataclass(frozen=True, slots=True, eq=False)
class _Surface:
    """A plane and those who may touch it.

    Attributes:
        span: the group.
        corners: the atoms of every triangle of its cells, (n_triangles, 3).
        triangles: by atom of the plane, those that it is a corner of, (n_plane, 6), −1 for none.
        partners: the atoms that may touch it, ascending.
        tables: the collisions that say so.
    """

    span: GroupSpan
    corners: Indices
    triangles: Indices
    partners: Indices
    tables: tuple[str, ...]


class Crossings:
    """Remembers how the atoms of each group first went through each surface."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._surfaces = list(_surfaces(subject))
        self._seen: dict[tuple[str, str], Crossing] = {}

    def see(self, look: Look) -> None:
        """Look at what happened since the frame before."""
        if look.before is None:
            return
        for surface in self._surfaces:
            self._cross(surface, look.before, look.frame)

    def _cross(self, surface: _Surface, before: Frame, now: Frame) -> None:
        """Find atoms whose way leads through a triangle of the surface, both taken to move straight."""
        n_rounds = now.round_index - before.round_index
        own = slice(surface.span.start, surface.span.stop)
        step = now.position[surface.partners] - before.position[surface.partners]
        reach = FARTHEST + float(np.sqrt(np.square(step).sum(axis=1).max()))
        if not np.isfinite(reach) or reach > 100 * FARTHEST:
            return
        left, right = (np.ascontiguousarray(before.position[part].T) for part in (surface.partners, own))
        one, corner = near_pairs(left, right, reach)
        triangle = surface.triangles[corner]
        atom, triangle = np.repeat(surface.partners[one], triangle.shape[1]), triangle.ravel()
        atom, triangle = atom[triangle >= 0], triangle[triangle >= 0]
        key = np.unique(atom * len(surface.corners) + triangle)
        atom, triangle = key // len(surface.corners), key % len(surface.corners)
        at, corners, depth = _passage(before, now, atom, surface.corners[triangle])
        for place in np.flatnonzero(np.isfinite(depth)).tolist():
            speed = float(depth[place]) / n_rounds
            free = float(np.sqrt(np.square(corners[place] - at[place]).sum(axis=1)).min())
            how: How = "tunnelling" if speed >= FAST else "hole" if free >= FREE else "overpowered"
            group = self._subject.groups_of(atom[place : place + 1])[0]
            self._seen.setdefault((surface.span.name, group), Crossing(how, now.round_index, speed))

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen, by kind."""
        return {"tunnelling": self._tunnelling, "hole": self._hole, "overpowered": self._pushed_through}

    def _found(self, how: How) -> Iterator[tuple[str, str, tuple[str, ...], Crossing]]:
        """Yield surface, group, collisions and what happened, of one kind."""
        tables = {surface.span.name: surface.tables for surface in self._surfaces}
        for (surface, group), crossing in self._seen.items():
            if crossing.how == how:
                yield surface, group, tables[surface], crossing

    def _tunnelling(self) -> Iterator[Symptom]:
        """Yield atoms that went through a surface so fast that it may not have felt them."""
        for surface, group, tables, crossing in self._found("tunnelling"):
            yield Symptom(
                at=("groups", group),
                names=_names(surface, group, tables),
                message=(
                    f"{group} went through {surface} at {crossing.speed:.2g} per round, before round "
                    f"{crossing.round_index}: at 1 and more, contacts (at 2) may be missed"
                ),
                remedy={"time_step": float(f"{self._subject.model.time_step * 0.5 / crossing.speed:.1g}")},
                rounds=(crossing.round_index,),
            )

    def _hole(self) -> Iterator[Symptom]:
        """Yield atoms that went through a surface where it has nothing to touch."""
        for surface, group, tables, crossing in self._found("hole"):
            if self._is_backed(surface, group):
                continue
            yield Symptom(
                at=("groups", surface),
                names=_names(surface, group, tables),
                message=(
                    f"{group} went through a hole of {surface} before round {crossing.round_index}: between its atoms "
                    "there is nothing to touch"
                ),
                rounds=(crossing.round_index,),
            )

    def _is_backed(self, surface: str, group: str) -> bool:
        """Tell whether something else that a group may touch lies behind every hole of a surface."""
        spans = {span.name: span for span in self._subject.model.groups}
        plane = self._subject.scene.groups[surface]
        assert isinstance(plane, PlaneGroup)  # by `_surfaces`
        return is_backed(self._subject, spans[surface], plane, spans[group])

    def _pushed_through(self) -> Iterator[Symptom]:
        """Yield atoms that were pushed through a surface though they touched it."""
        for surface, group, tables, crossing in self._found("overpowered"):
            forces = pushing(self._subject, (surface, group))
            names = _names(surface, group, tables)
            yield Symptom(
                at=forces[0] if forces else names[0],
                names=(*names, *forces),
                message=(
                    f"{group} was pushed through {surface} before round {crossing.round_index}, between atoms that it "
                    "touched: the forces on them are too strong"
                ),
                rounds=(crossing.round_index,),
            )


def pushing(subject: Subject, groups: tuple[str, ...]) -> tuple[KeyPath, ...]:
    """Return the forces that push some of the groups, the strongest first."""
    strength = {
        force.origin.name: float(np.linalg.norm(force.impulse))
        for force in subject.model.forces
        if hasattr(force, "impulse") and set(groups) & set(subject.groups_of(force.atoms))
    }
    return tuple(("forces", name) for name in sorted(strength, key=lambda name: -strength[name]))


def _names(surface: str, group: str, tables: tuple[str, ...]) -> tuple[KeyPath, ...]:
    return (("groups", surface), ("groups", group), *(("collisions", name) for name in tables))


def _surfaces(subject: Subject) -> Iterator[_Surface]:
    """Yield the planes of a scene that others may touch."""
    for span in subject.model.groups:
        plane = subject.scene.groups[span.name]
        if not isinstance(plane, PlaneGroup) or min(plane.counts) < 2:
            continue
        own = np.arange(span.start, span.stop)
        partners, tables = [], []
        for table in subject.model.collisions:
            for pair in sides(table):
                for side, other in (pair, pair[::-1]):
                    if np.isin(side, own).any():
                        partners.append(other)
                        tables.append(table.origin.name)
        outside = np.setdiff1d(np.concatenate([np.empty(0, dtype=np.int64), *partners]), own)
        if outside.size:
            corners = _triangles(own.reshape(-1, plane.counts[1], plane.counts[0]))
            yield _Surface(span, corners, _by_atom(corners, span), outside, tuple(dict.fromkeys(tables)))


def _triangles(grids: Indices) -> Indices:
    """Return two triangles for each cell of some grids of atoms, (n_triangles, 3)."""
    a, b, c, d = grids[:, :-1, :-1], grids[:, :-1, 1:], grids[:, 1:, :-1], grids[:, 1:, 1:]
    both = [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (b, d, c))]
    return np.concatenate(both)


def _by_atom(corners: Indices, span: GroupSpan) -> Indices:
    """Return which triangles each atom of a plane is a corner of, (n_plane, 6), −1 for none."""
    found = np.full((span.stop - span.start, 6), -1)
    filled = np.zeros(len(found), dtype=np.int64)
    for number, triangle in enumerate(corners - span.start):
        found[triangle, filled[triangle]] = number
        filled[triangle] += 1
    return found


def _passage(before: Frame, now: Frame, atom: Indices, corners: Indices) -> tuple[Floats, Floats, Floats]:
    """Return where ways lead through triangles that move, too.

    Returns:
        The point, (n, 3); the corners at that moment, (n, 3, 3); and how far the atom moves across the triangle between
        the frames, (n,), NaN where it does not go through.
    """
    heights, normals = [], []
    for frame in (before, now):
        triangle, point = frame.position[corners], frame.position[atom]
        normal = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
        length = np.sqrt(np.square(normal).sum(axis=1, keepdims=True))
        normals.append(normal / np.where(length > 0.0, length, 1.0))
        heights.append(((point - triangle[:, 0]) * normals[-1]).sum(axis=1))
    depth = np.abs(heights[1] - heights[0])
    moment = heights[0] / np.where(depth > 0.0, heights[0] - heights[1], 1.0)
    at = before.position[atom] + moment[:, None] * (now.position[atom] - before.position[atom])
    triangle = before.position[corners] + moment[:, None, None] * (now.position[corners] - before.position[corners])
    goes_through = (heights[0] * heights[1] < 0.0) & _is_inside(at, triangle)
    return at, triangle, np.where(goes_through, depth, np.nan)


def _is_inside(point: Floats, triangle: Floats) -> Floats:
    """Return whether points in the planes of triangles are inside them, (n,)."""
    normal = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    sides = [
        (np.cross(triangle[:, (k + 1) % 3] - triangle[:, k], point - triangle[:, k]) * normal).sum(axis=1)
        for k in range(3)
    ]
    return np.asarray(np.min(sides, axis=0) >= 0.0)
