"""Whether what a scene asks for fits into memory, told before any of it is made; knows counts, no positions."""

from __future__ import annotations

import math

from atomsim.compiler.selections import Selections
from atomsim.core.free_memory import free_memory, readable_bytes
from atomsim.scene.language import Bonds

BYTES_PER_ATOM = 600
"""What an atom costs while a scene compiles and runs, beside its pairs."""

BYTES_PER_PAIR = 100
"""What a bound pair costs while a scene compiles."""


def shortage(size: int, what: str) -> str | None:
    """Return the complaint about something that needs more bytes than are free, or None if it fits."""
    free = free_memory()
    if size <= free:
        return None
    return f"{what} need about {readable_bytes(size)} of memory, and {readable_bytes(free)} are free"


def n_countable_pairs(bonds: Bonds, selections: Selections) -> int:
    """Return how many pairs a rule makes at most, or 0 where only making them will tell.

    Raises:
        SelectionError: a selection that names no atoms.
    """
    copies = [selections.by_copy((part,)) for part in bonds.within or ()]
    sizes = [(len(atoms), atoms[0].size) for atoms in copies]
    if bonds.rule == "neighbour":
        return sum(n_copies * size * min(bonds.reach, size) for n_copies, size in sizes)
    if bonds.rule == "all-pairs" and bonds.between is not None:
        left, right = selections.matched(bonds.between)
        return sum(one.size * other.size for one, other in zip(left, right, strict=True))
    return sum(n_copies * math.comb(size, 2) for n_copies, size in sizes) if bonds.rule == "all-pairs" else 0
