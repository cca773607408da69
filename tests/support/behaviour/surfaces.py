"""The rim of a surface and what lies below it; knows no scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats


def is_rim(start: Floats, up: int) -> NDArray[np.bool_]:
    """Return which atoms of a rectangular surface are on one of its four rims; `up` is the axis it does not span."""
    spanned = np.delete(start, up, axis=1)
    return ((spanned == spanned.min(axis=0)) | (spanned == spanned.max(axis=0))).any(axis=1)


def depth_below_rim(start: Floats, surface: Floats, up: int) -> Floats:
    """Return how far every atom of a surface lies below the plane that fits its rims best, (n,).

    Args:
        start: where the atoms were in the flat surface, (n, 3).
        surface: where they are, (n, 3).
        up: the axis of height.
    """
    *gradient, level = best_plane(surface[is_rim(start, up)], up)
    return np.delete(surface, up, axis=1) @ gradient + level - surface[:, up]


def best_plane(atoms: Floats, up: int) -> Floats:
    """Return the plane that fits atoms best: its two slopes, along the axes besides `up`, and its height at zero."""
    design = np.column_stack([np.delete(atoms, up, axis=1), np.ones(len(atoms))])
    return np.linalg.lstsq(design, atoms[:, up], rcond=None)[0]
