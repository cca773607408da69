"""Rigidity: the motions that the bonds of a body do not resist, beyond moving and turning it as a whole.

A body is judged in generic position, with every atom moved a little at random: a drawn shape has motions that are
false, as a flat ring resists no motion out of its plane, to first order, however well it is bound. In generic position
the number of free motions depends on the bonds alone (L. Asimow, B. Roth, The rigidity of graphs, 1978).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atomsim.core.diagnosis.clusters import Bars, clusters, prune
from atomsim.core.diagnosis.numbering import numbered
from atomsim.core.model import Floats, Indices
from atomsim.core.pairs.near import distinct

Mask = NDArray[np.bool_]

JITTER, SEED = 0.05, 1
"""How far each coordinate is moved to a generic position, at most [length], and the seed of these moves."""

TOLERANCE = 1e-9
"""Eigenvalues of RᵀR below this part of the largest are zero."""

MOST_FREEDOMS = 1200
"""The rank of the matrix of more freedoms than these is not computed."""


NOTHING: Indices = np.empty(0, dtype=np.int64)
"""No atoms."""


@dataclass(frozen=True, slots=True, eq=False)
class Rigidity:
    """How floppy a body is.

    Attributes:
        n_modes: how many independent motions it allows itself.
        is_exact: whether this is all; else there may be more than a count of bonds proves.
        mode: the smoothest of these motions, (n_atoms, 3), its largest displacement 1 long; None where there is none,
            or where it was not computed.
    """

    n_modes: int
    is_exact: bool
    mode: Floats | None = None


def rigidity(position: Floats, bars: Bars, is_held: Mask, *, with_mode: bool = False) -> Rigidity:
    """Return how floppy one body is.

    Atoms with up to three bonds are taken away one after the other, each of which takes as many freedoms as it has
    bonds; what is left is joined to rigid clusters as far as three bonds at a time do it. Both steps are exact in
    generic position (they are Henneberg's, backwards and forwards), for any size. What clusters and atoms then allow is
    the rank of their bonds, by eigenvalues. Where that is too large, freedoms less bonds is a lower bound (Maxwell).

    Args:
        position: of its atoms [length], (n_atoms, 3).
        bars: its bonds, each once, by the places of their atoms.
        is_held: whether each atom is held, (n_atoms,).
        with_mode: whether to compute a motion, which takes longer.
    """
    n_atoms = position.shape[0]
    generic = position + _noise(n_atoms)
    n_freedoms = 3 * int((~is_held).sum())
    n_taken, is_left = (0, np.ones(n_atoms, dtype=bool)) if with_mode else prune(bars, n_atoms, is_held)
    left = bars.among(is_left)
    part = clusters(left, n_atoms, is_held)
    system = _System.of(generic, part, is_left, is_held)
    inner = left.between(part)
    trivial = _n_trivial(n_atoms, int(is_held.sum()))
    n_rigid = 3 * int((is_left & ~is_held).sum()) - system.n_freedoms  # what rigid clusters take
    if system.n_freedoms > MOST_FREEDOMS:
        n_bound = n_freedoms - n_taken - n_rigid - inner.first.size - trivial
        return Rigidity(max(0, n_bound), is_exact=False)
    values, vectors = system.spectrum(generic, inner)
    n_zero = int((values <= TOLERANCE * max(float(values.max(initial=0.0)), 1e-300)).sum())
    n_modes = n_freedoms - n_taken - n_rigid - (system.n_freedoms - n_zero) - trivial
    mode = None
    if with_mode and n_modes > 0:
        mode = _smoothest(system.motions(generic, vectors[:, :n_zero]), generic, bars, is_held)
    return Rigidity(n_modes, is_exact=True, mode=mode)


def joint_rigidity(position: Floats, part: Indices, bars: Bars, is_held: Mask, *, with_mode: bool = False) -> Rigidity:
    """Return how loosely the parts of a body are joined, if each part were rigid by itself.

    Args:
        position: of its atoms [length], (n_atoms, 3).
        part: the part of every atom, (n_atoms,).
        bars: the bonds, each once, by the places of their atoms.
        is_held: whether each atom is held, (n_atoms,).
        with_mode: whether to return a motion, too.
    """
    generic = position + _noise(position.shape[0])
    is_ground = np.zeros(position.shape[0], dtype=bool)
    for name in distinct([part]).tolist():
        atoms = part == name
        is_ground[atoms] = int((is_held & atoms).sum()) >= 3 or bool(is_held[atoms].all())
    label = np.where(is_ground, -1, numbered(part))
    system = _System.of(generic, label, np.ones(part.size, dtype=bool), is_ground)
    if system.n_freedoms > MOST_FREEDOMS:
        return Rigidity(0, is_exact=False)
    values, vectors = system.spectrum(generic, bars.between(label), pinned=np.flatnonzero(is_held & ~is_ground))
    n_zero = int((values <= TOLERANCE * max(float(values.max(initial=0.0)), 1e-300)).sum())
    n_modes = n_zero - _n_trivial(position.shape[0], int(is_held.sum()))
    mode = None
    if with_mode and n_modes > 0:
        mode = _smoothest(system.motions(generic, vectors[:, :n_zero]), generic, bars, is_held)
    return Rigidity(max(0, n_modes), is_exact=True, mode=mode)


def _noise(n_atoms: int) -> Floats:
    return np.random.default_rng(SEED).uniform(-JITTER, JITTER, (n_atoms, 3))


def _n_trivial(n_atoms: int, n_held: int) -> int:
    """Return how many motions of a body as a whole are free: those of a body with so many pins in generic position."""
    if n_held >= 3 or n_atoms <= n_held:
        return 0
    if n_held:
        return {1: 3, 2: 1}[n_held] if n_atoms > 2 else 2
    return {1: 3, 2: 5}.get(n_atoms, 6)


@dataclass(frozen=True, slots=True, eq=False)
class _System:
    """The freedoms of clusters and single atoms as columns of a matrix.

    A cluster moves by v + ω × (x − centre) with ω scaled by its radius, so that all columns are alike in size; a
    cluster of two atoms has the turn about its own axis left over, which moves nothing.

    Attributes:
        cluster: the cluster of every atom, −1 for what does not move, (n_atoms,).
        centre: of every cluster [length], (n_clusters, 3).
        radius: of every cluster [length], (n_clusters,).
        column: the first column of every cluster, (n_clusters,).
        n_columns: all columns.
        n_freedoms: those that move something.
        is_single: whether each cluster is an atom, with three columns instead of six, (n_clusters,).
    """

    cluster: Indices
    centre: Floats
    radius: Floats
    column: Indices
    n_columns: int
    n_freedoms: int
    is_single: Mask

    @classmethod
    def of(cls, position: Floats, part: Indices, is_left: Mask, is_fixed: Mask) -> _System:
        """Number the freedoms of those atoms that are left and not fixed."""
        moves = is_left & ~is_fixed & (part >= 0)
        cluster = np.full(part.size, -1)
        cluster[moves] = numbered(part[moves])
        n_clusters = int(cluster.max(initial=-1)) + 1
        size = np.bincount(cluster[moves], minlength=n_clusters)
        sums = [np.bincount(cluster[moves], weights=axis, minlength=n_clusters) for axis in position[moves].T]
        centre = np.stack(sums, axis=1) / np.maximum(size, 1)[:, None]
        offset = position[moves] - centre[cluster[moves]]
        spread = np.bincount(cluster[moves], weights=(offset * offset).sum(axis=1), minlength=n_clusters)
        radius = np.sqrt(spread / np.maximum(size, 1))
        width = np.where(size == 1, 3, 6)
        column = np.cumsum(width) - width
        n_freedoms = int((width - (size == 2)).sum())
        return cls(cluster, centre, np.where(size == 1, 1.0, radius), column, int(width.sum()), n_freedoms, size == 1)

    def spectrum(self, position: Floats, bars: Bars, pinned: Indices = NOTHING) -> tuple[Floats, Floats]:
        """Return the eigenvalues of RᵀR, ascending, and its eigenvectors; idle turns of pairs are left out."""
        matrix = np.zeros((self.n_columns, self.n_columns))
        direction = position[bars.second] - position[bars.first]
        direction /= np.sqrt((direction * direction).sum(axis=1))[:, None]
        for start in range(0, bars.first.size, 4096):
            stretch = slice(start, start + 4096)
            rows = np.zeros((direction[stretch].shape[0], self.n_columns))
            self._fill(rows, bars.first[stretch], -direction[stretch], position)
            self._fill(rows, bars.second[stretch], direction[stretch], position)
            matrix += rows.T @ rows
        for axis in np.eye(3):
            rows = np.zeros((pinned.size, self.n_columns))
            self._fill(rows, pinned, np.tile(axis, (pinned.size, 1)), position)
            matrix += rows.T @ rows
        largest = max(float(np.abs(matrix).max(initial=0.0)), 1.0)
        self._stiffen_idle_turns(matrix, position, largest)
        values, vectors = np.linalg.eigh(matrix)
        return values, vectors

    def _fill(self, rows: Floats, atoms: Indices, direction: Floats, position: Floats) -> None:
        """Add to each row how the freedoms of an atom move it along a direction."""
        cluster = self.cluster[atoms]
        row = np.flatnonzero(cluster >= 0)
        cluster, direction = cluster[row], direction[row]
        column = self.column[cluster]
        turn = np.cross(position[atoms[row]] - self.centre[cluster], direction) / self.radius[cluster][:, None]
        turns = np.flatnonzero(~self.is_single[cluster])
        for axis in range(3):
            rows[row, column + axis] += direction[:, axis]
            rows[row[turns], column[turns] + 3 + axis] += turn[turns, axis]

    def _stiffen_idle_turns(self, matrix: Floats, position: Floats, stiffness: float) -> None:
        """Resist the turn of every pair of atoms about its own axis, which moves nothing."""
        size = np.bincount(self.cluster[self.cluster >= 0], minlength=self.column.size)
        for cluster in np.flatnonzero(size == 2).tolist():
            one, other = np.flatnonzero(self.cluster == cluster)
            axis = position[other] - position[one]
            axis /= np.sqrt(axis @ axis)
            place = slice(int(self.column[cluster]) + 3, int(self.column[cluster]) + 6)
            matrix[place, place] += stiffness * np.outer(axis, axis)

    def motions(self, position: Floats, vectors: Floats) -> Floats:
        """Return what combinations of freedoms do to the atoms, (n_vectors, n_atoms, 3)."""
        moved = np.zeros((vectors.shape[1], self.cluster.size, 3))
        for atom in np.flatnonzero(self.cluster >= 0).tolist():
            cluster = int(self.cluster[atom])
            column = int(self.column[cluster])
            moved[:, atom] = vectors[column : column + 3].T
            if not self.is_single[cluster]:
                turn = vectors[column + 3 : column + 6].T / self.radius[cluster]
                moved[:, atom] += np.cross(turn, position[atom] - self.centre[cluster])
        return moved


def _smoothest(motions: Floats, position: Floats, bars: Bars, is_held: Mask) -> Floats:
    """Return the combination of free motions that bends least from bond to bond, without moving the body as a whole."""
    flat = motions.reshape(motions.shape[0], -1)
    if not is_held.any():
        whole = _whole_motions(position)
        flat = flat - (flat @ whole.T) @ whole
    basis = _orthonormal(flat)
    change = basis.reshape(-1, *motions.shape[1:])
    change = (change[:, bars.second] - change[:, bars.first]).reshape(basis.shape[0], -1)
    vectors = np.linalg.eigh(change @ change.T)[1]
    mode = (vectors[:, 0] @ basis).reshape(motions.shape[1:])
    return np.asarray(mode / np.sqrt((mode * mode).sum(axis=1).max()))


def _whole_motions(position: Floats) -> Floats:
    """Return orthonormal motions of a body as a whole, (6 or fewer, 3 · n_atoms)."""
    offset = position - position.mean(axis=0)
    moves = [np.tile(axis, (position.shape[0], 1)) for axis in np.eye(3)]
    moves += [np.cross(axis, offset) for axis in np.eye(3)]
    return _orthonormal(np.stack(moves).reshape(6, -1))


def _orthonormal(rows: Floats) -> Floats:
    """Return an orthonormal basis of what rows span."""
    _, sizes, basis = np.linalg.svd(rows, full_matrices=False)
    return np.asarray(basis[sizes > 1e-6 * sizes.max(initial=1e-300)])
