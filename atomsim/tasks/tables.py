"""Measures and events as CSV files, which are written whole and told from those of others."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from atomsim.disk import behind, whole_file
from atomsim.errors import InputError
from atomsim.measures.events import Event
from atomsim.measures.series import columns_of, rows
from atomsim.scene.language.measures import MeasureSyntaxError, parse_measure
from atomsim.scene.language.selection import SelectionSyntaxError
from atomsim.tasks.measure import frames_at, resolved
from atomsim.trajectory import Trajectory

LEADING = ("round", "time")
"""The columns before those of the measures."""

OF_EVENTS = (*LEADING, "event", "first", "second")
"""The columns of a table of events: of which groups, which may be one."""


def write_measures(
    trajectory: Trajectory,
    measures: Sequence[str] | None,
    path: Path,
    rounds: str | Sequence[int] | None = None,
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


def write_events(found: Sequence[Event], time_step: float, path: Path) -> None:
    """Write events into a CSV file.

    Raises:
        RunError: the file cannot be written.
    """
    lines: list[Iterable[object]] = [OF_EVENTS]
    for event in found:
        first, second = (*event.names, "")[:2]
        lines.append((event.round_index, event.round_index * time_step, event.kind, first, second))
    with whole_file(path) as file:
        file.write(_lines(lines))


def _lines(cells: Iterable[Iterable[object]]) -> bytes:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(cells)
    return text.getvalue().encode()


def is_our_table(path: Path) -> bool:
    """Tell whether a file is a table that atomsim wrote: its first line says so."""
    with suppress(OSError, ValueError), path.open(encoding="utf-8", newline="") as file:
        names = next(csv.reader([file.readline(1 << 20)]), [])
        is_of_measures = tuple(names[:2]) == LEADING and all(map(_is_column, names[2:]))
        return is_of_measures or tuple(names) == OF_EVENTS
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
        raise InputError(f"{path}: a table is written as .csv")
    if path.is_dir():
        raise InputError(f"{path}: this is a folder; give the name of a file")
    folder = behind(path).parent
    if not folder.is_dir():
        raise InputError(f"{path}: the folder {folder} does not exist")
