"""From selection expressions to atoms; knows groups by name, span and grid, nothing of rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from atomsim.compiler.shapes import count_atoms
from atomsim.core.free_memory import free_memory
from atomsim.core.model import Indices
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
    """Where a group's atoms are numbered: start ≤ atom < stop, and the shape of its grid, x first.

    `is_closed` tells whether the last atom is next to the first.
    """

    start: int
    stop: int
    grid: tuple[int, ...]
    is_closed: bool


def lay_out(scene: Scene) -> dict[str, GroupLayout]:
    """Number the atoms of a scene, group after group in order of declaration."""
    layouts = {}
    start = 0
    for name, group in scene.groups.items():
        stop = start + count_atoms(group)
        grid = tuple(group.counts) if isinstance(group, (PlaneGroup, BlockGroup)) else (stop - start,)
        layouts[name] = GroupLayout(start, stop, grid, isinstance(group, (RingGroup, PolygonGroup)))
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

    def whole_group(self, expression: str) -> GroupLayout | None:
        """Return the layout of the group that an expression names as a whole, else None."""
        part = parse_selection(expression)
        return None if part.axes else self._layouts.get(part.group)

    def expression(self, atom: int) -> str:
        """Return the expression that selects one atom: the way back."""
        name, layout = next(item for item in self._layouts.items() if atom < item[1].stop)
        return f"{name}[{atom - layout.start}]"

    def grid_places(self, expression: str) -> Indices | None:
        """Return the grid places of the atoms selected, (n_selected, n_axes), or None where there is no grid."""
        part = parse_selection(expression)
        layout = self._layouts.get(part.group)
        if layout is None or len(layout.grid) < 2:
            return None
        index = self._atoms_of(expression) - layout.start
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
        if not part.axes:
            return np.arange(layout.start, layout.stop)
        grid = layout.grid if len(part.axes) > 1 else (layout.stop - layout.start,)
        if len(part.axes) != len(grid):
            shape = " × ".join(str(count) for count in layout.grid)
            raise SelectionError(
                expression,
                f"`{expression}` has {len(part.axes)} indices, but {part.group} is {shape} atoms "
                f"({'one index' if len(layout.grid) == 1 else f'one or {len(layout.grid)} indices'})",
            )
        places = [_along_axis(axis, count, expression, part.group) for axis, count in zip(part.axes, grid, strict=True)]
        index = np.zeros((1,) * len(grid), dtype=np.int64)
        stride = 1
        for number, (place, count) in enumerate(zip(places, grid, strict=True)):
            index = index + place.reshape([-1 if other == number else 1 for other in range(len(grid))]) * stride
            stride *= count
        return layout.start + np.sort(index, axis=None)


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
