"""Measures of trajectories, as arrays and as files; knows no terminal."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable, Iterable, Sequence
from contextlib import nullcontext, suppress
from functools import cache
from pathlib import Path
from typing import TypeAlias

import numpy as np

from atomsim.compiler.gauges import MeasureError, Subject, gauge_of
from atomsim.compiler.selections import SelectionError
from atomsim.core.gauges.block import Gauge
from atomsim.core.model import Floats, Model
from atomsim.disk import behind, whole_file
from atomsim.errors import InputError, Notice
from atomsim.measures.series import Measured, columns_of, measured, rows
from atomsim.scene.language import Scene
from atomsim.scene.language.forces import Hold
from atomsim.scene.language.measures import Measure, MeasureSyntaxError, parse_measure
from atomsim.scene.language.selection import SelectionSyntaxError
from atomsim.tasks.recompute import compile_inside, laid_out_inside
from atomsim.trajectory import Trajectory

Hear: TypeAlias = Callable[[Notice], None]

LEADING = ("round", "time")
"""The columns before those of the measures."""

MOST_GROUPS = 4
"""Of so many groups height and speed are measured where nobody says what to measure."""


def measure(
    trajectory: str | os.PathLike[str] | Trajectory,
    measures: str | Sequence[str] | None = None,
    *,
    rounds: Sequence[int] | None = None,
) -> Measured:
    """Measure the frames of a run.

    Args:
        trajectory: a file, or one that is open.
        measures: such as `height of ring` or `["gap between ring and floor", "energy"]`; by default the height and
            the speed of the first groups that move.
        rounds: which rounds; the frames recorded nearest to them are taken. By default all frames.

    Returns:
        The rounds, the times, and an array for every measure.

    Raises:
        InputError: no trajectory, no measure, or one that makes no sense for these atoms.
    """
    opened = nullcontext(trajectory) if isinstance(trajectory, Trajectory) else Trajectory(trajectory)
    with opened as run:
        return measured(run, *resolved(run, measures), frames_at(run, rounds))


def write_measures(
    trajectory: Trajectory,
    measures: Sequence[str] | None,
    path: Path,
    rounds: Sequence[int] | None = None,
    report: Callable[[int, int], object] | None = None,
) -> int:
    """Measure frames into a CSV file, row by row; every number is written so that reading it gives it back.

    Args:
        trajectory: the run.
        measures: as of `measure`.
        path: the file.
        rounds: as of `measure`.
        report: hears how many frames of how many are measured.

    Returns:
        The number of rows.

    Raises:
        InputError: as of `measure`.
        RunError: the file cannot be written.
    """
    asked, gauges = resolved(trajectory, measures)
    frames = frames_at(trajectory, rounds)
    n_rows, n_frames = 0, len(trajectory if frames is None else frames)
    with whole_file(path) as file:
        file.write(_lines([[*LEADING, *columns_of(asked)]]))
        for part in rows(trajectory, gauges, frames):
            columns = (column.tolist() for column in part)
            file.write(_lines([round_index, time, *values] for round_index, time, values in zip(*columns, strict=True)))
            n_rows += len(part.round)
            if report is not None:
                report(n_rows, n_frames)
    return n_rows


def _lines(cells: Iterable[Iterable[object]]) -> bytes:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(cells)
    return text.getvalue().encode()


def is_our_table(path: Path) -> bool:
    """Tell whether a file is a table of measures that atomsim wrote: its first line says so."""
    with suppress(OSError, ValueError), path.open(encoding="utf-8", newline="") as file:
        names = next(csv.reader([file.readline(1 << 20)]), [])
        return tuple(names[:2]) == LEADING and all(map(_is_column, names[2:]))
    return False


def _is_column(name: str) -> bool:
    try:
        return parse_measure(name).columns == (name,)
    except (MeasureSyntaxError, SelectionSyntaxError):
        return False


def check_table(path: Path) -> None:
    """Refuse a name that cannot become a table, before any work is done for it.

    Raises:
        InputError: another extension, a folder, or a folder that does not exist.
    """
    if path.suffix.lower() != ".csv":
        raise InputError(f"{path}: a table of measures is written as .csv")
    if path.is_dir():
        raise InputError(f"{path}: this is a folder; give the name of a file")
    folder = behind(path).parent
    if not folder.is_dir():
        raise InputError(f"{path}: the folder {folder} does not exist")


def resolved(
    trajectory: Trajectory, measures: str | Sequence[str] | None
) -> tuple[tuple[Measure, ...], tuple[Gauge, ...]]:
    """Read measures, or choose some, and make gauges of them.

    Raises:
        InputError: a text that is no measure, or a measure that makes no sense for these atoms.
    """
    scene = laid_out_inside(trajectory.header, trajectory.path).scene
    subject = subject_of(trajectory, scene)
    if measures is None:
        asked = default_measures(scene, subject)
    else:
        asked = tuple(map(read_measure, [measures] if isinstance(measures, str) else measures))
    if not asked:
        raise InputError("name a measure, such as `energy`")
    return asked, tuple(_gauge(one, subject) for one in asked)


def read_measure(text: str) -> Measure:
    """Read a measure.

    Raises:
        InputError: the text is none.
    """
    try:
        return parse_measure(text)
    except MeasureSyntaxError as error:
        raise InputError(str(error)) from None
    except SelectionSyntaxError as error:
        raise InputError(f"{text}: {error}") from None


def subject_of(trajectory: Trajectory, scene: Scene) -> Subject:
    """Return what measures of a run are taken of; its scene is compiled when bonds or collisions are asked for."""

    @cache
    def start() -> Floats:
        return trajectory[0].position

    @cache
    def model() -> Model:
        return compile_inside(trajectory.header, trajectory.path)[1]

    return Subject.of(scene, start, model)


def default_measures(scene: Scene, subject: Subject) -> tuple[Measure, ...]:
    """Choose height and speed of the first groups that are not held; of the whole, if all are."""
    held = [subject.selections.atoms(force.acts_on) for force in scene.forces.values() if isinstance(force, Hold)]
    is_free = np.ones(subject.n_atoms, dtype=bool)
    for atoms in held:
        is_free[atoms] = False
    moving = [name for name in scene.groups if is_free[subject.selections.atoms((name,))].any()]
    return tuple(
        Measure(quantity, selections=((name,),))
        for name in moving[:MOST_GROUPS] or ["all"]
        for quantity in ("height", "speed")
    )


def frames_at(trajectory: Trajectory, rounds: Sequence[int] | None) -> list[int] | None:
    """Return which frames were recorded nearest to some rounds, ascending; None for all.

    Raises:
        InputError: no rounds, or one that the run did not reach.
    """
    if rounds is None:
        return None
    recorded = trajectory.rounds
    beyond = [round_index for round_index in rounds if not 0 <= round_index <= recorded[-1]]
    if beyond:
        raise InputError(f"{trajectory.path}: there is no round {beyond[0]}; it ends at round {recorded[-1]}")
    if not len(rounds):
        raise InputError("name a round to measure, or leave `rounds` out for all frames")
    return sorted({int(abs(recorded - round_index).argmin()) for round_index in rounds})


def _gauge(asked: Measure, subject: Subject) -> Gauge:
    try:
        return gauge_of(asked, subject)
    except (MeasureError, SelectionError) as error:
        raise InputError(f"{asked}: {error}") from None
