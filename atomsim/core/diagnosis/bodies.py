"""Bodies, which are atoms that hang together by bonds."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from atomsim.core.model import Indices


def bodies(pairs: Iterable[tuple[Indices, Indices]], n_atoms: int) -> Indices:
    """Return the body of every atom, named by the first of its atoms; an atom without bonds is its own.

    Every round gives both ends of each bond the smaller name of the two, and every name the name that its owner has by
    now, so that even a long string is one body after a few rounds.

    Args:
        pairs: bonds: their first and their second atoms.
        n_atoms: number of atoms.

    Returns:
        (n_atoms,) int64.
    """
    ends = list(pairs)
    body = np.arange(n_atoms)
    while True:
        before = body.copy()
        for first, second in ends:
            one, other = body[first], body[second]
            smaller = np.minimum(one, other)
            np.minimum.at(body, one, smaller)
            np.minimum.at(body, other, smaller)
        while not np.array_equal(body, body[body]):
            body = body[body]
        if np.array_equal(body, before):
            return body
