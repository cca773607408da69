"""Plots of measures: which lines stand on which chart in which colour, and what happened above them."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from atomsim.arguments import function, instance, path, paths, whole_pair
from atomsim.compiler.colors import PALETTE, group_colors
from atomsim.compiler.gauges import gauge_of
from atomsim.core.model import Floats
from atomsim.drawing.chart import Chart, Line, Mark
from atomsim.drawing.files import check_picture
from atomsim.drawing.page import FORMATS
from atomsim.drawing.plot import plot_to
from atomsim.measures.events import Event, in_one_sentence
from atomsim.measures.series import Measured, measured
from atomsim.scene.language.measures import COMPONENTS, QUANTITIES, Measure
from atomsim.scene.language.selection import parse_selection
from atomsim.tasks.measure import events, frames_at, resolved, subject_of
from atomsim.tasks.recompute import laid_out_inside
from atomsim.tasks.render import Hear, title_of
from atomsim.trajectory import Trajectory

AXES = ("#b22222", "#2e8b57", "#4682b4")
"""Colours of the components x, y and z."""

PLAIN = "#3a3a44"
"""The colour of what is measured of no group."""

BRIGHTEST = 0.5
"""Lines are no brighter than this, or white paper would swallow them [relative luminance]."""

SMALLEST_ROOM = 4.0
"""Around a small scene there is at least so much room that counts as inside [length]."""

MOST_TIMES = 3
"""What happens more often is said only once."""

FEWEST_INSIDE = 0.05
"""If something is inside the scene for a smaller share of the rounds, all of them count."""


def plot(
    trajectories: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    picture: str | os.PathLike[str],
    measures: str | Sequence[str] | None = None,
    *,
    rounds: str | Sequence[int] | None = None,
    mark_events: bool = True,
    size: tuple[int, int] | None = None,
    notice: Hear | None = None,
) -> None:
    """Draw measures over rounds, a chart for each kind, with what happened above. A picture of that name is replaced.

    Scales show what is inside the scene: where a part falls out of it, its line leaves the chart.

    Args:
        trajectories: one trajectory, or several, whose lines share the charts.
        picture: the file to write; its extension tells the format: png, jpg, webp, pdf or svg.
        measures: such as `["height of ring", "gap between ring and floor"]`; by default height and speed of the first
            groups that move.
        rounds: the rounds to plot, as numbers or as a text such as `"0-2000"`; by default all that are recorded.
        mark_events: whether to say what happened to the groups that are measured.
        size: width and height [pixels].
        notice: hears what a user should know about where the frames come from.

    Raises:
        InputError: a trajectory, a measure, a round, a size or a name that will not do.
        RunError: the picture cannot be written.
    """
    out = path("picture", picture)
    check_picture(out, tuple(FORMATS))
    instance("mark_events", mark_events, bool, "True or False")
    function("notice", notice)
    wanted = None if size is None else whole_pair("size", size, "width and height in pixels, such as (1280, 720)")
    with ExitStack() as opened:
        found = [opened.enter_context(Trajectory(file)) for file in paths("trajectories", trajectories)]
        for message in (message for trajectory in found for message in trajectory.notices()):
            if notice is not None:
                notice(message)
        runs = [_Run.of(trajectory, measures, rounds, mark_events) for trajectory in found]
        title = title_of(found[0]) if len(found) == 1 else ""
    names = _names([trajectory.path for trajectory in found]) if len(found) > 1 else [""]
    marks = [mark for number, run in enumerate(runs) for mark in _marks(run, number if len(runs) > 1 else None)]
    plot_to(_charts(runs, names), sorted(marks, key=lambda mark: mark.round_index), title, out, wanted)


@dataclass(frozen=True, slots=True, eq=False)
class _Run:
    """What is plotted of one trajectory.

    Attributes:
        measured: the numbers.
        colors: `#rrggbb` by group.
        is_inside: by selection, whether its centroid is inside the scene in each frame; by nothing, whether all groups
            are.
        events: what happened to the groups that are measured.
    """

    measured: Measured
    colors: dict[str, str]
    is_inside: dict[tuple[str, ...], NDArray[np.bool_]]
    events: list[Event]

    @classmethod
    def of(
        cls,
        trajectory: Trajectory,
        measures: str | Sequence[str] | None,
        rounds: str | Sequence[int] | None,
        mark_events: bool,
    ) -> _Run:
        """Measure a trajectory, and the places of what is measured."""
        scene = laid_out_inside(trajectory.header, trajectory.path).scene
        subject = subject_of(trajectory, scene)
        asked, gauges = resolved(trajectory, measures)
        selections = {selection for measure in asked for selection in measure.selections}
        selections |= {(name,) for name in scene.groups}
        places = [Measure("centroid", selections=(selection,)) for selection in sorted(selections)]
        gauges += tuple(gauge_of(place, subject) for place in places)
        everything = measured(trajectory, (*asked, *places), gauges, frames_at(trajectory, rounds))
        start = trajectory[0].position
        inside = {place.selections[0]: _is_inside(everything[str(place)], start) for place in places}
        inside[()] = np.logical_and.reduce([inside[name,] for name in scene.groups])
        found = events(trajectory) if mark_events else []
        groups = {parse_selection(text).group for measure in asked for side in measure.selections for text in side}
        if not all(measure.selections for measure in asked):
            groups |= set(scene.groups)
        return cls(
            replace(everything, measures=asked, table=everything.table[:, : -3 * len(places)]),
            group_colors(scene),
            inside,
            [event for event in found if "all" in groups or groups & {parse_selection(n).group for n in event.names}],
        )

    def counts(self, measure: Measure) -> NDArray[np.bool_]:
        """Tell in which frames everything that is measured is inside the scene; in all, if hardly ever."""
        inside = np.logical_and.reduce([self.is_inside[selection] for selection in measure.selections or ((),)])
        return inside if inside.mean() >= FEWEST_INSIDE else np.ones_like(inside)


def _is_inside(places: Floats, start: Floats) -> NDArray[np.bool_]:
    """Tell where something is inside the scene, with half the longest side of its box at the start around it.

    Args:
        places: of it [length], (n_frames, 3).
        start: atom centres at the start [length], (n_atoms, 3).
    """
    low, high = start.min(axis=0), start.max(axis=0)
    room = max(float((high - low).max()) / 2, SMALLEST_ROOM)
    return np.asarray(((places >= low - room) & (places <= high + room)).all(axis=1))


def _charts(runs: Sequence[_Run], names: Sequence[str]) -> list[Chart]:
    """Gather the measures of one kind, of all runs, on one chart."""
    kinds: dict[str, list[Measure]] = {}
    for measure in runs[0].measured.measures:
        kinds.setdefault(_kind(measure), []).append(measure)
    return [_chart(kind, measures, runs, names) for kind, measures in kinds.items()]


def _kind(measure: Measure) -> str:
    """Return what measures on one chart have in common; a vector has a chart of its own."""
    if len(measure.columns) > 1:
        return str(measure)
    return str(Measure(measure.quantity, measure.component))


def _chart(kind: str, measures: list[Measure], runs: Sequence[_Run], names: Sequence[str]) -> Chart:
    columns = [(measure, column) for measure in measures for column in measure.columns]
    title = kind if len(columns) > 1 else columns[0][1]
    palette = _palette(measures, runs[0].colors)
    lines = []
    for (number, run), (index, (measure, column)) in product(enumerate(runs), enumerate(columns)):
        is_vector = len(measure.columns) > 1
        what = COMPONENTS[index] if is_vector else _of(measure)
        label = " ".join(part for part in (names[number], what if len(columns) > 1 else "") if part)
        own = AXES[index] if is_vector else palette[index]
        lines.append(
            Line(
                label=label,
                rounds=run.measured.round,
                values=run.measured[column],
                color=_on_white(own if len(runs) == 1 else PALETTE[number % len(PALETTE)]),
                counts=run.counts(measure),
                dash=0 if len(runs) == 1 else index,
            )
        )
    return Chart(title, QUANTITIES[measures[0].quantity].unit, tuple(lines))


def _palette(measures: Sequence[Measure], colors: dict[str, str]) -> list[str]:
    """Return a colour for each measure: that of the first group it names, if none before has it."""
    chosen: list[str] = []
    for measure in measures:
        groups = [parse_selection(text).group for side in measure.selections for text in side]
        wished = [PLAIN] if not groups else [colors[group] for group in groups if group in colors]
        chosen.append(next((color for color in (*wished, *PALETTE) if color not in chosen), PLAIN))
    return chosen


def _of(measure: Measure) -> str:
    """Return what a measure is of, in a few letters."""
    if measure.rule is not None:
        return measure.rule
    return " – ".join(", ".join(side) for side in measure.selections) or "all"


def _marks(run: _Run, number: int | None) -> list[Mark]:
    """Return what happened, in the colour of the run, or, where it is the only one, of the part that it happened to.

    What happens again and again is said once.
    """
    together: dict[tuple[int, tuple[str, ...]], list[Event]] = {}
    for event in run.events:
        together.setdefault((event.round_index, event.names), []).append(event)
    n_times = Counter(in_one_sentence(found) for found in together.values())
    said: set[str] = set()
    marks = []
    for (round_index, names), found in together.items():
        own = run.colors[parse_selection(names[0]).group] if number is None else PALETTE[number % len(PALETTE)]
        text = in_one_sentence(found)
        often = f"{text}, {n_times[text]} times" if n_times[text] > MOST_TIMES else text
        marks.append(Mark(round_index, "" if text in said and often != text else often, _on_white(own)))
        said.add(text)
    return marks


def _names(files: Sequence[Path]) -> list[str]:
    """Return short names of files, as long as needed to tell them apart."""
    stems = [file.stem for file in files]
    return stems if len(set(stems)) == len(stems) else [str(file) for file in files]


def _on_white(color: str) -> str:
    """Return a colour dark enough for a line on white.

    >>> _on_white("#4682b4"), _on_white("#ffff00")
    ('#4682b4', '#c1c100')
    """
    channels = [int(color[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    luminance = sum(share * channel**2.2 for share, channel in zip((0.2126, 0.7152, 0.0722), channels, strict=True))
    darker = min(1.0, (BRIGHTEST / luminance) ** (1 / 2.2)) if luminance else 1.0
    return "#" + "".join(f"{round(255 * darker * channel):02x}" for channel in channels)
