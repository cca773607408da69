"""Where things go on a plot: scales, ticks, labels that do not overlap, lines of events; draws nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from atomsim.core.model import Floats, Indices

MARGIN = 0.06
"""Room above and below lines, as a share of their range."""

MOST_POINTS = 4000
"""A line with more values is thinned: nobody sees so many, and a drawing of lines would be as large as the run."""

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


def limits(values: Sequence[Floats]) -> tuple[float, float]:
    """Return the least and the largest value that a scale shows, with some room.

    >>> limits([np.array([0.0, 10.0]), np.array([np.nan, 5.0])])
    (-0.6, 10.6)
    """
    finite = np.concatenate([series[np.isfinite(series)] for series in values])
    if not finite.size:
        return -1.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    if not math.isfinite(high - low):
        return low, high
    level = max(abs(low), abs(high))
    if high - low <= 1e-9 * level or high == low:  # as good as constant: rounding is nothing to look at
        return low - max(0.1 * level, 0.5), high + max(0.1 * level, 0.5)
    room = MARGIN * (high - low)
    return low - room, high + room


def ticks(low: float, high: float, most: int, least_step: float = 0.0) -> list[float]:
    """Return round numbers between two, about so many at most, some steps apart.

    >>> ticks(-0.6, 10.6, 5), ticks(0.0, 3.0, 9, least_step=1.0)
    ([0.0, 2.5, 5.0, 7.5, 10.0], [0.0, 1.0, 2.0, 3.0])
    """
    span = high - low
    if not (math.isfinite(span) and span > 0.0):
        return []
    magnitude = 10.0 ** math.floor(math.log10(span / most))
    step = max(least_step, next(step * magnitude for step in _STEPS if span / (step * magnitude) <= most))
    first = math.ceil(low / step)
    numbers = [step * number for number in range(first, first + most + 2)]
    return [float(f"{number:.12g}") for number in numbers if low <= number <= high]


def number(value: float) -> str:
    """Write the number of a tick.

    >>> number(-2.5), number(1e7)
    ('−2.5', '1e+07')
    """
    return f"{value:.6g}".replace("-", "−") if abs(value) < 1e6 else f"{value:.3g}".replace("-", "−")


def thinned(rounds: Indices, values: Floats) -> tuple[Indices, Floats]:
    """Return a line of fewer points that looks the same: of each stretch its least and its largest value."""
    if values.size <= MOST_POINTS:
        return rounds, values
    n_stretches = MOST_POINTS // 2
    edges = np.linspace(0, values.size, n_stretches + 1).astype(np.int64)
    places = {0, values.size - 1}
    for start, stop in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        part = values[start:stop]
        is_finite = np.isfinite(part)
        if not is_finite.all():
            places.add(start + int(is_finite.argmin()))  # so that a gap in the line stays one
        if is_finite.any():
            places.add(start + int(np.where(is_finite, part, np.inf).argmin()))
            places.add(start + int(np.where(is_finite, part, -np.inf).argmax()))
    chosen = sorted(places)
    return rounds[chosen], values[chosen]


def apart(wished: Sequence[float], distance: float, low: float, high: float) -> list[float]:
    """Return places near those wished for, in their order, that are some distance apart and within two bounds.

    >>> apart([5.0, 5.5, 20.0], 2.0, 0.0, 10.0)
    [5.0, 7.0, 10.0]
    """
    order = sorted(range(len(wished)), key=lambda index: wished[index])
    found = [0.0] * len(wished)
    floor = low
    for index in order:
        found[index] = max(min(wished[index], high), floor)
        floor = found[index] + distance
    ceiling = high
    for index in reversed(order):
        found[index] = min(found[index], ceiling)
        ceiling = found[index] - distance
    return found


class Lanes:
    """Lines of short texts, each at its place along a line, that do not overlap.

    Args:
        right: no text goes further.
        gap: between texts.
        most: how many lines there are at most.
    """

    def __init__(self, right: float, gap: float, most: int) -> None:
        self._right, self._gap, self._most = right, gap, most
        self._taken: list[list[tuple[float, float]]] = []

    def __len__(self) -> int:
        return len(self._taken)

    def place(self, at: float, width: float) -> tuple[int, float] | None:
        """Find room for a text that begins beside a place, or ends there where it would go too far.

        Returns:
            The line, 0 for the first, and where the text begins; None where all lines are full.
        """
        begin = at + self._gap / 2 if at + self._gap / 2 + width <= self._right else at - self._gap / 2 - width
        for number, taken in enumerate(self._taken):
            if all(begin > stop + self._gap or begin + width + self._gap < start for start, stop in taken):
                taken.append((begin, begin + width))
                return number, begin
        if len(self._taken) == self._most:
            return None
        self._taken.append([(begin, begin + width)])
        return len(self._taken) - 1, begin
