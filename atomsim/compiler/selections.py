"""From selection expressions to atoms; knows groups by name, span and grid, nothing of rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from atomsim.compiler.shapes import count_atoms, count_copies
from atomsim.core.free_memory import free_memory
from atomsim.core.model import Indices, atom_expression
from atomsim.core.pairs.near import distinct
from atomsim.scene.declarations import selecting_keys
from atomsim.scene.language import BlockGroup, Declaration, PlaneGroup, PolygonGroup, RingGroup, Scene
from atomsim.scene.language.selection import parse_selection
from atomsim.scene.mistakes.wording import meant, readable
from atomsim.scene.source import KeyPath

LARGE = 1 << 26
"""Bytes of selections from which on it is worth asking whether more will fit."""


class SelectionError(ValueError):
    """A selection that names no atoms; the message says why and what there is, `expression` is what was written."""

    def __init__(self, expression: str, message: str) -> None:
        self.expression = expression
        self.message = message
        super().__init__(expression, message)

    def __str__(self) -> str:
        return self.message


@dataclass(frozen=True, slots=True)
class GroupLayout:
    """Where a group's atoms are numbered: start ≤ atom < stop, copy after copy.

    Attributes:
        start: the first atom.
        stop: one past the last.
        grid: the shape of the grid of each copy, x first.
        is_closed: whether the last atom of a copy is next to its first.
        n_copies: how many copies there are, the group itself counted.
    """

    start: int
    stop: int
    grid: tuple[int, ...]
    is_closed: bool
    n_copies: int

    @property
    def n_atoms_each(self) -> int:
        """The number of atoms of one copy."""
        return (self.stop - self.start) // self.n_copies


def lay_out(scene: Scene) -> dict[str, GroupLayout]:
    """Number the atoms of a scene, group after group in order of declaration."""
    layouts = {}
    start = 0
    for name, group in scene.groups.items():
        stop, n_copies = start + count_atoms(group), count_copies(group)
        grid = tuple(group.counts) if isinstance(group, (PlaneGroup, BlockGroup)) else ((stop - start) // n_copies,)
        layouts[name] = GroupLayout(start, stop, grid, isinstance(group, (RingGroup, PolygonGroup)), n_copies)
        start = stop
    return layouts


class Selections:
    """Resolves expressions against the groups of a scene.

    Args:
        layouts: the groups, by name.
        n_atoms: number of atoms of the scene.
    """

    def __init__(self, layouts: Mapping[str, GroupLayout], n_atoms: int) -> None:
        self._layouts = layouts
        self._n_atoms = n_atoms
        self._found: dict[tuple[str, ...], Indices] = {}
        self._n_bytes = 0

    def atoms(self, selection: tuple[str, ...]) -> Indices:
        """Return the atoms of a selection (the union of its expressions), ascending, without duplicates, read-only.

        Raises:
            SelectionError: an unknown group, an index out of range, nothing selected, or more than fits into memory.
        """
        if selection not in self._found:
            self._keep(selection, self._union(selection))
        return self._found[selection]

    def _keep(self, selection: tuple[str, ...], atoms: Indices) -> None:
        """Remember a selection: a thousand forces on all atoms share one array."""
        self._n_bytes += atoms.nbytes
        if self._n_bytes > LARGE and self._n_bytes > free_memory():
            raise SelectionError(selection[0], "the selections up to here name more atoms than fit into memory")
        atoms.setflags(write=False)
        self._found[selection] = atoms

    def _union(self, selection: tuple[str, ...]) -> Indices:
        if len(selection) == 1:
            return self._atoms_of(selection[0])
        is_selected = np.zeros(self._n_atoms, dtype=bool)
        for expression in selection:
            is_selected[self._atoms_of(expression)] = True
        return np.flatnonzero(is_selected)

    def by_copy(self, selection: tuple[str, ...]) -> list[Indices]:
        """Return the atoms of a selection in each copy, ascending; one array if it names nothing that is copied.

        Where several groups with copies are selected, their copies of one number go together; what has no copies, or
        is one copy only, goes with each.

        Raises:
            SelectionError: as `atoms`; or groups that have different numbers of copies.
        """
        n_copies = self.n_copies(selection)
        if n_copies == 1:
            return [self.atoms(selection)]
        parts = [self._each(expression, n_copies) for expression in selection]
        return list(parts[0]) if len(parts) == 1 else [distinct(together) for together in zip(*parts, strict=True)]

    def each_copy(self, expression: str) -> list[str]:
        """Return an expression for each copy of what an expression names; itself, if there are no copies of it."""
        n_copies = self.n_copies((expression,))
        return [_of_copy(number, expression) for number in range(n_copies)] if n_copies > 1 else [expression]

    def matched(self, between: tuple[tuple[str, ...], tuple[str, ...]]) -> tuple[list[Indices], list[Indices]]:
        """Return the atoms of two selections by copy, as many of both: copies of one number meet.

        A selection without copies meets each copy of the other.

        Raises:
            SelectionError: as `by_copy`; or the two have different numbers of copies.
        """
        self.n_copies((*between[0], *between[1]))
        left, right = (self.by_copy(side) for side in between)
        n_copies = max(len(left), len(right))
        return left * (n_copies // len(left)), right * (n_copies // len(right))

    def n_copies(self, selection: tuple[str, ...]) -> int:
        """Return how many copies of a selection there are.

        Raises:
            SelectionError: groups in it have different numbers of copies, more than one each.
        """
        found: dict[int, str] = {}
        for expression in selection:
            part = parse_selection(expression)
            layout = self._layouts.get(part.group) if part.copy is None else None
            if layout is not None and layout.n_copies > 1:
                found.setdefault(layout.n_copies, expression)
        if len(found) > 1:
            (n_one, one), (n_other, other), *_ = found.items()
            raise SelectionError(
                other,
                f"`{one}` has {n_one} copies and `{other}` has {n_other}: copies of one number go together; name the "
                f"ones that are meant, such as `{_of_copy(0, other)}`",
            )
        return next(iter(found), 1)

    def _each(self, expression: str, n_copies: int) -> Indices:
        """Return the atoms of one expression by copy, (n_copies, n_atoms of each)."""
        atoms = self._atoms_of(expression)
        if self.n_copies((expression,)) == 1:
            return np.broadcast_to(atoms, (n_copies, atoms.size))
        return atoms.reshape(n_copies, -1)

    def whole_group(self, expression: str) -> GroupLayout | None:
        """Return the layout of the group that an expression names as a whole, or as one whole copy, else None."""
        part = parse_selection(expression)
        return None if part.axes else self._layouts.get(part.group)

    def expression(self, atom: int) -> str:
        """Return the expression that selects one atom: the way back."""
        name, layout = next(item for item in self._layouts.items() if atom < item[1].stop)
        return atom_expression(name, atom - layout.start, layout.stop - layout.start, layout.n_copies)

    def grid_places(self, expression: str) -> Indices | None:
        """Return the grid places of the atoms selected, (n_selected, n_axes), or None where there is no grid.

        Of each copy they are the same, and given once.
        """
        part = parse_selection(expression)
        layout = self._layouts.get(part.group)
        if layout is None or len(layout.grid) < 2:
            return None
        index = _in_one(part.axes, layout, expression, part.group)
        return np.stack(np.unravel_index(index, layout.grid[::-1])[::-1], axis=1)

    def _atoms_of(self, expression: str) -> Indices:
        """Return the atoms of one expression, ascending."""
        part = parse_selection(expression)
        if part.group == "all":
            return np.arange(self._n_atoms)
        layout = self._layouts.get(part.group)
        if layout is None:
            remedy = meant(part.group, self._layouts, "the groups are")
            raise SelectionError(expression, f"there is no group `{readable(part.group)}`; {remedy}")
        if part.copy is not None and layout.n_copies == 1:
            raise SelectionError(expression, f"`{expression}` is no copy: {part.group} has no copies")
        if part.copy is not None and part.copy >= layout.n_copies:
            last = layout.n_copies - 1
            raise SelectionError(
                expression, f"`{expression}` is out of range: {part.group} has {last + 1} copies, 0 to {last}"
            )
        copies = np.arange(layout.n_copies) if part.copy is None else np.array([part.copy])
        inside = _in_one(part.axes, layout, expression, part.group)
        return (layout.start + layout.n_atoms_each * copies[:, None] + inside).ravel()


def _of_copy(number: int, expression: str) -> str:
    """Return the expression for one copy of what an expression names."""
    name, bracket, rest = expression.strip().partition("[")
    return f"{name.strip()}.{number}{bracket}{rest}"


def _in_one(axes: tuple[int | slice, ...], layout: GroupLayout, expression: str, group: str) -> Indices:
    """Return which atoms of a copy are selected, counted from its first, ascending."""
    if not axes:
        return np.arange(layout.n_atoms_each)
    grid = layout.grid if len(axes) > 1 else (layout.n_atoms_each,)
    if len(axes) != len(grid):
        shape = " × ".join(str(count) for count in layout.grid)
        raise SelectionError(
            expression,
            f"`{expression}` has {len(axes)} indices, but {group} is {shape} atoms "
            f"({'one index' if len(layout.grid) == 1 else f'one or {len(layout.grid)} indices'})",
        )
    places = [_along_axis(axis, count, expression, group) for axis, count in zip(axes, grid, strict=True)]
    index = np.zeros((1,) * len(grid), dtype=np.int64)
    stride = 1
    for number, (place, count) in enumerate(zip(places, grid, strict=True)):
        index = index + place.reshape([-1 if other == number else 1 for other in range(len(grid))]) * stride
        stride *= count
    return np.sort(index, axis=None)


def atoms_named(scene: Scene, selection: tuple[str, ...]) -> Indices:
    """Return the atoms of a selection in a scene, ascending, (n,) int64.

    Raises:
        SelectionError: an unknown group, an index out of range, or nothing selected.
    """
    layouts = lay_out(scene)
    return Selections(layouts, sum(layout.stop - layout.start for layout in layouts.values())).atoms(selection)


def _along_axis(axis: int | slice, count: int, expression: str, group: str) -> Indices:
    """Return the places that an index or slice selects of `count`."""
    if isinstance(axis, slice):
        places = np.arange(count)[axis]
        if not places.size:
            raise SelectionError(
                expression, f"`{expression}` selects no atoms: {group} has {count} there, 0 to {count - 1}"
            )
        return places
    if not -count <= axis < count:
        raise SelectionError(expression, f"`{expression}` is out of range: {group} has {count} there, 0 to {count - 1}")
    return np.array([axis % count])


def place_of(expression: str, declaration: Declaration) -> KeyPath:
    """Return where in a declaration a selection was written, as a path inside it; empty if nowhere."""
    places = (_place_in(getattr(declaration, key), expression, (key,)) for key in selecting_keys(type(declaration)))
    return next(filter(None, places), ())


def _place_in(value: Any, expression: str, path: KeyPath) -> KeyPath | None:
    """Look for an expression in selections as deeply nested as a declaration nests them."""
    if value in (expression, (expression,)):
        return path
    places = enumerate(value) if isinstance(value, tuple) else ()
    return next(filter(None, (_place_in(inner, expression, (*path, index)) for index, inner in places)), None)
