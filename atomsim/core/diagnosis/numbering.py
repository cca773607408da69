"""Numbers for what is alike; NumPy's `unique` would load masked arrays first, which takes longer than most scenes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Indices


def numbered(*columns: NDArray[np.generic]) -> Indices:
    """Number the rows of a table, alike rows alike, in ascending order of their first columns.

    Args:
        columns: one or several, (n_rows,) each.

    Returns:
        (n_rows,) int64, from 0 on.

    >>> numbered(np.array([7, 3, 7, 9])).tolist()
    [1, 0, 1, 2]
    """
    order = np.lexsort(columns[::-1])
    is_new = np.zeros(order.size, dtype=bool)
    for column in columns:
        ordered = column[order]
        is_new[1:] |= ordered[1:] != ordered[:-1]
    number = np.empty(order.size, dtype=np.int64)
    number[order] = np.cumsum(is_new)
    return number
