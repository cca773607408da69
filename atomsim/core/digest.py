"""The state digest: 64 digits that name a state to the last bit; knows nothing of models and runs."""

from __future__ import annotations

import hashlib

import numpy as np

from atomsim.core.model import Floats


def state_digest(position: Floats, velocity: Floats) -> str:
    """Return SHA-256 over position then velocity, little-endian float64, C order, −0.0 written as +0.0.

    Args:
        position: atom centres [length], (n_atoms, 3) float64.
        velocity: [length per unit of time], (n_atoms, 3) float64.

    Returns:
        64 hexadecimal digits.

    >>> import numpy as np
    >>> state_digest(np.zeros((1, 3)), -np.zeros((1, 3)))[:16]
    '17b0761f87b081d5'
    """
    digest = hashlib.sha256()
    for array in (position, velocity):
        digest.update(np.ascontiguousarray(array + 0.0, dtype="<f8").data)
    return digest.hexdigest()
