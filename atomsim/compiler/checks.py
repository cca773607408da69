"""What is wrong with a scene though each of its values is right by itself; compiles nothing and stops nothing.

Every check yields complaints in the order of the scene; whoever compiles decides when there are too many to go on.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from atomsim.compiler.coincident import Pairs, coincident_anywhere
from atomsim.compiler.room import BYTES_PER_ATOM, BYTES_PER_PAIR, n_countable_pairs, shortage
from atomsim.compiler.selections import GroupLayout, SelectionError, Selections
from atomsim.core.diagnosis.blowup import FLOWN_APART
from atomsim.core.model import CollisionTable, Floats, Within
from atomsim.core.pairs.collisions import n_collision_pairs
from atomsim.scene.language import AtomsGroup, Bonds, Rest, Scene, Vector
from atomsim.scene.source import KeyPath

LARGEST = 1e7
"""The largest coordinate, desired distance or time step.

The squares of larger distances, which energies are made of, are no longer exact to a hundredth.
"""

TOO_LARGE = f"too large to compute with: more than {LARGEST:g}"

TOO_FAR = f"too far to compute with: more than {FLOWN_APART:g}"


class Complaint(NamedTuple):
    """Where in a scene something is wrong, and what."""

    path: KeyPath
    message: str


def too_many_atoms(layouts: Mapping[str, GroupLayout]) -> Iterator[Complaint]:
    """Check that the atoms fit into memory, before any is made, and find the group that asks for too many."""
    for name, layout in layouts.items():
        what = f"{layout.stop:,} atoms" + (", with those before," if layout.start else "")
        short = shortage(layout.stop * BYTES_PER_ATOM, what)
        if short is not None:
            yield Complaint(("groups", name), short)
            return


def too_many_bonds(bonds: Mapping[str, Bonds], selections: Selections) -> Iterator[Complaint]:
    """Check that the pairs of rules that can be counted beforehand fit into memory, before any is made."""
    n_before = 0
    for name, rule in bonds.items():
        try:
            n_pairs = n_before + n_countable_pairs(rule, selections)
        except SelectionError:
            continue  # told when the pairs are made
        what = f"{n_pairs:,} bonds" + (", with those before," if n_before else "")
        short = shortage(n_pairs * BYTES_PER_PAIR, what)
        if short is not None:
            yield Complaint(("bonds", name, "rule"), short)
            return
        n_before = n_pairs


def too_large_numbers(
    scene: Scene, layouts: Mapping[str, GroupLayout], position: Floats, velocity: Floats
) -> Iterator[Complaint]:
    """Check numbers that are finite one by one, but too large where they put the atoms or when they are squared."""
    if scene.time_step > LARGEST:
        yield Complaint(("time_step",), f"is {TOO_LARGE}")
        return  # which is why atoms would go too far
    if scene.jitter is not None and scene.jitter.amplitude > LARGEST:
        yield Complaint(("jitter", "amplitude"), f"is {TOO_LARGE}")
    for name, layout in layouts.items():
        atoms = slice(layout.start, layout.stop)
        if not (np.abs(position[atoms]) <= LARGEST).all():
            yield Complaint(("groups", name), f"its coordinates are {TOO_LARGE}")
        elif not (np.abs(velocity[atoms] * scene.time_step) <= FLOWN_APART).all():
            yield Complaint(("groups", name), f"its way in the first round is {TOO_FAR}")


def atoms_at_one_place(
    scene: Scene, layouts: Mapping[str, GroupLayout], position: Floats, selections: Selections
) -> Iterator[Complaint]:
    """Check that the atoms of each shape have places of their own: one without extent, or folded, has not.

    Atoms whose positions are written may be at one place as long as no force acts between them.
    """
    for name, layout in layouts.items():
        if isinstance(scene.groups[name], AtomsGroup):
            continue
        first, second = coincident_anywhere(position[layout.start : layout.stop])
        yield from _at_one_place(("groups", name), (first + layout.start, second + layout.start), "", selections)


def too_large_rest(path: KeyPath, rest: Rest) -> Iterator[Complaint]:
    """Check that the square of a desired distance is finite."""
    if rest != "initial" and rest > LARGEST:
        yield Complaint((*path, "rest"), f"is {TOO_LARGE}")


def too_large_point(path: KeyPath, point: Vector) -> Iterator[Complaint]:
    """Check that squares of differences from a fixed point are finite."""
    if max(map(abs, point)) > LARGEST:
        yield Complaint(path, f"its coordinates are {TOO_LARGE}")


def at_one_place(path: KeyPath, pairs: Pairs, what: str, selections: Selections) -> Iterator[Complaint]:
    """Complain of pairs at distance zero, if there are any: no force between them has a direction.

    Args:
        path: the declaration that sets them on each other.
        pairs: atoms at one place.
        what: what the declaration makes of them, for people.
        selections: know how atoms are called.
    """
    yield from _at_one_place(path, pairs, f"are {what} but ", selections)


def _at_one_place(path: KeyPath, pairs: Pairs, but: str, selections: Selections) -> Iterator[Complaint]:
    first, second = pairs
    if first.size:
        one, other = (selections.expression(int(atoms[0])) for atoms in pairs)
        more = " (and so do others)" if ((first != first[0]) | (second != second[0])).any() else ""
        yield Complaint(path, f"{one} and {other} {but}start at the same place{more}")


def nothing_collides(path: KeyPath, table: CollisionTable) -> Iterator[Complaint]:
    """Check that a table has pairs, and name the key to blame."""
    if n_collision_pairs(table):
        return
    if n_collision_pairs(replace(table, bound=None)):
        yield Complaint((*path, "except_bound"), "nothing can collide: all atoms here are that few bonds apart")
        return
    gaps = [block.min_gap for block in table.blocks if isinstance(block, Within) and block.atoms.size > 1]
    if gaps:
        why = f"no two atoms here are {gaps[0]} or more places apart"
        yield Complaint((*path, "min_gap"), f"nothing can collide: {why}")
    else:
        yield Complaint(path, "nothing can collide: there are no two different atoms here")


def pictures_of_nothing(scene: Scene, selections: Selections) -> Iterator[Complaint]:
    """Check what the picture says of atoms that do not exist; who draws asks for them again."""
    shown: list[tuple[KeyPath, tuple[str, ...]]]
    shown = [(("render", "colors", selection), (selection,)) for selection in scene.render.colors]
    camera = scene.render.camera
    named = {"follow": camera.follow, "close_up": camera.close_up}
    shown += [(("render", "camera", key), selection) for key, selection in named.items() if selection is not None]
    for path, selection in shown:
        try:
            selections.atoms(selection)
        except SelectionError as error:
            yield Complaint(path, str(error))
