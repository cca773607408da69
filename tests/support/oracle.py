"""The paper's model pair by pair and number by number, in plain Python; imports nothing of the package.

It is slow on purpose: every sum is a loop, in the order that the numerics convention writes down, over a pair table
that lists every pair. A scene comes in as plain data (the `model_dump()` of a valid scene), so selections, rules and
initial positions are worked out here a second time, by other means than the compiler's.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import random
import struct
from dataclasses import dataclass
from typing import Any

from support.oracle_pairs import Group, Groups, bound_pairs, colliding_pairs, rest_squared, select, select_by_copy
from support.oracle_shapes import Vector, add, cross, quantise, square, sub, unit

Data = dict[str, Any]


@dataclass
class World:
    """Everything about a scene as flat lists, and its state at `round_index`."""

    time_step: float
    round_index: int
    position: list[Vector]
    velocity: list[Vector]
    bonds: list[list[tuple[int, int, float]]]
    """Per declaration, sorted: atom, atom, squared desired distance."""
    collisions: list[list[tuple[int, int]]]
    """Per declaration, sorted: atom, atom."""
    forces: list[Data]

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds (paper section 2.2)."""
        for _ in range(n_rounds):
            impulse = self._impulse()
            self.velocity = [add(v, j) for v, j in zip(self.velocity, impulse, strict=True)]
            step = [(self.time_step * x, self.time_step * y, self.time_step * z) for x, y, z in self.velocity]
            self.position = [add(c, s) for c, s in zip(self.position, step, strict=True)]
            self.round_index += 1

    def digest(self) -> str:
        """Return the state digest."""
        digest = hashlib.sha256()
        for vectors in (self.position, self.velocity):
            for vector in vectors:
                digest.update(struct.pack("<3d", *(part + 0.0 for part in vector)))
        return digest.hexdigest()

    def is_finite(self) -> bool:
        """Return whether the numbers still mean something."""
        return all(math.isfinite(part) for vector in self.position + self.velocity for part in vector)

    def _impulse(self) -> list[Vector]:
        impulse = [(0.0, 0.0, 0.0)] * len(self.position)
        for bonds in self.bonds:
            self._add_table(impulse, [(i, k, _bond_weight(self._square(i, k), r2)) for i, k, r2 in bonds])
        for collisions in self.collisions:
            self._add_table(impulse, [(i, k, _collision_weight(self._square(i, k))) for i, k in collisions])
        for force in self.forces:
            self._add_force(impulse, force)
        for force in self.forces:
            if force["kind"] == "hold":
                for atom in force["atoms"]:
                    impulse[atom] = (0.0, 0.0, 0.0)
        return impulse

    def _square(self, i: int, k: int) -> float:
        return square(sub(self.position[k], self.position[i]))

    def _add_table(self, impulse: list[Vector], weighted: list[tuple[int, int, float]]) -> None:
        """Sum a table on its own, then add its subtotals."""
        subtotal = [(0.0, 0.0, 0.0)] * len(impulse)
        for i, k, weight in weighted:
            x, y, z = sub(self.position[k], self.position[i])
            force = (weight * x, weight * y, weight * z)
            subtotal[i] = add(subtotal[i], force)
            subtotal[k] = sub(subtotal[k], force)
        for atom, total in enumerate(subtotal):
            impulse[atom] = add(impulse[atom], total)

    def _add_force(self, impulse: list[Vector], force: Data) -> None:
        for atom, extra in zip(force["atoms"], self._external(force), strict=True):
            impulse[atom] = add(impulse[atom], extra)

    def _external(self, force: Data) -> list[Vector]:
        """Return what a force adds to each of its atoms in this round."""
        atoms = force["atoms"]
        match force["kind"]:
            case "damping":
                m = force["coefficient"]
                return [(-(m * x), -(m * y), -(m * z)) for x, y, z in (self.velocity[atom] for atom in atoms)]
            case "gravity":
                return [force["impulse"]] * len(atoms)
            case "push" if force["towards"]:
                return self._towards(force)
            case "push":
                until = math.inf if force["until_round"] is None else force["until_round"]
                is_on = force["from_round"] <= self.round_index < until
                return [force["impulse"] if is_on else (0.0, 0.0, 0.0)] * len(atoms)
            case "oscillate":
                angle = 2.0 * math.pi * self.round_index / force["period"] + force["phase"]
                x, y, z = force["impulse"]
                swing = quantise(math.sin(angle))
                return [(x * swing, y * swing, z * swing)] * len(atoms)
            case "torque":
                return self._torque(force)
            case "tether":
                pulled = zip(atoms, force["targets"], force["rest_squared"], strict=True)
                return [self._pull(atom, target, r2) for atom, target, r2 in pulled]
            case "hold":
                return [(0.0, 0.0, 0.0)] * len(atoms)
        raise ValueError(force["kind"])

    def _torque(self, force: Data) -> list[Vector]:
        x, y, z = _sum([self.position[atom] for atom in force["about_atoms"]])
        n_about = len(force["about_atoms"])
        centre = (x / n_about, y / n_about, z / n_about)
        axis = unit(force["axis"])
        arms = [cross(axis, sub(self.position[atom], centre)) for atom in force["atoms"]]
        leverage = 0.0
        for arm in arms:
            leverage += square(arm)
        if leverage == 0.0:
            return [(0.0, 0.0, 0.0)] * len(arms)
        scale = force["magnitude"] / leverage
        return [(scale * x, scale * y, scale * z) for x, y, z in arms]

    def _towards(self, force: Data) -> list[Vector]:
        until = math.inf if force["until_round"] is None else force["until_round"]
        if not force["from_round"] <= self.round_index < until:
            return [(0.0, 0.0, 0.0)] * len(force["atoms"])
        if force["centre_atoms"]:
            x, y, z = _sum([self.position[atom] for atom in force["centre_atoms"]])
            n_atoms = len(force["centre_atoms"])
            target = (x / n_atoms, y / n_atoms, z / n_atoms)
        else:
            target = force["towards"]
        pushes = []
        for atom in force["atoms"]:
            x, y, z = sub(target, self.position[atom])
            length = math.sqrt(square((x, y, z)))
            weight = force["magnitude"] / length if length else 0.0
            pushes.append((weight * x, weight * y, weight * z))
        return pushes

    def _pull(self, atom: int, target: Vector, r2: float) -> Vector:
        x, y, z = sub(target, self.position[atom])
        weight = _bond_weight(square((x, y, z)), r2) if (x, y, z) != (0.0, 0.0, 0.0) else 0.0
        return (weight * x, weight * y, weight * z)


def build(scene: Data) -> World:
    """Work out a world at round 0 from the plain data of a scene."""
    groups = {name: Group(data) for name, data in scene["groups"].items()}
    for group, start in zip(groups.values(), itertools.accumulate(map(len, groups.values()), initial=0), strict=False):
        group.start = start
    placed = [position for group in groups.values() for position in group.position]
    bonds = [bound_pairs(entry, groups, placed) for entry in scene["bonds"].values()]
    return World(
        time_step=scene["time_step"],
        round_index=0,
        position=_jittered(placed, scene["jitter"]),
        velocity=[velocity for group in groups.values() for velocity in group.velocity],
        bonds=bonds,
        collisions=[colliding_pairs(entry, groups, bonds) for entry in scene["collisions"].values()],
        forces=[force for entry in scene["forces"].values() for force in _forces(entry, groups, placed)],
    )


def _forces(entry: Data, groups: Groups, placed: list[Vector]) -> list[Data]:
    """Return a force with its atoms; a torque is one for each copy."""
    if entry["kind"] == "torque":
        turned, about = (select_by_copy(entry[key] or entry["acts_on"], groups) for key in ("acts_on", "about"))
        n_copies = max(len(turned), len(about))
        return [
            dict(entry, atoms=turned[number % len(turned)], about_atoms=about[number % len(about)])
            for number in range(n_copies)
        ]
    if entry["kind"] == "push" and entry["towards"]:
        return _pushes_towards(entry, groups)
    force = dict(entry, atoms=select(entry["acts_on"], groups))
    if entry["kind"] == "tether":
        is_own = entry["target"] == "initial"
        force["targets"] = [placed[atom] if is_own else entry["target"] for atom in force["atoms"]]
        squares = [
            square(sub(target, placed[atom])) for atom, target in zip(force["atoms"], force["targets"], strict=True)
        ]
        force["rest_squared"] = [rest_squared(entry["rest"], initial) for initial in squares]
    return [force]


def _pushes_towards(entry: Data, groups: Groups) -> list[Data]:
    """Return a push towards a point, or towards each copy of something."""
    if not isinstance(entry["towards"][0], str):
        return [dict(entry, atoms=select(entry["acts_on"], groups), centre_atoms=[])]
    centres = select_by_copy(entry["towards"], groups)
    if len(centres) == 1:
        return [dict(entry, atoms=select(entry["acts_on"], groups), centre_atoms=centres[0])]
    pushed = select_by_copy(entry["acts_on"], groups)
    return [
        dict(entry, atoms=pushed[number % len(pushed)], centre_atoms=centre) for number, centre in enumerate(centres)
    ]


def _bond_weight(square: float, r2: float) -> float:
    return 1.0 - r2 * (1.0 / square if square else math.inf)


def _collision_weight(square: float) -> float:
    return min(0.0, 1.0 - 4.0 * (1.0 / square if square else math.inf))


def _jittered(placed: list[Vector], jitter: Data | None) -> list[Vector]:
    if jitter is None:
        return placed
    uniform = random.Random(jitter["seed"]).random
    return [tuple(part + jitter["amplitude"] * (2.0 * uniform() - 1.0) for part in vector) for vector in placed]


def _sum(vectors: list[Vector]) -> Vector:
    total = (0.0, 0.0, 0.0)
    for vector in vectors:
        total = add(total, vector)
    return total
