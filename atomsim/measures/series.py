"""Measures over frames, as rows that stream by or as arrays that are kept."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

from atomsim.core.gauges.block import Block, Gauge, frames_at_a_time
from atomsim.core.gauges.meter import Meter
from atomsim.core.gauges.recorded import Recorded
from atomsim.core.model import Floats, Indices
from atomsim.scene.language.measures import Measure, MeasureSyntaxError, parse_measure
from atomsim.scene.language.selection import SelectionSyntaxError
from atomsim.trajectory import Trajectory

Key = TypeVar("Key")


class Rows(NamedTuple):
    """Some frames measured.

    Attributes:
        round: of each frame, (n_frames,) int64.
        time: round · τ, (n_frames,) float64.
        values: what was measured, (n_frames, n_columns) float64.
    """

    round: Indices
    time: Floats
    values: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Measured(Mapping[str, Floats]):
    """Measures of a run, by their text: (n_frames,) each, or (n_frames, 3) of a vector.

    Attributes:
        round: of each frame, (n_frames,) int64.
        time: round · τ, (n_frames,) float64.
        measures: what was measured, in order.
        table: the numbers of all of them side by side, (n_frames, n_columns) float64.
    """

    round: Indices
    time: Floats
    measures: tuple[Measure, ...]
    table: Floats

    @property
    def columns(self) -> tuple[str, ...]:
        """What each column of `table` is: a measure that is one number, or a component of a vector."""
        return columns_of(self.measures)

    def __getitem__(self, text: str) -> Floats:
        """Return a measure, or a component of one, however it is spelled.

        Raises:
            KeyError: it was not measured.
        """
        try:
            names = parse_measure(text).columns
            places = [self.columns.index(name) for name in names]
        except (MeasureSyntaxError, SelectionSyntaxError, ValueError):
            raise KeyError(text) from None
        return self.table[:, places[0]] if len(places) == 1 else self.table[:, places]

    def __iter__(self) -> Iterator[str]:
        return map(str, self.measures)

    def __len__(self) -> int:
        return len(self.measures)


def columns_of(measures: Iterable[Measure]) -> tuple[str, ...]:
    """Return the names of the columns that measures give together."""
    return tuple(name for measure in measures for name in measure.columns)


def rows(trajectory: Trajectory, gauges: Sequence[Gauge], frames: Sequence[int] | None = None) -> Iterator[Rows]:
    """Measure frame after frame, a block at a time, so that memory does not grow with their number.

    Args:
        trajectory: the run.
        gauges: what to measure.
        frames: which frames, ascending; all of them by default.
    """
    chosen = np.arange(len(trajectory)) if frames is None else np.array(frames, dtype=np.int64)
    meter, rounds, time = Meter(gauges), trajectory.rounds, trajectory.time
    start = 0
    # Turns that are counted are counted from the first frame on, whichever of them are asked for.
    looked_at = np.arange(len(trajectory)) if meter.is_running else chosen
    for block in _blocks(trajectory, gauges, looked_at):
        values = meter.take(block)
        index = looked_at[start : start + block.n_frames]
        start += block.n_frames
        is_asked = np.isin(index, chosen, assume_unique=True)
        if is_asked.any():
            asked = index[is_asked]
            yield Rows(rounds[asked], time[asked], values[is_asked])


def measured(
    trajectory: Trajectory, measures: Sequence[Measure], gauges: Sequence[Gauge], frames: Sequence[int] | None = None
) -> Measured:
    """Measure frames and keep the numbers; see `rows`."""
    parts = list(rows(trajectory, gauges, frames))
    joined = Rows(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    return Measured(joined.round, joined.time, tuple(measures), joined.values)


def _blocks(trajectory: Trajectory, gauges: Sequence[Gauge], frames: Indices) -> Iterator[Block]:
    """Return blocks of frames; what was observed when they were computed is known without reading them."""
    observables = {name: series[frames] for name, series in trajectory.observables.items()}
    if all(isinstance(gauge, Recorded) for gauge in gauges):
        nothing = np.empty((3, 0, len(frames)))
        return iter([Block(nothing, nothing, observables)])
    return _read_ahead(_read(trajectory, frames, observables))


def _read(trajectory: Trajectory, frames: Indices, observables: Mapping[str, Floats]) -> Iterator[Block]:
    """Yield blocks; of two, the older is overwritten by the third, as memory that is asked for again costs time."""
    n_atoms = trajectory.header.n_atoms
    step = frames_at_a_time(n_atoms)
    buffers = np.empty((2, 2, 3, n_atoms, min(step, len(frames))))
    for number, start in enumerate(range(0, len(frames), step)):
        cut = slice(start, start + step)
        chosen = frames[cut].tolist()
        position, velocity = buffers[number % 2] if len(chosen) == step else np.empty((2, 3, n_atoms, len(chosen)))
        for place, frame in enumerate(chosen):
            state = trajectory.state(frame)
            position[:, :, place], velocity[:, :, place] = state.position.T, state.velocity.T
        yield Block(position, velocity, {name: series[cut] for name, series in observables.items()})


def _read_ahead(coming: Iterator[Block]) -> Iterator[Block]:
    """Yield blocks, each while the next is read: taking digests, which takes longest, leaves the interpreter free."""
    from concurrent.futures import ThreadPoolExecutor  # only what reads frames needs it

    with ThreadPoolExecutor(1) as reader:
        following = reader.submit(next, coming, None)
        while (block := following.result()) is not None:
            following = reader.submit(next, coming, None)
            yield block


def series_of(trajectory: Trajectory, gauges: Mapping[Key, Gauge]) -> dict[Key, Floats]:
    """Measure all frames in one pass and return a series for each gauge, (n_frames, its n_columns)."""
    table = np.concatenate([part.values for part in rows(trajectory, list(gauges.values()))])
    ends = np.cumsum([gauge.n_columns for gauge in gauges.values()])
    return dict(zip(gauges, np.split(table, ends[:-1], axis=1), strict=True))
