"""Expectations that make no sense for the scene they stand in: about atoms that it does not have, or about no time."""

from __future__ import annotations

from collections.abc import Iterator

from atomsim.compiler.checks import Complaint
from atomsim.compiler.gauges import MeasureError, Subject, gauge_of
from atomsim.compiler.selections import SelectionError
from atomsim.core.model import Model, State
from atomsim.scene.language import Expectation, Scene
from atomsim.scene.language.expectations import WHENS
from atomsim.scene.language.measures import parse_measure
from atomsim.scene.source import KeyPath


def senseless(scene: Scene, model: Model, state: State) -> Iterator[Complaint]:
    """Check the expectations of a scene that has been compiled."""
    subject = Subject.compiled(scene, model, state)
    for name, expectation in scene.expect.items():
        path = ("expect", name)
        yield from _timeless(path, expectation)
        for where, part in _parts(path, expectation):
            yield from _immeasurable(where, part, subject)


def _parts(path: KeyPath, expectation: Expectation) -> Iterator[tuple[KeyPath, Expectation]]:
    """Yield an expectation and all that it is made of, with where each stands."""
    yield path, expectation
    for key, part in expectation.parts.items():
        yield from _parts((*path, *_keys(key)), part)


def _keys(key: str) -> KeyPath:
    """Return the keys that lead to a part: `all.0` is the first of a list."""
    word, _, index = key.partition(".")
    return (word, int(index)) if index else (word,)


def _timeless(path: KeyPath, expectation: Expectation) -> Iterator[Complaint]:
    """Check that there is a time for everything: a bare statement would be about round 0, which nobody means."""
    if expectation.said(WHENS):
        return
    if expectation.measure is not None:
        yield Complaint(path, "say when: `at: ROUND`, `always: true` or `eventually: true`")
    for key, part in expectation.parts.items():
        yield from _timeless((*path, *_keys(key)), part)


def _immeasurable(path: KeyPath, expectation: Expectation, subject: Subject) -> Iterator[Complaint]:
    """Check that what is to be measured is there."""
    if expectation.measure is None:
        return
    try:
        gauge_of(parse_measure(expectation.measure), subject)
    except (MeasureError, SelectionError) as error:
        yield Complaint((*path, "measure"), str(error))
