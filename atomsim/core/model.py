"""The compiled half of a scene and its changing half as plain frozen records; knows no scene, no file, no algorithm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.memory import EMPTY, Layout, Memory

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Origin:
    """The declaration something was compiled from: `bonds.left` at line 12 of rods.yaml; line 0 is all of a setting."""

    section: str
    name: str
    file: str
    line: int

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{self.section}.{self.name} ({place})"


@dataclass(frozen=True, slots=True)
class GroupSpan:
    """The consecutive atoms of one group, copy after copy: start ≤ atom < stop."""

    name: str
    start: int
    stop: int
    origin: Origin
    n_copies: int = 1


def atom_name(atom: int, groups: Sequence[GroupSpan]) -> str:
    """Write an atom as a selection does, with its number: `left[3] (atom 3)`."""
    group = next(group for group in groups if group.start <= atom < group.stop)
    return f"{atom_expression(group.name, atom - group.start, group.stop - group.start, group.n_copies)} (atom {atom})"


def atom_expression(name: str, index: int, n_atoms: int, n_copies: int) -> str:
    """Write the atom at an index of a group as a selection does.

    >>> atom_expression("left", 3, 9, 1), atom_expression("finger", 7, 12, 3)
    ('left[3]', 'finger.1[3]')
    """
    copy, inside = divmod(index, n_atoms // n_copies)
    return f"{name}[{inside}]" if n_copies == 1 else f"{name}.{copy}[{inside}]"


@dataclass(frozen=True, slots=True, eq=False)
class BondTable:
    """The pairs of one `bonds` declaration, canonical: first < second, no duplicates, sorted by (first, second).

    Attributes:
        origin: the declaration.
        first: lower atom of each pair, (n_pairs,) int64.
        second: higher atom of each pair, (n_pairs,) int64.
        rest_squared: square of the desired distance r of each pair [length²], (n_pairs,) float64.
    """

    origin: Origin
    first: Indices
    second: Indices
    rest_squared: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Within:
    """Atoms that collide with one another: all pairs at least `min_gap` places apart in `atoms` (ascending)."""

    atoms: Indices
    min_gap: int


@dataclass(frozen=True, slots=True, eq=False)
class Between:
    """Two sets of atoms (ascending): every atom of one collides with every other atom of the other."""

    left: Indices
    right: Indices


@dataclass(frozen=True, slots=True, eq=False)
class BoundPairs:
    """The pairs of atoms that are at most so many bonds apart, by sets of twins.

    Twins are atoms bound to one another and to the same others: a rigid body is one set, and its pairs are not listed.

    Attributes:
        twins: the set each atom belongs to, (n_atoms,) int64.
        n_sets: number of sets.
        sets_near: set · n_sets + set of all sets whose atoms are near enough, either way round and each with itself,
            ascending.
    """

    twins: Indices
    n_sets: int
    sets_near: Indices


@dataclass(frozen=True, slots=True, eq=False)
class CollisionTable:
    """The pairs of one `collisions` declaration as the union of its blocks; never expanded: a fluid has 10¹¹.

    Pairs that are `bound` are left out.
    """

    origin: Origin
    blocks: tuple[Within | Between, ...]
    bound: BoundPairs | None = None


@dataclass(frozen=True, slots=True, eq=False)
class DampingForce:
    """j ← j − m·v (paper section 2.3); `coefficient` is m."""

    origin: Origin
    atoms: Indices
    coefficient: float


@dataclass(frozen=True, slots=True, eq=False)
class PushForce:
    """j ← j + impulse while from_round ≤ round < until_round (None: for ever); gravity is a push for ever."""

    origin: Origin
    atoms: Indices
    impulse: tuple[float, float, float]
    from_round: int
    until_round: int | None


@dataclass(frozen=True, slots=True, eq=False)
class TowardsForce:
    """j ← j + magnitude · (t − c)/|t − c| while from_round ≤ round < until_round (None: for ever).

    t is the centroid of the atoms `centre` in that round, or the fixed point `target` where there are none of them.
    """

    origin: Origin
    atoms: Indices
    magnitude: float
    target: tuple[float, float, float]
    centre: Indices
    from_round: int
    until_round: int | None


@dataclass(frozen=True, slots=True, eq=False)
class OscillateForce:
    """j ← j + impulse · sin(2π·round/period + phase)."""

    origin: Origin
    atoms: Indices
    impulse: tuple[float, float, float]
    period: float
    phase: float


@dataclass(frozen=True, slots=True, eq=False)
class TorqueForce:
    """j ← j + s · axis × (c − centre), s such that the total torque about `axis` (a unit vector) is `magnitude`.

    The centre is the centroid of the atoms `about`.
    """

    origin: Origin
    atoms: Indices
    axis: tuple[float, float, float]
    magnitude: float
    about: Indices


@dataclass(frozen=True, slots=True, eq=False)
class TetherForce:
    """The bond force of each atom towards a fixed point.

    Attributes:
        origin: the declaration.
        atoms: the atoms, ascending.
        target: the fixed point of each [length], (n_atoms of `atoms`, 3).
        rest_squared: square of the desired distance r of each [length²], (n_atoms of `atoms`,).
    """

    origin: Origin
    atoms: Indices
    target: Floats
    rest_squared: Floats


@dataclass(frozen=True, slots=True, eq=False)
class HoldForce:
    """j ← 0: exactly opposite to everything else, after everything else."""

    origin: Origin
    atoms: Indices


ActingForce: TypeAlias = DampingForce | PushForce | TowardsForce | OscillateForce | TorqueForce | TetherForce
ExternalForce: TypeAlias = ActingForce | HoldForce


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """All that stays constant in a run; every array is read-only.

    Attributes:
        title: what the scene calls itself.
        time_step: τ [time].
        n_atoms: number of atoms; they are numbered 0 … n_atoms − 1.
        groups: spans of atoms, in order.
        bonds: one force table per declared `bonds` entry, in order.
        collisions: one force table per declared `collisions` entry, in order.
        forces: external forces in order of declaration.
        memory: what a run of it remembers besides positions and velocities.
    """

    title: str
    time_step: float
    n_atoms: int
    groups: tuple[GroupSpan, ...]
    bonds: tuple[BondTable, ...]
    collisions: tuple[CollisionTable, ...]
    forces: tuple[ExternalForce, ...]
    memory: Layout = ()

    def group_of(self, atom: int) -> GroupSpan:
        """Return the group that an atom belongs to."""
        return next(group for group in self.groups if group.start <= atom < group.stop)


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """All that changes in a run, at one round.

    Attributes:
        round_index: iteration rounds done.
        position: atom centres c [length], (n_atoms, 3) float64.
        velocity: v [length per unit of time], (n_atoms, 3) float64.
        memory: what else is remembered, in the layout of `Model.memory`.
    """

    round_index: int
    position: Floats
    velocity: Floats
    memory: Memory = EMPTY


@dataclass(frozen=True, slots=True, eq=False)
class Observables:
    """What is measured of a state.

    Attributes:
        kinetic_energy: ½ Σ |v|².
        potential_energy_bonds: (1/τ) Σ U over all bonds; the sum of the three energies is conserved as τ → 0.
        potential_energy_collisions: (1/τ) Σ U over all collision pairs in contact.
        momentum: Σ v, (3,) float64.
        angular_momentum: Σ c × v, (3,) float64.
        contacts: number of collision pairs in contact (centres less than 2 apart).
    """

    kinetic_energy: float
    potential_energy_bonds: float
    potential_energy_collisions: float
    momentum: Floats
    angular_momentum: Floats
    contacts: int


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A recorded round; a copy that is safe to keep.

    Attributes:
        state: all there is at that round; to go on from it, nothing else of a run has to be kept.
        time: round · τ [time].
        digest: the state digest, 64 hexadecimal digits.
        observables: what was measured of it.
    """

    state: State
    time: float
    digest: str
    observables: Observables

    @property
    def round_index(self) -> int:
        """Iteration rounds done."""
        return self.state.round_index

    @property
    def position(self) -> Floats:
        """Atom centres [length], (n_atoms, 3) float64."""
        return self.state.position

    @property
    def velocity(self) -> Floats:
        """Velocities [length per unit of time], (n_atoms, 3) float64."""
        return self.state.velocity

    @property
    def memory(self) -> Memory:
        """What else is remembered."""
        return self.state.memory
