"""The state digest names a state to the last bit."""

from __future__ import annotations

import hashlib
import struct

import numpy as np

from atomsim.core.digest import state_digest

POSITION = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, -0.0]])
VELOCITY = np.array([[0.5, -1.0, 0.0], [1e-300, 7.0, 8.0]])


def test_digest_is_that_of_the_bytes_position_first() -> None:
    numbers = [1, 2, 3, 4, 5, 0, 0.5, -1, 0, 1e-300, 7, 8]
    assert state_digest(POSITION, VELOCITY) == hashlib.sha256(struct.pack("<12d", *numbers)).hexdigest()
    assert state_digest(VELOCITY, POSITION) != state_digest(POSITION, VELOCITY)


def test_digest_is_the_same_however_the_numbers_lie_in_memory() -> None:
    for order in (POSITION.astype(">f8"), np.asfortranarray(POSITION), np.repeat(POSITION, 2, axis=0)[::2]):
        assert state_digest(order, VELOCITY) == state_digest(POSITION, VELOCITY)


def test_digest_knows_no_sign_of_zero_but_every_other_bit() -> None:
    assert state_digest(POSITION + 0.0, VELOCITY) == state_digest(POSITION, VELOCITY)
    other = POSITION.copy()
    other[1, 1] = np.nextafter(5.0, 6.0)
    assert state_digest(other, VELOCITY) != state_digest(POSITION, VELOCITY)
