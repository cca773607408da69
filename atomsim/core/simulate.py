"""From a model and a state to the frames of a run; knows no files."""

from __future__ import annotations

from collections.abc import Iterator

from atomsim import arguments
from atomsim.core.backend import MakeStepper, choose
from atomsim.core.model import Frame, Model, State
from atomsim.core.pace import Report
from atomsim.core.simulation import Simulation


def simulate(
    model: Model,
    state: State,
    rounds: int,
    record_every: int = 10,
    backend: str | MakeStepper = "auto",
    threads: int | None = None,
    report: Report | None = None,
    first: State | None = None,
) -> Iterator[Frame]:
    """Return the frames of a run: its first state, every `record_every` rounds, and its last round.

    Args:
        model: the compiled scene.
        state: where to begin; it is the first frame.
        rounds: the round to run to.
        record_every: rounds between two frames; frames fall on its multiples.
        backend: `auto`, `numpy` or `numba`, or what makes a stepper; whichever it is, the frames have the same bits.
        threads: how many threads to use; by default as many as are worth it.
        report: called after the first frame and then several times a second with the round reached; where its answer is
            true, the run ends.
        first: where the scene begins, if `state` is a later round; what is said of a blow-up depends on it.

    Returns:
        Frames in order of rounds, computed as they are asked for.

    Raises:
        InputError: an argument that will not do.
        BlowUpError: while the frames are asked for, a number left the finite, an atom flew off, or energy came from
            nowhere; all frames before have been yielded.
    """
    arguments.instance("model", model, Model, arguments.MODEL)
    arguments.instance("state", state, State, arguments.STATE)
    if first is not None:
        arguments.instance("first", first, State, arguments.STATE)
    arguments.function("report", report)
    rounds = arguments.whole("rounds", rounds, least=0)
    record_every = arguments.whole("record_every", record_every)
    if not callable(backend):
        backend = choose(backend, threads, model, rounds - state.round_index).make_stepper
    return _frames(Simulation(model, state, backend, first), rounds, record_every, report)


def _frames(simulation: Simulation, rounds: int, record_every: int, report: Report | None) -> Iterator[Frame]:
    yield simulation.frame()
    if report is not None and report(simulation.round_index):
        return
    while simulation.round_index < rounds:
        next_round = min(rounds, (simulation.round_index // record_every + 1) * record_every)
        goes_on = simulation.step(next_round - simulation.round_index, report)
        if simulation.round_index == next_round:
            yield simulation.frame()
        if not goes_on:
            return
