"""The subject of diagnoses: a scene, what it compiles to, and what several diagnoses ask of the two."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import chain, count

import numpy as np
from numpy.typing import NDArray

from atomsim.compiler.selections import GroupLayout, Selections, lay_out
from atomsim.compiler.shapes import place
from atomsim.core.diagnosis.bodies import bodies
from atomsim.core.diagnosis.flight import Mover, TooManyMoversError, movers
from atomsim.core.diagnosis.outlook import Outlook, Surroundings, outlooks
from atomsim.core.forces import held_atoms
from atomsim.core.model import BondTable, Floats, Indices, Model, State
from atomsim.core.pairs.near import distinct
from atomsim.scene.language import Scene
from atomsim.scene.source import KeyPath, Source

Mask = NDArray[np.bool_]

MOST_FOLLOWED = 100_000
"""In scenes with more atoms no flight is followed."""


class TooLargeError(Exception):
    """A scene is too large for a diagnosis to be worth its time."""


@dataclass(frozen=True)
class Subject:
    """A scene to be diagnosed.

    Attributes:
        scene: what a person wrote.
        source: where it was written.
        model: what it compiles to.
        state: where its run begins.
    """

    scene: Scene
    source: Source
    model: Model
    state: State

    @cached_property
    def is_held(self) -> Mask:
        """Whether each atom is held, (n_atoms,)."""
        is_held = np.zeros(self.model.n_atoms, dtype=bool)
        is_held[held_atoms(self.model.forces)] = True
        return is_held

    @cached_property
    def group(self) -> Indices:
        """The number of every atom's group, (n_atoms,)."""
        return np.repeat(np.arange(len(self.model.groups)), [span.stop - span.start for span in self.model.groups])

    @cached_property
    def part(self) -> Indices:
        """The number of every atom's group and copy, (n_atoms,)."""
        sizes = [layout.n_atoms_each for layout in self.layouts.values() for _ in range(layout.n_copies)]
        return np.repeat(np.arange(len(sizes)), sizes)

    @cached_property
    def body(self) -> Indices:
        """The body of every atom, named by the first of its atoms, (n_atoms,)."""
        return bodies(((table.first, table.second) for table in self.model.bonds), self.model.n_atoms)

    @cached_property
    def is_loose(self) -> Mask:
        """Whether each atom has no bond, (n_atoms,)."""
        is_loose = np.ones(self.model.n_atoms, dtype=bool)
        for table in self.model.bonds:
            is_loose[table.first] = is_loose[table.second] = False
        return is_loose

    @cached_property
    def are_joined(self) -> Mask:
        """Whether two groups share a bond, (n_groups, n_groups); each does with itself."""
        are_joined = np.eye(len(self.model.groups), dtype=bool)
        for table in self.model.bonds:
            one, other = self.group[table.first], self.group[table.second]
            are_joined[one, other] = are_joined[other, one] = True
        return are_joined

    @cached_property
    def selections(self) -> Selections:
        """What selections name."""
        return Selections(self.layouts, self.model.n_atoms)

    @cached_property
    def layouts(self) -> dict[str, GroupLayout]:
        """Where the atoms of each group are, copy after copy."""
        return lay_out(self.scene)

    @cached_property
    def placed(self) -> Floats:
        """Where atoms would start without jitter, from where rest distances are taken [length], (n_atoms, 3)."""
        return np.concatenate([place(group)[0] for group in self.scene.groups.values()])

    @cached_property
    def movers(self) -> list[Mover]:
        """What moves freely and predictably until it touches something.

        Raises:
            TooLargeError: there are too many atoms, or too many bodies, to follow.
        """
        if self.model.n_atoms > MOST_FOLLOWED:
            raise TooLargeError
        try:
            return movers(self.model, self.state, self.body, self.group)
        except TooManyMoversError:
            raise TooLargeError from None

    @cached_property
    def surroundings(self) -> Surroundings:
        """What the movers can meet."""
        return Surroundings(self.model, self.state, self.movers, self.is_held)

    @cached_property
    def outlooks(self) -> list[Outlook]:
        """What lies ahead of each mover."""
        return outlooks(self.model, self.surroundings, self.movers, self.scene.rounds)

    def bonds(self, name: str) -> BondTable:
        """Return the bonds of a declaration."""
        return next(table for table in self.model.bonds if table.origin.name == name)

    def is_bound_by(self, name: str) -> Mask:
        """Return whether each atom has a bond of a declaration, (n_atoms,)."""
        table = self.bonds(name)
        is_bound = np.zeros(self.model.n_atoms, dtype=bool)
        is_bound[table.first] = is_bound[table.second] = True
        return is_bound

    @cached_property
    def bond_keys(self) -> Indices:
        """Every bound pair as first · n_atoms + second, ascending, each once."""
        return distinct([table.first * self.model.n_atoms + table.second for table in self.model.bonds])

    def are_bound(self, first: Indices, second: Indices) -> Mask:
        """Return which pairs of atoms, first < second, have a bond, (n_pairs,)."""
        key = first * self.model.n_atoms + second
        return np.isin(key, self.bond_keys)

    def groups_of(self, atoms: Indices) -> list[str]:
        """Return the names of the groups that some atoms belong to, in order."""
        return [self.model.groups[number].name for number in sorted(set(self.group[atoms].tolist()))]

    def group_paths(self, atoms: Indices) -> tuple[KeyPath, ...]:
        """Return the paths of the groups that some atoms belong to, in order."""
        return tuple(("groups", name) for name in self.groups_of(atoms))

    def new_name(self, section: str, wish: str) -> str:
        """Return a name that a section of the scene does not have yet."""
        taken = getattr(self.scene, section)
        return next(name for name in chain([wish], (f"{wish}_{number}" for number in count(2))) if name not in taken)
