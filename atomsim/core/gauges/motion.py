"""Where selections are and how they move: centroids, velocities, momenta, kinetic energies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from atomsim.core.gauges.block import Atoms, Block, Memoryless, cross, dot, length, one_row, ordered_sum
from atomsim.core.model import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Mean(Memoryless):
    """The mean position or velocity of some atoms, along some axes: centroid, height, velocity.

    Attributes:
        what: of what the mean is taken.
        atoms: whose.
        axes: which components, as 0, 1 and 2.
    """

    what: Literal["position", "velocity"]
    atoms: Atoms
    axes: tuple[int, ...] = (0, 1, 2)

    @property
    def n_columns(self) -> int:
        return len(self.axes)

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return Σ x / n per axis."""
        values = block.position if self.what == "position" else block.velocity
        return np.stack([mean(values[axis, self.atoms]) for axis in self.axes])


@dataclass(frozen=True, slots=True, eq=False)
class Speed(Memoryless):
    """The speed of the centroid of some atoms: |Σ v| / n."""

    atoms: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return |v| of the mean velocity v."""
        return one_row(length(mean(block.velocity[:, self.atoms])))


@dataclass(frozen=True, slots=True, eq=False)
class Fastest(Memoryless):
    """The speed of the fastest of some atoms: max |v|."""

    atoms: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the largest |v|."""
        velocity = block.velocity[:, self.atoms]
        return one_row(np.sqrt(dot(velocity, velocity).max(axis=0)))


@dataclass(frozen=True, slots=True, eq=False)
class Momentum(Memoryless):
    """Σ v of some atoms, along some axes."""

    atoms: Atoms
    axes: tuple[int, ...] = (0, 1, 2)

    @property
    def n_columns(self) -> int:
        return len(self.axes)

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the sum per axis."""
        return np.stack([ordered_sum(block.velocity[axis, self.atoms]) for axis in self.axes])


@dataclass(frozen=True, slots=True, eq=False)
class AngularMomentum(Memoryless):
    """Σ c × v of some atoms about the origin, along some axes."""

    atoms: Atoms
    axes: tuple[int, ...] = (0, 1, 2)

    @property
    def n_columns(self) -> int:
        return len(self.axes)

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the sum per axis."""
        moment = cross(block.position[:, self.atoms], block.velocity[:, self.atoms])
        return ordered_sum(moment[list(self.axes)])


@dataclass(frozen=True, slots=True, eq=False)
class KineticEnergy(Memoryless):
    """½ Σ |v|² of some atoms."""

    atoms: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return half the sum."""
        velocity = block.velocity[:, self.atoms]
        return one_row(0.5 * ordered_sum(dot(velocity, velocity)))


@dataclass(frozen=True, slots=True, eq=False)
class Distance(Memoryless):
    """The distance of the centroids of two selections."""

    first: Atoms
    second: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return |c₂ − c₁|."""
        return one_row(length(apart(block.position, self.first, self.second)))


@dataclass(frozen=True, slots=True, eq=False)
class RelativeVelocity(Memoryless):
    """The velocity of the centroid of a second selection seen from that of a first, along some axes."""

    first: Atoms
    second: Atoms
    axes: tuple[int, ...] = (0, 1, 2)

    @property
    def n_columns(self) -> int:
        return len(self.axes)

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return v₂ − v₁ per axis."""
        return apart(block.velocity[list(self.axes)], self.first, self.second)


@dataclass(frozen=True, slots=True, eq=False)
class ClosingSpeed(Memoryless):
    """How fast the centroids of two selections come nearer to each other; below zero where they part."""

    first: Atoms
    second: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return −(v₂ − v₁) · (c₂ − c₁) / |c₂ − c₁|, or zero where the centroids are at one place."""
        way = apart(block.position, self.first, self.second)
        distance = length(way)
        along = -dot(apart(block.velocity, self.first, self.second), way)
        return one_row(np.where(distance == 0.0, 0.0, along / np.where(distance == 0.0, 1.0, distance)))


def mean(values: Floats) -> Floats:
    """Return the mean over atoms: (…, n_atoms, n_frames) becomes (…, n_frames)."""
    return np.asarray(ordered_sum(values) / values.shape[-2])


def apart(values: Floats, first: Atoms, second: Atoms) -> Floats:
    """Return the mean of a second selection less that of a first: (n, n_atoms, n_frames) becomes (n, n_frames)."""
    return np.asarray(mean(values[:, second]) - mean(values[:, first]))
