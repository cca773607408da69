"""Robustness of expectations: how far a run is from failing them, or from meeting them, and in which round.

The definition is that of signal temporal logic (A. Donzé, O. Maler, Robust satisfaction of temporal logic over
real-valued signals, FORMATS 2010): a bound is worth the distance to it, `all` and `always` the least of what they hold,
`any` and `eventually` the most, `not` the opposite. Above zero an expectation is met, below zero it is not.
Rounds that a run did not reach, because it was stopped, could be anything; so there are two numbers, the worst and the
best that could still come (J. V. Deshmukh et al., Robust online monitoring of signal temporal logic, FMSD 51, 2017).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from atomsim.core.model import Floats, Indices
from atomsim.scene.language.expectations import END, Expectation


class Verdict(NamedTuple):
    """What became of an expectation.

    Attributes:
        worst: the least robustness that it can have, whatever had come after the last frame.
        best: the most.
        round_index: the recorded round that decides it: where it is nearest to failing, or fails most.
        claim: the statement about a measure that decides it, as it stands in the expectation.
        value: what that measure is in that round.
    """

    worst: float
    best: float
    round_index: int
    claim: Expectation
    value: float

    @property
    def is_met(self) -> bool:
        """Whether it holds, whatever had come."""
        return self.worst > 0.0

    @property
    def is_open(self) -> bool:
        """Whether the run ended before it could be told."""
        return self.worst <= 0.0 < self.best

    @property
    def margin(self) -> float:
        """How far from failing, in the units of the measure that decides; below zero, how far from holding."""
        return self.best if self.best <= 0.0 else self.worst


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """The frames of a run as expectations see them.

    Attributes:
        round: of each frame, ascending, (n_frames,) int64.
        rounds: the round that the run was to reach.
        measures: each measure by its text, (n_frames,) float64.
    """

    round: Indices
    rounds: int
    measures: Mapping[str, Floats]


class Bounds(NamedTuple):
    """The least and the most robustness in some frames, (n,) float64 each."""

    worst: Floats
    best: Floats

    def map(self, change: Callable[[Floats], Floats]) -> Bounds:
        """Change both alike."""
        return Bounds(change(self.worst), change(self.best))


def judge(expectation: Expectation, trace: Trace) -> Verdict:
    """Return the robustness of an expectation in round 0.

    Args:
        expectation: what should happen.
        trace: what happened; it has every measure that the expectation speaks of.
    """
    start = np.zeros(1, dtype=np.int64)
    worst, best = _robustness(expectation, trace, start)
    frame, claim = _decisive(expectation, trace, 0)
    assert claim.measure is not None  # every expectation ends in measures
    value = float(trace.measures[claim.measure][frame])
    return Verdict(float(worst[0]), float(best[0]), int(trace.round[frame]), claim, value)


def _horizon(expectation: Expectation) -> int:
    """Return how many rounds ahead of the one where it is asked an expectation looks; `end` looks to no fixed one."""
    ahead = max((_horizon(part) for part in expectation.parts.values()), default=0)
    window = expectation.always or expectation.eventually
    if expectation.at is not None:
        return expectation.at + ahead
    return ahead + (window[1] if window is not None and isinstance(window[1], int) else 0)


def _robustness(expectation: Expectation, trace: Trace, frames: Indices) -> Bounds:
    """Return the robustness of an expectation at some frames."""
    if expectation.at is not None:
        return _held_at(expectation.at, expectation, trace, frames)
    if expectation.until is not None:
        return _until(expectation, trace, frames)
    window = expectation.always or expectation.eventually
    if window is None:
        return _claim(expectation, trace, frames)
    start, stop, is_cut = _window(window, expectation, trace, frames)
    inside = _claim(expectation, trace, np.arange(len(trace.round)))
    fold = np.minimum if expectation.always is not None else np.maximum
    worst, best = inside.map(lambda values: _folded(values, start, stop, fold))
    if expectation.always is not None:
        return Bounds(np.where(is_cut, -np.inf, worst), best)
    return Bounds(worst, np.where(is_cut, np.inf, best))


def _claim(expectation: Expectation, trace: Trace, frames: Indices) -> Bounds:
    """Return the robustness of what is claimed, without when."""
    if expectation.measure is not None:
        value = _distance(expectation, trace.measures[expectation.measure][frames])
        return Bounds(value, value)
    if expectation.not_ is not None:
        worst, best = _robustness(expectation.not_, trace, frames)
        return Bounds(-best, -worst)
    if expectation.that is not None:
        return _robustness(expectation.that, trace, frames)
    fold = np.minimum if expectation.all_ is not None else np.maximum
    parts = [_robustness(part, trace, frames) for part in _choices(expectation)]
    return Bounds(*(fold.reduce(side) for side in zip(*parts, strict=True)))


def _choices(expectation: Expectation) -> tuple[Expectation, ...]:
    return expectation.all_ or expectation.any_ or ()


def _distance(expectation: Expectation, value: Floats) -> Floats:
    """Return how far a measure is on the right side of its bounds; what is no number is on no side."""
    if expectation.above is not None:
        distance = value - expectation.above
    elif expectation.below is not None:
        distance = expectation.below - value
    else:
        assert expectation.between is not None  # one of the three, by the language
        low, high = expectation.between
        distance = np.minimum(value - low, high - value)
    return np.where(np.isnan(value), -np.inf, distance)


def _window(
    window: tuple[int, int | str], expectation: Expectation, trace: Trace, frames: Indices
) -> tuple[Indices, Indices, Floats]:
    """Return the first frame of a window, the one after its last, and whether the run ended inside, for each frame."""
    first, last = window
    beyond = trace.rounds - max((_horizon(part) for part in expectation.parts.values()), default=0)
    begin = trace.round[frames] + first
    end = np.full_like(begin, beyond) if last == END else trace.round[frames] + int(last)
    start = np.searchsorted(trace.round, begin, side="left")
    stop = np.searchsorted(trace.round, end, side="right")
    return start, np.maximum(start, stop), (end > trace.round[-1]) & (begin <= end)


def _held_at(ahead: int, expectation: Expectation, trace: Trace, frames: Indices) -> Bounds:
    """Return the robustness so many rounds later, in the frame recorded nearest to that, the earlier of two."""
    wanted = trace.round[frames] + ahead
    nearest = np.array([np.abs(trace.round - round_index).argmin() for round_index in wanted])
    worst, best = _claim(expectation, trace, nearest)
    is_cut = wanted > trace.round[-1]
    return Bounds(np.where(is_cut, -np.inf, worst), np.where(is_cut, np.inf, best))


def _folded(values: Floats, start: Indices, stop: Indices, fold: np.ufunc) -> Floats:
    """Return the least (or most) of values[start:stop] for many spans at once; of none, what changes nothing.

    Spans are covered by two overlapping ones whose lengths are powers of two, of which all have been folded.
    """
    empty = np.inf if fold is np.minimum else -np.inf
    folded = np.full(len(start), empty)
    length = stop - start
    width, level = 1, values
    while True:
        fits = (length >= width) & (length < 2 * width)
        folded[fits] = fold(level[start[fits]], level[stop[fits] - width])
        if 2 * width > len(values):
            return folded
        level = fold(level[:-width], level[width:])
        width *= 2


def _until(expectation: Expectation, trace: Trace, frames: Indices) -> Bounds:
    """Return the most, over rounds t, of the lesser of `until` in t and what is claimed in every round before t."""
    assert expectation.until is not None
    every = np.arange(len(trace.round))
    claimed, released = _claim(expectation, trace, every), _robustness(expectation.until, trace, every)
    is_cut = trace.round[-1] < trace.rounds
    worst, best = (
        np.array([_released(before[frame:], after[frame:]).max() for frame in frames])
        for before, after in zip(claimed, released, strict=True)
    )
    still = np.array([claimed.best[frame:].min() for frame in frames])
    return Bounds(worst, np.maximum(best, still) if is_cut else best)


def _released(before: Floats, after: Floats) -> Floats:
    """Return, for each round, how well it would do as the one in which `until` ends the waiting."""
    so_far = np.minimum.accumulate(np.concatenate(([np.inf], before[:-1])))
    return np.minimum(so_far, after)


def _decisive(expectation: Expectation, trace: Trace, frame: int) -> tuple[int, Expectation]:
    """Return the frame, and the statement about a measure, that the robustness of an expectation in a frame is of."""
    if expectation.at is not None:
        return _decisive_claim(
            expectation, trace, int(np.abs(trace.round - trace.round[frame] - expectation.at).argmin())
        )
    every = np.arange(len(trace.round))
    if expectation.until is not None:
        claimed = _claim(expectation, trace, every).best[frame:]
        released = _robustness(expectation.until, trace, every).best[frame:]
        chosen = int(_released(claimed, released).argmax())
        if chosen and claimed[:chosen].min() < released[chosen]:
            return _decisive_claim(expectation, trace, frame + int(claimed[:chosen].argmin()))
        return _decisive(expectation.until, trace, frame + chosen)
    window = expectation.always or expectation.eventually
    if window is None:
        return _decisive_claim(expectation, trace, frame)
    start, stop, _ = _window(window, expectation, trace, np.array([frame]))
    inside = every[start[0] : stop[0]]
    if not inside.size:
        return _decisive_claim(expectation, trace, frame)
    worst = _claim(expectation, trace, inside).worst
    return _decisive_claim(expectation, trace, int(inside[_extreme(worst, is_least=expectation.always is not None)]))


def _decisive_claim(expectation: Expectation, trace: Trace, frame: int) -> tuple[int, Expectation]:
    """Return the same for what is claimed in a frame."""
    if expectation.measure is not None:
        return frame, expectation
    single = expectation.not_ or expectation.that
    if single is not None:
        return _decisive(single, trace, frame)
    parts = _choices(expectation)
    worst = [_robustness(part, trace, np.array([frame])).worst[0] for part in parts]
    return _decisive(parts[_extreme(np.array(worst), is_least=expectation.all_ is not None)], trace, frame)


def _extreme(values: Floats, *, is_least: bool) -> int:
    return int(values.argmin() if is_least else values.argmax())
