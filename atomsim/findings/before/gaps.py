"""Gaps that a threshold leaves open, and the smallest threshold that would close them."""

from __future__ import annotations

import numpy as np

from atomsim.core.diagnosis.bodies import bodies
from atomsim.core.model import Floats, Indices
from atomsim.core.pairs.near import near_pairs, pair_squares
from atomsim.findings.subject import Subject
from atomsim.scene.language import DistanceThresholdBonds

FARTHER = (1.25, 1.6, 2.0, 3.0, 5.0, 10.0)
"""How many times the threshold is tried to find one that closes the gaps."""

MOST_ATOMS = 20_000
"""No more atoms are tried for a better threshold."""


def places(subject: Subject, rule: DistanceThresholdBonds, expression: str, atoms: Indices) -> Floats:
    """Return where the atoms of one copy of a selection are, as a rule measures distances, (3, n_atoms)."""
    steps = subject.selections.grid_places(expression) if rule.metric == "grid" else None
    if steps is None:
        return subject.placed[atoms].T
    position = np.zeros((3, steps.shape[0]))
    position[: steps.shape[1]] = steps.T
    return position


def widest_gap(position: Floats, rule: DistanceThresholdBonds) -> float | None:
    """Return the widest gap that bonds have to bridge for all atoms to be one body, or None where it is far wider.

    Args:
        position: places of atoms that the rule does not make one body, (3, n_atoms).
        rule: the rule.
    """
    n_atoms, threshold = position.shape[1], rule.threshold
    for factor in FARTHER if n_atoms <= MOST_ATOMS else ():
        first, second = near_pairs(position, None, factor * threshold)
        distance = np.sqrt(pair_squares(position, first, second))
        if not _are_one(first, second, n_atoms):
            continue
        order = np.argsort(distance)
        enough, too_few = order.size, 0
        while enough - too_few > 1:
            tried = order[: (enough + too_few) // 2]
            if _are_one(first[tried], second[tried], n_atoms):
                enough = tried.size
            else:
                too_few = tried.size
        return float(distance[order[enough - 1]])
    return None


def nearest(left: Floats, right: Floats, threshold: float) -> float | None:
    """Return the smallest distance between two sets of atoms, (3, n) each; None where it is far above a threshold."""
    for factor in FARTHER if left.shape[1] + right.shape[1] <= MOST_ATOMS else ():
        first, second = near_pairs(left, right, factor * threshold)
        if first.size:
            return float(np.sqrt(((left[:, first] - right[:, second]) ** 2).sum(axis=0).min()))
    return None


def _are_one(first: Indices, second: Indices, n_atoms: int) -> bool:
    return not bodies([(first, second)], n_atoms).any()
