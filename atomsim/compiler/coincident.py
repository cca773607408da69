"""Finding atoms at the same place, where a force would have no direction; knows positions and tables only."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import CollisionTable, Floats, Indices, Within


def coincident_pairs(position: Floats, table: CollisionTable) -> tuple[Indices, Indices]:
    """Return the pairs of a collision table at distance zero: sort atoms by place, compare equal neighbours only."""
    order = np.lexsort(position.T)
    same = np.flatnonzero((position[order[1:]] == position[order[:-1]]).all(axis=1))
    if not same.size:
        return order[:0], order[:0]
    runs = np.split(same, np.flatnonzero(np.diff(same) > 1) + 1)
    crowds = [np.sort(order[run[0] : run[-1] + 2]) for run in runs]
    pairs = [pair for crowd in crowds for pair in _pairs_among(crowd, table)]
    first, second = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return first, second


def _pairs_among(crowd: Indices, table: CollisionTable) -> Iterator[tuple[int, int]]:
    """Yield the pairs of a table among a few atoms."""
    for block in table.blocks:
        if isinstance(block, Within):
            inside = np.isin(crowd, block.atoms)
            places = np.searchsorted(block.atoms, crowd[inside])
            one, other = np.triu_indices(places.size, 1)
            far = places[other] - places[one] >= block.min_gap
            yield from zip(crowd[inside][one[far]].tolist(), crowd[inside][other[far]].tolist(), strict=True)
        else:
            left, right = crowd[np.isin(crowd, block.left)], crowd[np.isin(crowd, block.right)]
            yield from ((i, k) for i in left.tolist() for k in right.tolist() if i != k)
