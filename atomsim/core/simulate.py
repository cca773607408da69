"""From a model and a state to frames; knows backends only by what they must do, and no files."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Protocol

from atomsim.core.diagnosis.blowup import explain, loss
from atomsim.core.diagnosis.energy import EnergyBudget
from atomsim.core.digest import state_digest
from atomsim.core.model import Frame, Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.observables import Observer
from atomsim.errors import BlowUpError


class Stepper(Protocol):
    """What a backend does: it advances one state of one model, always to the same bits."""

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""

    def state(self) -> State:
        """Return a copy of the present state."""


REPORT_SECONDS = 0.1
"""How long a run goes on, about, before it says where it is."""

MakeStepper = Callable[[Model, State], Stepper]


def simulate(
    model: Model,
    state: State,
    rounds: int,
    record_every: int = 10,
    make_stepper: MakeStepper = NumpyStepper,
    report: Callable[[int], None] | None = None,
    first: State | None = None,
) -> Iterator[Frame]:
    """Yield the frames of a run: its first state, every `record_every` rounds, and its last round.

    Args:
        model: the compiled scene.
        state: where to begin; it is the first frame.
        rounds: the round to run to.
        record_every: rounds between two frames; frames fall on its multiples.
        make_stepper: the backend.
        report: called after the first frame and then several times a second with the round reached; what it raises ends
            the run.
        first: where the scene begins, if `state` is a later round; what is said of a blow-up depends on it.

    Yields:
        Frames in order of rounds.

    Raises:
        BlowUpError: a number left the finite, an atom flew off, or energy came from nowhere; all frames before have
            been yielded.
    """
    observer = Observer(model)
    first = first or state
    budget = EnergyBudget(model, first, observer.observe(first))
    stepper = make_stepper(model, state)
    pace = _Pace(stepper, report)
    frame = frame_of(model, state, observer)
    yield frame
    if report is not None:
        report(state.round_index)
    while state.round_index < rounds:
        next_round = min(rounds, (state.round_index // record_every + 1) * record_every)
        pace.advance(state.round_index, next_round)
        before, state = state, stepper.state()
        frame = frame_of(model, state, observer)
        if loss(frame, model, budget):
            raise _blow_up(model, first, budget, before, make_stepper)
        yield frame


class _Pace:
    """Advances a stepper in stretches that take about REPORT_SECONDS each; how it is cut changes no bit.

    Args:
        stepper: what is advanced.
        report: called after each stretch with the round reached; without one there is no reason to stop on the way.
    """

    def __init__(self, stepper: Stepper, report: Callable[[int], None] | None) -> None:
        self._stepper = stepper
        self._report = report
        self._stretch = 1

    def advance(self, round_index: int, stop: int) -> None:
        """Advance from one round to another."""
        if self._report is None:
            self._stepper.advance(stop - round_index)
            return
        while round_index < stop:
            begin = time.perf_counter()
            n_rounds = min(self._stretch, stop - round_index)
            self._stepper.advance(n_rounds)
            round_index += n_rounds
            self._report(round_index)
            is_quick = time.perf_counter() - begin < REPORT_SECONDS
            self._stretch = max(self._stretch, 2 * n_rounds) if is_quick else max(1, n_rounds // 2)


def frame_of(model: Model, state: State, observer: Observer) -> Frame:
    """Measure a state and name it by its digest."""
    return Frame(
        state=state,
        time=state.round_index * model.time_step,
        digest=state_digest(state.position, state.velocity, state.memory),
        observables=observer.observe(state),
    )


def _blow_up(model: Model, first: State, budget: EnergyBudget, sound: State, make_stepper: MakeStepper) -> BlowUpError:
    """Go through the rounds since the last sound frame again, one by one, to find where it happened."""
    stepper, observer = make_stepper(model, sound), Observer(model)
    while True:
        stepper.advance(1)
        state = stepper.state()
        lost = loss(frame_of(model, state, observer), model, budget)
        if lost:
            return BlowUpError(explain(model, first, sound, state, lost))
        sound = state
