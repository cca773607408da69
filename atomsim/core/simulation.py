"""A simulation: one state of one model that is stepped, measured and pushed from outside, on any backend."""

from __future__ import annotations

from typing import Any

import numpy as np

from atomsim import arguments
from atomsim.core.backend import MakeStepper, Stepper
from atomsim.core.diagnosis.blowup import explain, loss, not_again
from atomsim.core.diagnosis.energy import EnergyBudget, size
from atomsim.core.digest import state_digest
from atomsim.core.forces import held_atoms
from atomsim.core.model import Floats, Frame, Model, Observables, State
from atomsim.core.observables import Observer
from atomsim.core.pace import Pace, Report
from atomsim.errors import BlowUpError


class Simulation:
    """A state that is advanced by as many rounds as one likes, and looked at in between.

    Args:
        model: the compiled scene.
        state: where to begin.
        make_stepper: the backend.
        first: where the scene begins, if `state` is a later round; what is said of a blow-up depends on it.
    """

    def __init__(self, model: Model, state: State, make_stepper: MakeStepper, first: State | None = None) -> None:
        self._make_stepper = make_stepper
        self._pace = Pace()
        self._forces: Floats | None = None
        self._begin(model, state, first or state)

    def _begin(self, model: Model, state: State, first: State) -> None:
        """Stand at a state of a model."""
        if state.memory.layout != model.memory:
            raise ValueError(f"a state that remembers {state.memory.layout} of a model that remembers {model.memory}")
        self._model = model
        self._first = first
        self._observer = Observer(model)
        self._held = held_atoms(model.forces)
        self._budget = EnergyBudget(model, first, self._observer.observe(first))
        self._driven, self._pushed = 0.0, self._pushed_per_round()
        self._stand_at(state)

    def _stand_at(self, state: State) -> None:
        self._stepper = self._stepper_at(state)
        self._state = state
        self._observables: Observables | None = None

    def _stepper_at(self, state: State) -> Stepper:
        stepper = self._make_stepper(self._model, state)
        stepper.set_forces(self._forces)
        return stepper

    @property
    def model(self) -> Model:
        """The compiled scene."""
        return self._model

    @property
    def round_index(self) -> int:
        """Iteration rounds done."""
        return self._state.round_index

    @property
    def state(self) -> State:
        """A copy of the present state."""
        return self._stepper.state()

    def measure(self) -> Observables:
        """Return what is measured of the present state."""
        if self._observables is None:
            self._observables = self._observer.observe(self._state)
        return self._observables

    def frame(self) -> Frame:
        """Return the present round as it is recorded: state, digest and observables."""
        return frame_of(self._model, self.state, self.measure())

    def set_forces(self, impulse: Floats | None) -> None:
        """Push atoms from outside in every round to come, until this is called again.

        Atoms that a force of kind `hold` holds stay held. Where in a round it acts: `docs/numerics.md`.

        Args:
            impulse: what is added to j of every atom per round [velocity], (n_atoms, 3); None for nothing.

        Raises:
            InputError: it is no such array, or has numbers that are not finite.
        """
        if impulse is not None:
            impulse = _vectors("impulse", impulse, self._model.n_atoms)
        self._forces = impulse
        self._pushed = self._pushed_per_round()
        self._stepper.set_forces(impulse)

    def replace_model(self, model: Model) -> None:
        """Go on from the present state under other laws: another time step, other forces, other bonds.

        Rounds count on, forces from outside stay, and a frame's `time` is its round times the time step of now.

        Args:
            model: of the same atoms, remembering the same.

        Raises:
            InputError: it has other atoms.
        """
        arguments.instance("model", model, Model, arguments.MODEL)
        if model.n_atoms != self._model.n_atoms:
            raise arguments.refused("model", f"a model of {self._model.n_atoms} atoms", model.n_atoms)
        self._begin(model, self._state, self._state)

    def step(self, n_rounds: int = 1, report: Report | None = None) -> bool:
        """Compute so many iteration rounds, then look whether the simulation has blown up.

        Args:
            n_rounds: how many, 0 or more.
            report: called several times a second with the round reached; where its answer is true, the step ends there.

        Returns:
            Whether to go on: false if the report ended it.

        Raises:
            InputError: a number of rounds below 0.
            BlowUpError: a number left the finite, an atom flew off, or energy came from nowhere.

        Whatever is raised, also by the report or by Ctrl-C, the simulation stands where it stood before the step.
        """
        n_rounds = arguments.whole("n_rounds", n_rounds, least=0)
        arguments.function("report", report)
        before = self._state
        try:
            n_done, goes_on = self._pace.advance(self._stepper, before.round_index, n_rounds, report)
            if n_done:
                self._state, self._observables = self._stepper.state(), None
                self._check(before, n_done)
        except BaseException:
            self._stand_at(before)
            raise
        return goes_on

    def _check(self, before: State, n_rounds: int) -> None:
        """Raise if the simulation has blown up in one of so many rounds."""
        driven = self._driven + n_rounds * self._pushed
        lost = loss(self._model, self._state, self.measure(), self._budget, driven)
        if lost is not None:
            raise BlowUpError(self._report(before, lost))
        self._driven = driven

    def _report(self, before: State, lost: str) -> str:
        """Go through the rounds since a sound state again, one by one, and say in which it happened and how."""
        model, last = self._model, self._state
        stepper, observer, driven, sound = self._stepper_at(before), Observer(model), self._driven, before
        while sound.round_index < last.round_index:
            stepper.advance(1)
            state, driven = stepper.state(), driven + self._pushed
            lost_here = loss(model, state, observer.observe(state), self._budget, driven)
            if lost_here is not None:
                return explain(model, self._first, sound, state, lost_here, self._forces)
            sound = state
        return not_again(model, before, last, lost)

    def _pushed_per_round(self) -> float:
        """Return |G|, the size of all pushes from outside together."""
        if self._forces is None:
            return 0.0
        forces = self._forces.copy()
        forces[self._held] = 0.0
        return size(forces)


def frame_of(model: Model, state: State, observables: Observables) -> Frame:
    """Return a round as it is recorded."""
    digest = state_digest(state.position, state.velocity, state.memory)
    return Frame(state, state.round_index * model.time_step, digest, observables)


def _vectors(name: str, value: Any, n_atoms: int) -> Floats:
    """Return a copy of an argument that is a finite vector for each atom."""
    needs, got = f"finite numbers in the shape ({n_atoms}, 3)", value
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise arguments.refused(name, needs, value) from None
    is_finite = np.isfinite(array)
    if array.shape != (n_atoms, 3):
        got = array.shape
    elif not is_finite.all():
        got = float(array[~is_finite][0])
    else:
        return array
    raise arguments.refused(name, needs, got)
