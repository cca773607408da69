"""All pairs and pushes of a model as flat arrays, as any other program wants them; knows no engine and no clock."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from atomsim.core.model import Between, CollisionTable, Floats, Indices, Model, PushForce, Within

CONTACT_SQUARED = 4.0


@dataclass(frozen=True, slots=True, eq=False)
class PairTable:
    """Bonds and declared collision pairs alike, table after table, each sorted by (first, second).

    The force on the first atom is (c_k − c_i) · min(ceiling, 1 − r²/d²): with the ceiling 0 and r² = 4 that of a
    collision, with the ceiling +∞ that of a bond.

    Attributes:
        n_atoms: number of atoms.
        n_tables: number of force tables.
        table: force table of each pair, (n_pairs,) int64.
        first: lower atom of each pair, (n_pairs,) int64.
        second: higher atom of each pair, (n_pairs,) int64.
        rest_squared: r² [length²], (n_pairs,) float64.
        ceiling: what the weight may not exceed, (n_pairs,) float64.
        push: the same impulse in every round [length per unit of time], (n_atoms, 3) float64.
    """

    n_atoms: int
    n_tables: int
    table: Indices
    first: Indices
    second: Indices
    rest_squared: Floats
    ceiling: Floats
    push: Floats

    def seen_from_every_atom(self) -> tuple[Indices, Indices, Floats, Floats]:
        """Return each pair twice, as (atom, partner, r², ceiling), sorted by atom, (2 · n_pairs,) each."""
        atom = np.concatenate((self.second, self.first))
        partner = np.concatenate((self.first, self.second))
        order = np.argsort(atom, kind="stable")
        return atom[order], partner[order], np.tile(self.rest_squared, 2)[order], np.tile(self.ceiling, 2)[order]


def pair_table(model: Model) -> PairTable:
    """Write a model out.

    Raises:
        ValueError: it has a force from outside that is no constant push.
    """
    tables = [(bonds.first, bonds.second, bonds.rest_squared, np.inf) for bonds in model.bonds]
    for collisions in model.collisions:
        first, second = _collision_pairs(collisions, model.n_atoms)
        tables.append((first, second, np.full(first.size, CONTACT_SQUARED), 0.0))
    return PairTable(
        n_atoms=model.n_atoms,
        n_tables=len(tables),
        table=np.repeat(np.arange(len(tables)), [first.size for first, *_ in tables]),
        first=np.concatenate([first for first, *_ in tables]),
        second=np.concatenate([second for _, second, *_ in tables]),
        rest_squared=np.concatenate([rest_squared for _, _, rest_squared, _ in tables]),
        ceiling=np.concatenate([np.full(first.size, ceiling) for first, _, _, ceiling in tables]),
        push=_push(model),
    )


def _collision_pairs(table: CollisionTable, n_atoms: int) -> tuple[Indices, Indices]:
    """Return every declared pair once, first < second, sorted."""
    key = np.unique(np.concatenate([first * n_atoms + second for first, second in _each_block(table)]))
    first = key // n_atoms
    return first, key - first * n_atoms


def _each_block(table: CollisionTable) -> Iterator[tuple[Indices, Indices]]:
    for block in table.blocks:
        match block:
            case Within(atoms, min_gap):
                first, second = np.triu_indices(atoms.size, min_gap)
                yield atoms[first], atoms[second]
            case Between(left, right):
                one, other = np.repeat(left, right.size), np.tile(right, left.size)
                apart = one != other
                yield np.minimum(one, other)[apart], np.maximum(one, other)[apart]


def _push(model: Model) -> Floats:
    push = np.zeros((model.n_atoms, 3))
    for force in model.forces:
        if not isinstance(force, PushForce) or force.from_round > 0 or force.until_round is not None:
            raise ValueError(f"{force.origin}: only scenes whose forces are constant pushes can be compared")
        push[force.atoms] += force.impulse
    return push
