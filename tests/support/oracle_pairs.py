"""The oracle's selections and rules, atom by atom and pair by pair; imports nothing of the package."""

from __future__ import annotations

import itertools
import math
from typing import Any

from support.oracle_shapes import Vector, place, square, sub

Data = dict[str, Any]


class Group:
    """A group of a scene: its plain data, its first atom, and where its atoms start."""

    def __init__(self, data: Data) -> None:
        self.data = data
        self.start = 0
        self.position, self.velocity = place(data)

    def __len__(self) -> int:
        return len(self.position)

    @property
    def n_copies(self) -> int:
        """How many copies there are, itself counted."""
        return math.prod(copies["count"] for copies in self.data["copies"])

    @property
    def each(self) -> int:
        """The number of atoms of one copy."""
        return len(self) // self.n_copies

    @property
    def is_closed(self) -> bool:
        """Whether the last atom is next to the first."""
        return self.data["shape"] in ("ring", "polygon")

    def grid_place(self, index: int) -> tuple[int, ...]:
        """Return where on the grid of its copy an atom stands, x first."""
        index, place = index % self.each, []
        for count in self.data["counts"]:
            place.append(index % count)
            index //= count
        return tuple(place)


Groups = dict[str, Group]


def select(expressions: tuple[str, ...], groups: Groups) -> list[int]:
    """Return the atoms that any of the expressions names, ascending."""
    return sorted({atom for expression in expressions for atom in _select_one(expression, groups)})


def select_by_copy(expressions: tuple[str, ...], groups: Groups) -> list[list[int]]:
    """Return the atoms of each copy; what has none, or is one copy, goes with all of them."""
    numbers = {copy for expression in expressions for copy in _copies_of(expression, groups)} or {0}
    return [
        sorted({a for text in expressions for a in _select_one(text, groups) if _goes_with(number, a, text, groups)})
        for number in sorted(numbers)
    ]


def _copies_of(expression: str, groups: Groups) -> range:
    """Return the numbers of the copies that an expression names each of; none where it does not."""
    name = expression.partition("[")[0].strip()
    n_copies = groups[name].n_copies if name in groups else 1
    return range(n_copies) if n_copies > 1 else range(0)


def _goes_with(number: int, atom: int, expression: str, groups: Groups) -> bool:
    """Tell whether an atom that an expression names is of one copy, or of none."""
    if not _copies_of(expression, groups):
        return True
    group = groups[expression.partition("[")[0].strip()]
    return (atom - group.start) // group.each == number


def _select_one(expression: str, groups: Groups) -> list[int]:
    name, _, inside = expression.replace(" ", "").rstrip("]").partition("[")
    if name == "all":
        return [atom for group in groups.values() for atom in range(group.start, group.start + len(group))]
    name, _, copy = name.partition(".")
    group = groups[name]
    axes = [_axis(text) for text in inside.split(",")] if inside else [slice(None)]
    if len(axes) == 1:
        chosen = set(_range(axes[0], group.each))
        of_copy = [index for index in range(group.each) if index in chosen]
    else:
        allowed = [set(_range(axis, count)) for axis, count in zip(axes, group.data["counts"], strict=True)]
        of_copy = [
            index
            for index in range(group.each)
            if all(place in places for place, places in zip(group.grid_place(index), allowed, strict=True))
        ]
    numbers = [int(copy)] if copy else range(group.n_copies)
    return [group.start + number * group.each + index for number in numbers for index in of_copy]


def _axis(text: str) -> int | slice:
    bounds = [int(bound) if bound else None for bound in text.split(":")]
    return slice(*bounds) if ":" in text else int(text)


def _range(axis: int | slice, count: int) -> list[int]:
    everything = list(range(count))
    return everything[axis] if isinstance(axis, slice) else [everything[axis]]


def bound_pairs(entry: Data, groups: Groups, placed: list[Vector]) -> list[tuple[int, int, float]]:
    """Return the pairs of a bond declaration, sorted, each with its squared desired distance."""
    pairs = {(min(pair), max(pair)) for pair in _pairs_of(entry, groups, placed) if pair[0] != pair[1]}
    return [(i, k, rest_squared(entry["rest"], square(sub(placed[k], placed[i])))) for i, k in sorted(pairs)]


def _pairs_of(entry: Data, groups: Groups, placed: list[Vector]) -> list[tuple[int, int]]:
    if entry.get("between"):
        left, right = (select_by_copy(side, groups) for side in entry["between"])
        n_copies = max(len(left), len(right))
        sides = zip((left * n_copies)[:n_copies], (right * n_copies)[:n_copies], strict=True)
        return [
            pair
            for one, other in sides
            for pair in _apply_rule(entry, list(itertools.product(one, other)), one, other, groups, placed)
        ]
    found = []
    for expression in entry["within"]:
        for atoms in select_by_copy((expression,), groups):
            if entry["rule"] == "neighbour":
                found += _neighbours(entry, atoms, expression, groups)
            else:
                found += _apply_rule(entry, list(itertools.combinations(atoms, 2)), atoms, atoms, groups, placed)
    return found


def _apply_rule(
    entry: Data, every: list[tuple[int, int]], left: list[int], right: list[int], groups: Groups, placed: list[Vector]
) -> list[tuple[int, int]]:
    match entry["rule"]:
        case "all-pairs":
            return every
        case "pairs":
            return [(left[i], right[k]) for i, k in entry["pairs"]]
        case "distance-threshold":
            limit = entry["threshold"] * entry["threshold"]
            if entry["metric"] == "grid":
                return [(i, k) for i, k in every if _grid_square(i, k, groups) < limit]
            return [(i, k) for i, k in every if 0.0 < square(sub(placed[k], placed[i])) < limit]
    raise ValueError(entry["rule"])


def _grid_square(i: int, k: int, groups: Groups) -> int:
    group = next(group for group in groups.values() if group.start <= i < group.start + len(group))
    one, other = group.grid_place(i - group.start), group.grid_place(k - group.start)
    return sum((a - b) ** 2 for a, b in zip(one, other, strict=True))


def _neighbours(entry: Data, atoms: list[int], expression: str, groups: Groups) -> list[tuple[int, int]]:
    closed = entry["closed"]
    if closed is None:
        name = expression.partition(".")[0]
        closed = name in groups and "[" not in expression and groups[name].is_closed
    found = []
    for (one, i), (other, k) in itertools.combinations(enumerate(atoms), 2):
        gap = other - one
        if gap <= entry["reach"] or (closed and len(atoms) - gap <= entry["reach"]):
            found.append((i, k))
    return found


def colliding_pairs(entry: Data, groups: Groups, bonds: list[list[tuple[int, int, float]]]) -> list[tuple[int, int]]:
    """Return the pairs of a collision declaration, sorted."""
    found: set[tuple[int, int]] = set()
    for expression in entry["within"] or ():
        copies = [list(enumerate(atoms)) for atoms in select_by_copy((expression,), groups)]
        for numbered in copies:
            pairs = itertools.combinations(numbered, 2)
            found |= {(i, k) for (one, i), (other, k) in pairs if other - one >= (entry["min_gap"] or 1)}
        for one_copy, other_copy in itertools.combinations(copies, 2):
            found |= {(i, k) for _, i in one_copy for _, k in other_copy}
    sides = [select(side, groups) for side in entry["between"] or entry["among"] or ()]
    for left, right in itertools.combinations(sides, 2):
        found |= {(min(i, k), max(i, k)) for i in left for k in right if i != k}
    left_out = {atom: _around(atom, int(entry["except_bound"]), bonds) for atom in {atom for atom, _ in found}}
    return sorted((i, k) for i, k in found if k not in left_out[i])


def _around(atom: int, n_bonds: int, bonds: list[list[tuple[int, int, float]]]) -> set[int]:
    """Return the atoms that are so many bonds away at most: as far as a rumour comes that bonds pass on."""
    know: set[int] = {atom}
    for _ in range(n_bonds):
        know |= {k for table in bonds for pair in table for i, k in (pair[:2], pair[1::-1]) if i in know}
    return know - {atom}


def rest_squared(rest: float | str, initial: float) -> float:
    """Return the square of a desired distance."""
    return initial if rest == "initial" else rest * rest
