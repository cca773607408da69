"""Measures of trajectories, and the events in them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cache

import numpy as np

from atomsim import arguments
from atomsim.compiler.gauges import MeasureError, Subject, gauge_of
from atomsim.compiler.selections import SelectionError
from atomsim.core.gauges.block import Gauge
from atomsim.core.model import Floats, Model
from atomsim.errors import InputError
from atomsim.measures.events import Event
from atomsim.measures.find import find_events
from atomsim.measures.parts import pairs_of, parts_of
from atomsim.measures.series import Measured, measured
from atomsim.scene.language import Scene
from atomsim.scene.language.forces import Hold
from atomsim.scene.language.measures import COMPONENTS, Measure, MeasureSyntaxError, parse_measure
from atomsim.scene.language.selection import SelectionSyntaxError
from atomsim.tasks.recompute import compile_inside, laid_out_inside
from atomsim.tasks.rounds import chosen, wishes
from atomsim.trajectory import Trajectory

MEASURES = "measures, such as `height of ring`, at least one"

MOST_GROUPS = 4
"""Of so many groups height and speed are measured where nobody says what to measure."""


class UnfitMeasureError(InputError):
    """A measure that makes no sense for the atoms that it is taken of."""


def measure(
    trajectory: str | os.PathLike[str] | Trajectory,
    measures: str | Sequence[str] | None = None,
    *,
    rounds: str | Sequence[int] | None = None,
) -> Measured:
    """Measure the frames of a run.

    Args:
        trajectory: a file, or one that is open.
        measures: such as `height of ring` or `["gap between ring and floor", "energy"]`; by default the height and
            the speed of the first groups that move.
        rounds: which rounds, as numbers or as a text such as `"0-2000:100"`; the frames recorded nearest to them are
            taken. By default all frames.

    Returns:
        The rounds, the times, and an array for every measure.

    Raises:
        InputError: no trajectory, no measure, or one that makes no sense for these atoms.
    """
    with _opened(trajectory) as run:
        return measured(run, *resolved(run, measures), frames_at(run, rounds))


def events(trajectory: str | os.PathLike[str] | Trajectory) -> list[Event]:
    """Find out what happened in a run: contacts, bounces, falls and the like.

    Args:
        trajectory: a file, or one that is open.

    Returns:
        The events in the order of their rounds; `str` says each in words.

    Raises:
        InputError: no trajectory.
    """
    with _opened(trajectory) as run:
        scene = laid_out_inside(run.header, run.path).scene
        parts = parts_of(scene, run.header.bond)
        return find_events(run, parts, pairs_of(scene, parts), COMPONENTS.index(scene.render.camera.up))


def _opened(trajectory: str | os.PathLike[str] | Trajectory) -> AbstractContextManager[Trajectory]:
    """Open a file for as long as it is needed; what is open already stays open."""
    return nullcontext(trajectory) if isinstance(trajectory, Trajectory) else Trajectory(trajectory)


def resolved(
    trajectory: Trajectory, measures: str | Sequence[str] | None
) -> tuple[tuple[Measure, ...], tuple[Gauge, ...]]:
    """Read measures, or choose some, and make gauges of them.

    Raises:
        InputError: a text that is no measure, or a measure that makes no sense for these atoms.
    """
    scene = laid_out_inside(trajectory.header, trajectory.path).scene
    subject = subject_of(trajectory, scene)
    asked = default_measures(scene, subject) if measures is None else tuple(map(read_measure, texts_of(measures)))
    try:
        return asked, tuple(gauge(one, subject) for one in asked)
    except UnfitMeasureError as error:
        raise InputError(f"{trajectory.path}: {error}") from None


def texts_of(measures: str | Sequence[str]) -> list[str]:
    """Return measures that are one text or several as a list.

    Raises:
        InputError: they are neither.
    """
    return [measures] if isinstance(measures, str) else arguments.sequence("measures", measures, MEASURES)


def read_measure(text: str) -> Measure:
    """Read a measure.

    Raises:
        InputError: the text is none.
    """
    try:
        return parse_measure(arguments.instance("measures", text, str, MEASURES))
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


def frames_at(trajectory: Trajectory, rounds: str | Sequence[int] | None) -> list[int] | None:
    """Return which frames were recorded nearest to some rounds, ascending; None for all.

    Raises:
        InputError: no rounds, or one that the run did not reach.
    """
    if rounds is None:
        return None
    asked = wishes(rounds)
    try:
        places = chosen(asked, trajectory.rounds)[1]
    except InputError as error:
        raise InputError(f"{trajectory.path}: {error}") from None
    return sorted(set(places.tolist()))


def gauge(asked: Measure, subject: Subject) -> Gauge:
    """Make a gauge of a measure.

    Raises:
        UnfitMeasureError: it makes no sense for these atoms.
    """
    try:
        return gauge_of(asked, subject)
    except (MeasureError, SelectionError) as error:
        raise UnfitMeasureError(f"{asked}: {error}") from None
