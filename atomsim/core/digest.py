"""The state digest: 64 digits that name a state to the last bit; knows nothing of models and runs."""

from __future__ import annotations

import hashlib

import numpy as np

from atomsim.core.memory import EMPTY, Memory
from atomsim.core.model import Floats


def state_digest(position: Floats, velocity: Floats, memory: Memory = EMPTY) -> str:
    """Return SHA-256 over position, velocity and memory, little-endian, C order, −0.0 written as +0.0.

    Args:
        position: atom centres [length], (n_atoms, 3) float64.
        velocity: [length per unit of time], (n_atoms, 3) float64.
        memory: what else the state consists of, array by array; without any, the digest is of the atoms alone.

    Returns:
        64 hexadecimal digits.

    >>> import numpy as np
    >>> state_digest(np.zeros((1, 3)), -np.zeros((1, 3)))[:16]
    '17b0761f87b081d5'
    """
    digest = hashlib.sha256()
    for array in (position, velocity):
        digest.update(np.ascontiguousarray(array + 0.0, dtype="<f8").data)
    for array in memory.values():
        plain = array + 0.0 if array.dtype == np.float64 else array
        digest.update(np.ascontiguousarray(plain, array.dtype.newbyteorder("<")).data)
    return digest.hexdigest()
