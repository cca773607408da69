"""Eigenvectors of many small symmetric matrices at once, from + − × ÷ and √ alone, so to the same bits everywhere."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats

NEGLIGIBLE = 2.0**-60
"""Off the diagonal nothing larger than this is left, as a share of the largest number of a matrix."""

MOST_SWEEPS = 15
"""Convergence is quadratic, and matrices of four rows take five sweeps or six."""


def eigen(matrices: Floats) -> tuple[Floats, Floats]:
    """Diagonalise by Jacobi's rotations (Golub and Van Loan, Matrix Computations, 8.5).

    Args:
        matrices: symmetric, (n, n, m) float64.

    Returns:
        Eigenvalues (n, m), in descending order, and unit eigenvectors (n, n, m): that of value k is [:, k].
    """
    matrix = matrices.copy()
    n = len(matrix)
    vectors = np.zeros_like(matrix)
    vectors[range(n), range(n)] = 1.0
    least = NEGLIGIBLE * np.abs(matrix).max(axis=(0, 1))
    for _ in range(MOST_SWEEPS):
        is_done = True
        for p, q in combinations(range(n), 2):
            is_large = np.abs(matrix[p, q]) > least
            if is_large.any():
                is_done = False
                _rotate(matrix, vectors, p, q, is_large)
        if is_done:
            break
    values = matrix[range(n), range(n)]
    order = np.argsort(-values, axis=0, kind="stable")
    return np.take_along_axis(values, order, axis=0), np.take_along_axis(vectors, order[None], axis=1)


def _rotate(matrix: Floats, vectors: Floats, p: int, q: int, is_large: NDArray[np.bool_]) -> None:
    """Make the entry (p, q) zero where it is large; where it is not, all numbers keep their bits."""
    with np.errstate(all="ignore"):
        ratio = (matrix[q, q] - matrix[p, p]) / (2.0 * matrix[p, q])
        tangent = np.where(ratio < 0.0, -1.0, 1.0) / (np.abs(ratio) + np.sqrt(ratio * ratio + 1.0))
    tangent = np.where(is_large, tangent, 0.0)
    cosine = 1.0 / np.sqrt(tangent * tangent + 1.0)
    sine = tangent * cosine
    for array in (matrix, matrix.transpose(1, 0, 2), vectors.transpose(1, 0, 2)):
        old = array[p].copy()
        array[p] = cosine * old - sine * array[q]
        array[q] = sine * old + cosine * array[q]
    matrix[p, q] = matrix[q, p] = np.where(is_large, 0.0, matrix[p, q])
