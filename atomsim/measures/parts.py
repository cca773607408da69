"""The groups of a scene, copy by copy, as parts to which something happens, and which of them may touch."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from atomsim.compiler.selections import Selections, lay_out
from atomsim.core.diagnosis.bodies import bodies
from atomsim.core.model import Indices
from atomsim.scene.language import Collisions, Scene
from atomsim.scene.language.forces import Hold
from atomsim.scene.language.groups import PolygonGroup, RingGroup, StringGroup
from atomsim.trajectory.header import AtomNumbers


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A group, or one of its copies.

    Attributes:
        name: what it is called, as a selection.
        atoms: its atoms, ascending.
        bodies: the bodies that its atoms belong to, ascending; see `atomsim.core.diagnosis.bodies`.
        is_held: whether all its atoms are held.
        is_string: whether it is a string, ring or polygon of which each atom is bound to the next.
    """

    name: str
    atoms: Indices
    bodies: Indices
    is_held: bool
    is_string: bool

    @property
    def is_body(self) -> bool:
        """Whether bonds hold all of it together, so that it has an attitude."""
        return self.bodies.size == 1 and self.atoms.size > 1


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """Two parts that may touch.

    Attributes:
        parts: the two; if one is held, the second.
        atoms: those of either that collisions let touch the other.
    """

    parts: tuple[Part, Part]
    atoms: tuple[Indices, Indices]

    @property
    def names(self) -> tuple[str, str]:
        """What the two are called."""
        return self.parts[0].name, self.parts[1].name


def parts_of(scene: Scene, bond: AtomNumbers) -> list[Part]:
    """Return the groups of a scene as parts.

    Args:
        scene: the scene.
        bond: pairs of atoms that are bound, (n_bonds, 2) int32.
    """
    layouts = lay_out(scene)
    n_atoms = max(layout.stop for layout in layouts.values())
    selections = Selections(layouts, n_atoms)
    is_held = np.zeros(n_atoms, dtype=bool)
    for force in scene.forces.values():
        if isinstance(force, Hold):
            is_held[selections.atoms(force.acts_on)] = True
    first, second = bond.astype(np.int64).T
    body = bodies([(first, second)], n_atoms)
    is_tied = np.zeros(n_atoms, dtype=bool)  # to the next atom
    is_tied[first[second == first + 1]] = True
    is_threaded = {
        name: isinstance(group, (StringGroup, RingGroup, PolygonGroup)) for name, group in scene.groups.items()
    }
    parts = []
    for name in scene.groups:
        for copy in selections.each_copy(name):
            atoms = selections.atoms((copy,))
            is_string = is_threaded[name] and atoms.size > 1 and bool(is_tied[atoms[:-1]].all())
            parts.append(Part(copy, atoms, np.unique(body[atoms]), bool(is_held[atoms].all()), is_string))
    return parts


def pairs_of(scene: Scene, parts: list[Part]) -> list[Pair]:
    """Return the parts that collisions let touch and that are neither one body nor both held, in order of parts.

    Args:
        scene: the scene.
        parts: what `parts_of` returned for it.
    """
    layouts = lay_out(scene)
    n_atoms = max(layout.stop for layout in layouts.values())
    selections = Selections(layouts, n_atoms)
    touching: dict[tuple[int, int], tuple[list[Indices], list[Indices]]] = {}
    for collisions in scene.collisions.values():
        for sides in _sides(collisions):
            one, other = ([np.intersect1d(selections.atoms(side), part.atoms) for part in parts] for side in sides)
            for i, k in product(range(len(parts)), repeat=2):
                if i != k and one[i].size and other[k].size:
                    lower, upper = touching.setdefault((min(i, k), max(i, k)), ([], []))
                    (lower if i < k else upper).append(one[i])
                    (upper if i < k else lower).append(other[k])
    found = []
    for (i, k), (lower, upper) in sorted(touching.items()):
        first, second = (parts[i], np.unique(np.concatenate(lower))), (parts[k], np.unique(np.concatenate(upper)))
        if first[0].is_held:
            first, second = second, first
        if not (first[0].is_held or np.intersect1d(first[0].bodies, second[0].bodies).size):
            found.append(Pair((first[0], second[0]), (first[1], second[1])))
    return found


def _sides(collisions: Collisions) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Yield the two sides of each block of pairs."""
    if collisions.within is not None:
        yield from (((part,), (part,)) for part in collisions.within)
    elif collisions.between is not None:
        yield collisions.between
    else:
        yield from combinations(collisions.among or (), 2)
