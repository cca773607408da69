"""The place where two sequences of frames first differ, and by how much."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atomsim.core.memory import Memory
from atomsim.core.model import Floats, Frame, GroupSpan, atom_name


@dataclass(frozen=True, slots=True)
class Difference:
    """The first place where two trajectories differ; `str()` writes it for people."""

    round_index: int
    message: str

    def __str__(self) -> str:
        return self.message


def first_difference(
    left: Iterable[Frame],
    right: Iterable[Frame],
    groups: Sequence[GroupSpan],
    tolerance: float = 0.0,
) -> Difference | None:
    """Return where two runs of the same atoms first differ, or None if they are the same.

    Args:
        left: frames in order of rounds.
        right: frames to compare with.
        groups: what the atoms are called.
        tolerance: how far numbers may be apart [length, or length per unit of time]; 0 compares bits, −0.0 being 0.0.
    """
    for one, other in zip_longest(left, right):
        if one is None or other is None or one.round_index != other.round_index:
            return _missing_round(one, other)
        if one.digest == other.digest:
            continue
        difference = frame_difference(one, other, groups, tolerance)
        if difference is not None:
            return difference
    return None


def _missing_round(one: Frame | None, other: Frame | None) -> Difference:
    """Describe two sequences that do not record the same rounds."""
    if other is None or (one is not None and one.round_index < other.round_index):
        assert one is not None  # zip_longest ends with both
        return Difference(one.round_index, f"round {one.round_index} is only in the first")
    return Difference(other.round_index, f"round {other.round_index} is only in the second")


def frame_difference(
    one: Frame, other: Frame, groups: Sequence[GroupSpan], tolerance: float = 0.0
) -> Difference | None:
    """Return how two frames of the same round differ: which atom first, which most, and by how much."""
    for what, left, right in (("position", one.position, other.position), ("velocity", one.velocity, other.velocity)):
        apart = _apart(left, right)
        differing = np.flatnonzero(~(apart.max(axis=1) <= tolerance))
        if differing.size:
            worst = int(differing[np.argmax(apart.max(axis=1)[differing])])
            size = float(apart[worst].max())
            return Difference(
                one.round_index,
                f"round {one.round_index}: {what} of {differing.size} of {len(apart)} atoms differs, first "
                f"{atom_name(int(differing[0]), groups)}, most {atom_name(worst, groups)} by {size:.3g}",
            )
    differing_arrays = _differing_arrays(one.memory, other.memory, tolerance)
    if differing_arrays:
        names = ", ".join(f"`{name}`" for name in differing_arrays)
        return Difference(one.round_index, f"round {one.round_index}: what is remembered as {names} differs")
    return None


def _differing_arrays(one: Memory, other: Memory, tolerance: float) -> list[str]:
    """Return the names of the arrays that only one has, or that differ: real numbers by more than a tolerance."""
    names = dict.fromkeys((*one, *other))
    return [name for name in names if not _is_alike(one.get(name), other.get(name), tolerance)]


def _is_alike(one: NDArray[Any] | None, other: NDArray[Any] | None, tolerance: float) -> bool:
    if one is None or other is None or one.dtype != other.dtype or one.shape != other.shape:
        return False
    if one.dtype == np.float64:
        return bool(np.all(_apart(np.atleast_1d(one), np.atleast_1d(other)) <= tolerance))
    return np.array_equal(one, other)


def _apart(left: Floats, right: Floats) -> Floats:
    """Return the absolute differences; equal infinities and NaNs are no difference, the largest are infinite."""
    with np.errstate(invalid="ignore", over="ignore"):
        apart: Floats = np.abs(left - right)
    same = (left == right) | (np.isnan(left) & np.isnan(right))
    apart[same] = 0.0
    return apart
