"""What a plot shows as records: charts of lines, and marks through all of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats, Indices


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A series.

    Attributes:
        label: what stands beside it; nothing if empty.
        rounds: the round of each value, ascending, at least one, (n,) int64.
        values: (n,) float64; what is not finite is left out.
        color: `#rrggbb`.
        counts: which values the scale of the chart must show, (n,) bool.
        dash: which of several ways to draw it.
    """

    label: str
    rounds: Indices
    values: Floats
    color: str
    counts: NDArray[np.bool_]
    dash: int = 0


@dataclass(frozen=True, slots=True)
class Chart:
    """Lines on one scale.

    Attributes:
        title: what they show.
        unit: of the values; nothing if empty.
        lines: at least one.
    """

    title: str
    unit: str
    lines: tuple[Line, ...]


@dataclass(frozen=True, slots=True)
class Mark:
    """Something that happened, marked through all charts.

    Attributes:
        round_index: when.
        text: what; nothing if empty.
        color: `#rrggbb`.
    """

    round_index: int
    text: str
    color: str
