"""What is wrong with a scene though each of its values is right by itself; compiles nothing and stops nothing.

Every check yields complaints in the order of the scene; whoever compiles decides when there are too many to go on.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from atomsim.compiler.coincident import Pairs
from atomsim.compiler.room import BYTES_PER_ATOM, BYTES_PER_PAIR, n_countable_pairs, shortage
from atomsim.compiler.selections import GroupLayout, SelectionError, Selections
from atomsim.core.model import CollisionTable, Floats, Within
from atomsim.core.pairs.collisions import n_collision_pairs
from atomsim.scene.language import Bonds, Rest, Scene, Vector
from atomsim.scene.source import KeyPath

LARGEST = 1e150
"""The largest coordinate, velocity or desired distance: squares of differences stay finite."""

TOO_LARGE = "too large to compute with"


class Complaint(NamedTuple):
    """Where in a scene something is wrong, and what."""

    path: KeyPath
    message: str


def too_many_atoms(n_atoms: int) -> Iterator[Complaint]:
    """Check that the atoms fit into memory, before any is made."""
    short = shortage(n_atoms * BYTES_PER_ATOM, f"{n_atoms:,} atoms")
    if short is not None:
        yield Complaint(("groups",), short)


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
    """Check numbers that are finite one by one, but not where they put the atoms or not when they are squared."""
    if scene.time_step > LARGEST:
        yield Complaint(("time_step",), f"is {TOO_LARGE}")
    for name, layout in layouts.items():
        atoms = slice(layout.start, layout.stop)
        if not all((np.abs(numbers[atoms]) <= LARGEST).all() for numbers in (position, velocity)):
            yield Complaint(("groups", name), f"its numbers are {TOO_LARGE}")


def too_large_rest(path: KeyPath, rest: Rest) -> Iterator[Complaint]:
    """Check that the square of a desired distance is finite."""
    if rest != "initial" and rest > LARGEST:
        yield Complaint((*path, "rest"), f"is {TOO_LARGE}")


def too_large_point(path: KeyPath, point: Vector) -> Iterator[Complaint]:
    """Check that squares of differences from a fixed point are finite."""
    if max(map(abs, point)) > LARGEST:
        yield Complaint(path, f"its numbers are {TOO_LARGE}")


def at_one_place(path: KeyPath, pairs: Pairs, what: str, selections: Selections) -> Iterator[Complaint]:
    """Complain of pairs at distance zero, if there are any: no force between them has a direction.

    Args:
        path: the declaration that sets them on each other.
        pairs: atoms at one place.
        what: what the declaration makes of them, for people.
        selections: know how atoms are called.
    """
    first, second = pairs
    if first.size:
        one, other = (selections.expression(int(atoms[0])) for atoms in pairs)
        more = " (and so do others)" if ((first != first[0]) | (second != second[0])).any() else ""
        yield Complaint(path, f"{one} and {other} are {what} but start at the same place{more}")


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


def colors_of_nothing(scene: Scene, selections: Selections) -> Iterator[Complaint]:
    """Check the colours of atoms that do not exist; who draws asks for them again."""
    for selection in scene.render.colors:
        try:
            selections.atoms((selection,))
        except SelectionError as error:
            yield Complaint(("render", "colors", selection), str(error))
