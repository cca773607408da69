"""The finished trajectory: one HDF5 file, built from a journal. What its writer and its reader share stands here."""

from __future__ import annotations

NUMBERS = {"whole": "<i8", "wholes": "<i8", "real": "<f8", "flag": "?"}
"""Types of the plain values of the header that are not texts."""

PARAMETERS = "parameters/atomsim"
MEMORY = f"{PARAMETERS}/memory_value"
PARTICLES = "particles/trajectory"

_CHUNK_BYTES = 1 << 20
_MOST_CHUNK_ROWS = 64


def chunk_rows(n_frames: int, n_atoms: int) -> int:
    """Return how many frames share a chunk: about 1 MiB, at most 64, at least one, and never more than there are."""
    return min(n_frames, max(1, min(_CHUNK_BYTES // (24 * n_atoms), _MOST_CHUNK_ROWS)))
