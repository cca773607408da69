"""From a bond rule to canonical pairs; knows selections and initial positions, nothing of rest distances or forces."""

from __future__ import annotations

from typing import assert_never

import numpy as np

from atomsim.compiler.selections import Selections
from atomsim.core.model import Floats, Indices
from atomsim.core.pairs.near import distinct, near_pairs
from atomsim.scene.language import AllPairsBonds, Bonds, DistanceThresholdBonds, ListedBonds, NeighbourBonds

Pairs = tuple[Indices, Indices]


class RuleError(ValueError):
    """A rule that makes no sense for the atoms it names; `key` is the part of the declaration to blame."""

    def __init__(self, key: str, message: str) -> None:
        self.key = key
        self.message = message
        super().__init__(key, message)

    def __str__(self) -> str:
        return self.message


def expand(bonds: Bonds, selections: Selections, position: Floats) -> Pairs:
    """Return the pairs of a bond declaration, canonical: first < second, no duplicates, sorted.

    Args:
        bonds: the declaration.
        selections: resolves its selections.
        position: initial positions before jitter [length], (n_atoms, 3).

    Raises:
        RuleError: no pairs, or indices or a metric that do not fit.
        SelectionError: a selection that names no atoms.
    """
    n_atoms = position.shape[0]
    found = [pairs for pairs in _expand_each(bonds, selections, position) if pairs[0].size]
    if len(found) == 1 and bonds.rule == "all-pairs" and bonds.between is None:
        return found[0]  # canonical as it is, and perhaps large
    key = distinct([np.minimum(one, other) * n_atoms + np.maximum(one, other) for one, other in found])
    first, second = key // n_atoms, key % n_atoms
    if not key.size:
        raise RuleError(*_why_no_pairs(bonds))
    return first, second


def _expand_each(bonds: Bonds, selections: Selections, position: Floats) -> list[Pairs]:
    """Apply the rule inside each group of `within`, or across `between`: copy by copy where there are copies."""
    if bonds.within is not None:
        return [_inside(bonds, expression, selections, position) for expression in bonds.within]
    assert not isinstance(bonds, NeighbourBonds)  # the language requires `within`
    assert bonds.between is not None  # the language requires one of the two
    left, right = selections.matched(bonds.between)
    return [_across(bonds, one, other, position) for one, other in zip(left, right, strict=True)]


def _inside(bonds: Bonds, expression: str, selections: Selections, position: Floats) -> Pairs:
    """Pairs inside one selection, or inside each copy of it."""
    copies = np.stack(selections.by_copy((expression,)))
    if isinstance(bonds, DistanceThresholdBonds) and bonds.metric == "space":
        return _joined([_near_inside(atoms, position, bonds.threshold) for atoms in copies])
    first, second = _places_inside(bonds, expression, selections, copies)
    return copies[:, first].ravel(), copies[:, second].ravel()


def _places_inside(bonds: Bonds, expression: str, selections: Selections, copies: Indices) -> Pairs:
    """Pairs of places in a selection, which are the same in every copy, (n_copies, n_atoms of each)."""
    n_atoms = copies.shape[1]
    match bonds:
        case NeighbourBonds():
            return _neighbours(bonds, expression, selections, n_atoms)
        case AllPairsBonds():
            return _all_pairs(np.arange(n_atoms))
        case DistanceThresholdBonds():
            places = selections.grid_places(expression)
            if places is None:
                raise RuleError("metric", f"`metric: grid` needs a plane or a block, and `{expression}` is neither")
            return near_pairs(_in_space(places), None, bonds.threshold)
        case ListedBonds():
            return _listed(bonds, np.arange(n_atoms), np.arange(n_atoms))
        case _:
            assert_never(bonds)


def _neighbours(bonds: NeighbourBonds, expression: str, selections: Selections, n_atoms: int) -> Pairs:
    """Places at most `reach` apart, around the end where the selection is closed."""
    layout = selections.whole_group(expression)
    closed = bonds.closed if bonds.closed is not None else layout is not None and layout.is_closed
    place = np.arange(n_atoms)
    one, other = [place[:0]], [place[:0]]
    for gap in range(1, min(bonds.reach, n_atoms - 1) + 1):
        lower = place if closed else place[:-gap]
        one.append(lower)
        other.append((lower + gap) % n_atoms)
    return np.concatenate(one), np.concatenate(other)


def _near_inside(atoms: Indices, position: Floats, threshold: float) -> Pairs:
    first, second = near_pairs(position[atoms].T, None, threshold)
    return _apart(position, atoms[first], atoms[second])


def _joined(pairs: list[Pairs]) -> Pairs:
    one, other = zip(*pairs, strict=True)
    return np.concatenate(one), np.concatenate(other)


def _all_pairs(atoms: Indices) -> Pairs:
    """Return every pair of ascending atoms, sorted."""
    partners = np.arange(atoms.size - 1, -1, -1)
    begin = np.cumsum(partners) - partners
    second = np.arange(int(partners.sum()))
    second -= np.repeat(begin - np.arange(1, atoms.size + 1), partners)
    return np.repeat(atoms, partners), atoms[second]


def _across(
    bonds: AllPairsBonds | DistanceThresholdBonds | ListedBonds, left: Indices, right: Indices, position: Floats
) -> Pairs:
    """Pairs with one atom on either side; an atom on both sides is not bound to itself."""
    match bonds:
        case AllPairsBonds():
            one, other = np.repeat(left, right.size), np.tile(right, left.size)
            return one[one != other], other[one != other]
        case DistanceThresholdBonds():
            if bonds.metric == "grid":
                raise RuleError("metric", "`metric: grid` counts steps inside one group; it goes with `within`")
            first, second = near_pairs(position[left].T, position[right].T, bonds.threshold)
            return _apart(position, left[first], right[second])
        case ListedBonds():
            return _listed(bonds, left, right)
        case _:
            assert_never(bonds)


def _apart(position: Floats, one: Indices, other: Indices) -> Pairs:
    """Keep the pairs with 0 < d."""
    apart = (position[one] != position[other]).any(axis=1)
    return one[apart], other[apart]


def _listed(bonds: ListedBonds, left: Indices, right: Indices) -> Pairs:
    """Look the listed indices up in their selections."""
    for number, (i, k) in enumerate(bonds.pairs):
        for index, atoms in ((i, left), (k, right)):
            if index >= atoms.size:
                raise RuleError(
                    f"pairs.{number}",
                    f"index {index} is out of range; the atoms here are numbered 0 to {atoms.size - 1}",
                )
        if left[i] == right[k]:
            raise RuleError(f"pairs.{number}", f"[{i}, {k}] would bind an atom to itself")
    one, other = np.array(bonds.pairs, dtype=np.int64).T
    return left[one], right[other]


def _in_space(places: Indices) -> Floats:
    """Return grid places as positions with spacing one, (3, n)."""
    position = np.zeros((3, places.shape[0]))
    position[: places.shape[1]] = places.T
    return position


def _why_no_pairs(bonds: Bonds) -> tuple[str, str]:
    """Say why a declaration binds nothing."""
    if isinstance(bonds, DistanceThresholdBonds):
        where = " on the grid" if bonds.metric == "grid" else ""
        return "threshold", f"nothing is bound: no two atoms are less than {bonds.threshold:g} apart{where}"
    return (
        "within" if bonds.within is not None else "between",
        "nothing is bound: there are no two different atoms here",
    )
