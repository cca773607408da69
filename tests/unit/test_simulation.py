"""A simulation that is stepped by hand: the same bits as a run, forces from outside, blow-ups."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from operator import eq
from typing import Any

import numpy as np
import pytest
from support.everything import EVERYTHING
from support.remembering import RememberingStepper, remembering
from support.running import SCENES, after, atoms_at, compiled, digest_of

import atomsim
from atomsim.core.backend import MakeStepper
from atomsim.core.diagnosis.energy import total_energy
from atomsim.core.memory import EMPTY
from atomsim.core.model import Floats, Model, Origin, PushForce, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.simulate import simulate
from atomsim.core.simulation import Simulation
from atomsim.errors import BlowUpError, InputError

try:
    from atomsim.core.numba_backend.stepper import NumbaStepper
except ImportError:  # the backend is an extra
    BACKENDS: dict[str, MakeStepper] = {"numpy": NumpyStepper}
else:
    BACKENDS = {
        "numpy": NumpyStepper,
        "numba": NumbaStepper,
        "numba, 3 threads": lambda model, state: NumbaStepper(model, state, threads=3),
    }

every_backend = pytest.mark.parametrize("make_stepper", BACKENDS.values(), ids=BACKENDS.keys())
PAIR = {"a": atoms_at((0, 0, 0), (0, 5, 0))}


def winds(n_atoms: int, seed: int = 1) -> Floats:
    """Return a small push for each atom."""
    return 1e-3 * np.random.default_rng(seed).normal(size=(n_atoms, 3))


@every_backend
def test_how_it_is_stepped_changes_no_bit(make_stepper: MakeStepper) -> None:
    model, state = compiled(**EVERYTHING)
    simulation = Simulation(model, state, make_stepper)
    for n_rounds in (1, 0, 7, 1, 31):
        assert simulation.step(n_rounds)
    assert simulation.round_index == simulation.state.round_index == 40
    assert digest_of(simulation.state) == digest_of(after(model, state, 40))


def test_a_frame_of_it_is_that_of_a_run() -> None:
    model, state = compiled(**EVERYTHING)
    simulation = Simulation(model, state, NumpyStepper)
    for frame in simulate(model, state, 20, 10):
        simulation.step(frame.round_index - simulation.round_index)
        mine = simulation.frame()
        assert (mine.digest, mine.time, mine.round_index) == (frame.digest, frame.time, frame.round_index)
        assert simulation.measure().kinetic_energy == frame.observables.kinetic_energy


def test_states_and_frames_are_copies() -> None:
    simulation = Simulation(*compiled(PAIR), NumpyStepper)
    simulation.step()
    for state in (simulation.state, simulation.frame().state):
        state.position[0] = 7.0
    assert simulation.state.position.tolist() == [[0, 0, 0], [0, 5, 0]]
    assert simulation.frame().position.tolist() == [[0, 0, 0], [0, 5, 0]]


def test_what_it_measures_is_of_the_present_round() -> None:
    model, state = compiled(PAIR, forces={"g": {"kind": "gravity", "impulse": [0, 0, -1]}})
    simulation = Simulation(model, state, NumpyStepper)
    assert simulation.measure().momentum.tolist() == [0, 0, 0]
    simulation.step(3)
    assert simulation.measure().momentum.tolist() == [0, 0, -6]


def test_forces_from_outside_act_in_every_round_until_they_are_set_again() -> None:
    simulation = Simulation(*compiled(PAIR, 0.5), NumpyStepper)
    push = np.array([[0.5, 0, 0], [0, 0, -2]])
    simulation.set_forces(push)
    push[:] = 99.0  # it was copied
    simulation.step(0)
    simulation.step(1)
    simulation.step(3, lambda _: None)
    assert simulation.state.velocity.tolist() == [[2, 0, 0], [0, 0, -8]]
    simulation.set_forces(np.array([[0, 1, 0], [0, 0, 0]]))
    simulation.step(2)
    assert simulation.state.velocity.tolist() == [[2, 2, 0], [0, 0, -8]]
    simulation.set_forces(None)
    simulation.step(5)
    assert simulation.state.velocity.tolist() == [[2, 2, 0], [0, 0, -8]]


@every_backend
def test_forces_from_outside_are_a_push_declared_last(make_stepper: MakeStepper) -> None:
    """The same bits as a push on every atom after all other forces; held atoms stay held."""
    model, state = compiled(**EVERYTHING)
    wind = winds(model.n_atoms)
    simulation = Simulation(model, state, make_stepper)
    simulation.set_forces(wind)
    simulation.step(13)
    simulation.step(27)
    expected = after_pushes(model, state, wind, 40)
    assert digest_of(simulation.state) == digest_of(expected) != digest_of(after(model, state, 40))


def after_pushes(model: Model, state: State, wind: Floats, n_rounds: int) -> State:
    """Declare one push per atom after all other forces, and run."""
    origin = Origin("forces", "wind", "-", 1)
    pushes = [PushForce(origin, np.array([atom]), (x, y, z), 0, None) for atom, (x, y, z) in enumerate(wind.tolist())]
    return after(replace(model, forces=(*model.forces, *pushes)), state, n_rounds)


@every_backend
def test_forces_change_from_step_to_step_with_the_same_bits(make_stepper: MakeStepper) -> None:
    model, state = compiled(**EVERYTHING)
    reference, simulation = Simulation(model, state, NumpyStepper), Simulation(model, state, make_stepper)
    for number in range(12):
        wind = None if number % 4 == 3 else winds(model.n_atoms, number)
        for each in (reference, simulation):
            each.set_forces(wind)
            each.step(5)
        assert digest_of(simulation.state) == digest_of(reference.state)


@every_backend
def test_what_is_held_is_not_pushed(make_stepper: MakeStepper) -> None:
    model, state = compiled(PAIR, forces={"h": {"kind": "hold", "acts_on": "a[0]"}})
    simulation = Simulation(model, state, make_stepper)
    simulation.set_forces(np.ones((2, 3)))
    simulation.step(3)
    assert simulation.state.velocity.tolist() == [[0, 0, 0], [3, 3, 3]]


@pytest.mark.parametrize(
    ("impulse", "got"),
    [
        (np.zeros(3), "(3,)"),
        (np.zeros((3, 3)), "(3, 3)"),
        ([[1, 2, 3], [4, 5]], "[[1, 2, 3], [4, 5]]"),
        ("north", "'north'"),
        (np.array([[0, 0, np.nan], [0, 0, 0]]), "nan"),
        ([[0, 0, 0], [0, np.inf, np.inf]], "inf"),
    ],
)
def test_forces_that_make_no_sense(impulse: Any, got: str) -> None:
    simulation = Simulation(*compiled(PAIR), NumpyStepper)
    with pytest.raises(InputError) as caught:
        simulation.set_forces(impulse)
    assert str(caught.value) == f"impulse: needs finite numbers in the shape (2, 3) (got {got})"
    simulation.step()
    assert not simulation.state.velocity.any()


def test_a_number_of_rounds_below_zero() -> None:
    with pytest.raises(InputError, match=r"n_rounds: needs a whole number of 0 or more \(got -1\)"):
        Simulation(*compiled(PAIR), NumpyStepper).step(-1)


def test_a_step_can_be_stopped_and_gone_on_with(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("atomsim.core.pace.REPORT_SECONDS", 1e9)
    model, state = compiled(**EVERYTHING)
    simulation = Simulation(model, state, NumpyStepper)
    assert not simulation.step(40, lambda round_index: round_index >= 5)
    assert simulation.round_index == 7
    assert digest_of(simulation.state) == digest_of(after(model, state, 7))
    assert simulation.step(33, lambda _: None)
    assert digest_of(simulation.state) == digest_of(after(model, state, 40))


def test_a_run_ends_where_its_report_says_so() -> None:
    model, state = compiled(PAIR)
    for stop, rounds in ((0, [0]), (4, [0, 1, 2, 3, 4]), (9, list(range(10)))):
        frames = simulate(model, state, 9, 1, report=partial(eq, stop))
        assert [frame.round_index for frame in frames] == rounds


def test_a_run_that_ends_between_two_frames_ends_with_the_one_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("atomsim.core.pace.REPORT_SECONDS", 1e9)
    frames = simulate(*compiled(PAIR), 100, 10, report=lambda reached: reached > 13)
    assert [frame.round_index for frame in frames] == [0, 10]


@every_backend
@pytest.mark.parametrize("what", [KeyboardInterrupt, ValueError])
def test_whatever_ends_a_step_the_simulation_is_whole(
    monkeypatch: pytest.MonkeyPatch, make_stepper: MakeStepper, what: type[BaseException]
) -> None:
    """As when somebody presses Ctrl-C in a notebook, and goes on."""
    monkeypatch.setattr("atomsim.core.pace.REPORT_SECONDS", 1e9)
    model, state = compiled(**EVERYTHING)
    simulation = Simulation(model, state, make_stepper)
    simulation.set_forces(winds(model.n_atoms))
    simulation.step(5)
    before = digest_of(simulation.state)

    def fail(reached: int) -> None:
        if reached > 10:
            raise what

    with pytest.raises(what):
        simulation.step(30, fail)
    assert (simulation.round_index, digest_of(simulation.state)) == (5, before)
    simulation.step(35)
    whole = Simulation(model, state, NumpyStepper)
    whole.set_forces(winds(model.n_atoms))
    whole.step(40)
    assert digest_of(simulation.state) == digest_of(whole.state)


def test_forces_beyond_all_numbers_are_told_as_a_blow_up() -> None:
    """Their squares are not finite, and no warning comes of it."""
    simulation = Simulation(*compiled(PAIR), NumpyStepper)
    simulation.set_forces([[1e200, 0, 0], [0, 0, 0]])
    with pytest.raises(BlowUpError, match="flew off"):
        simulation.step(3)


def too_stiff() -> tuple[Model, State]:
    rod = {"rod": {"shape": "string", "count": 12, "step": [1.5, 0, 0], "velocity": [0, 0, 1]}}
    bonds = {"b": {"within": "rod", "rule": "all-pairs"}}
    return compiled(rod, 0.18, bonds=bonds, jitter={"amplitude": 1e-3, "seed": 1})


def test_after_a_blow_up_it_stands_where_it_stood_before_the_step() -> None:
    model, state = too_stiff()
    simulation = Simulation(model, state, NumpyStepper)
    simulation.step(10)
    before = digest_of(simulation.state)
    for _ in range(2):
        with pytest.raises(BlowUpError, match="is the fastest, and the energy is"):
            simulation.step(3000)
        assert (simulation.round_index, digest_of(simulation.state)) == (10, before)
    simulation.replace_model(replace(model, time_step=0.05))
    assert simulation.step(3000)


def test_other_laws_go_on_from_the_present_state() -> None:
    model, state = compiled(PAIR, forces={"g": {"kind": "gravity", "impulse": [0, 0, -1]}})
    simulation = Simulation(model, state, NumpyStepper)
    simulation.set_forces(np.array([[1.0, 0, 0], [0, 0, 0]]))
    simulation.step(2)
    simulation.replace_model(replace(model, forces=(), time_step=1.0))
    simulation.step(3)
    assert simulation.round_index == 5
    assert simulation.state.velocity.tolist() == [[5, 0, -2], [0, 0, -2]], "forces from outside stay"
    assert simulation.frame().time == 5.0
    with pytest.raises(InputError, match=r"model: needs a model of 2 atoms \(got 3\)"):
        simulation.replace_model(compiled({"b": {"shape": "string", "count": 3, "step": [3, 0, 0]}})[0])


def test_energy_that_comes_from_outside_is_no_blow_up() -> None:
    """A push declared in the scene may do this, so one from outside may; without it, nothing explains the energy."""
    model, state = compiled(PAIR)
    simulation = Simulation(model, state, NumpyStepper)
    push = np.array([[5.0, 0, 0], [0, 0, 0]])
    for _ in range(20):
        simulation.set_forces(push)
        simulation.step(50)
        simulation.set_forces(None)
        simulation.step(50)
    assert total_energy(simulation.measure()) == 0.5 * 5000.0**2


def test_a_storm_from_outside_is_named_in_the_report() -> None:
    simulation = Simulation(*compiled(PAIR, forces={"w": {"kind": "gravity", "impulse": [0, 0, -1]}}), NumpyStepper)
    simulation.set_forces(np.array([[0, 0, 0], [1e9, 0, 0]]))
    with pytest.raises(BlowUpError) as caught:
        simulation.step(10)
    assert str(caught.value).splitlines()[:2] == [
        "the simulation blew up in round 1: a[1] (atom 1) flew off",
        "  pushed hardest by forces from outside, with an impulse of 1e+09 in one round",
    ]


def faulty(at_round: int) -> Callable[[Model, State], NumpyStepper]:
    """Return a backend whose first stepper loses an atom once, as a flipped bit would; later ones are sound."""
    made: list[NumpyStepper] = []

    class Faulty(NumpyStepper):
        def __init__(self, model: Model, state: State) -> None:
            super().__init__(model, state)
            made.append(self)

        def advance(self, n_rounds: int) -> None:
            super().advance(n_rounds)
            if self is made[0] and self._round_index >= at_round:
                self._velocity[0, 1] = np.inf

    return Faulty


def test_a_fault_that_does_not_come_again_is_told_as_such() -> None:
    """Looking for its round ends, and the simulation can go on from where it was sound."""
    model, state = compiled(PAIR)
    simulation = Simulation(model, state, faulty(at_round=25))
    simulation.step(20)
    with pytest.raises(BlowUpError) as caught:
        simulation.step(20)
    assert str(caught.value) == (
        "the simulation blew up between rounds 20 and 40: a[1] (atom 1) flew off\n"
        "  these rounds were computed again, and nothing of it came back: the same sums had two results\n"
        "  remedy: run it again; if that helps now and then only, have the memory of this machine tested"
    )
    assert simulation.step(20)
    assert digest_of(simulation.state) == digest_of(after(model, state, 40))


def test_it_carries_what_a_run_remembers() -> None:
    model, state = remembering()
    simulation = Simulation(model, state, RememberingStepper)
    simulation.step(4)
    assert simulation.frame().memory["controllers.gait.random"] == 2**60 + 4
    with pytest.raises(ValueError, match="of a model that remembers"):
        Simulation(model, replace(state, memory=EMPTY), RememberingStepper)


def test_a_scene_is_simulated_by_its_file_or_loaded() -> None:
    path = SCENES / "threads.yaml"
    loaded = atomsim.load(path)
    for scene in (path, str(path), loaded):
        simulation = atomsim.Simulation(scene, backend="numpy")
        assert isinstance(simulation, atomsim.Simulation)
        simulation.step(3)
        assert digest_of(simulation.state) == digest_of(after(*atomsim.compile(loaded), 3))
    assert simulation.scene is loaded
    assert str(simulation.backend) == "numpy, 1 thread (as asked for)"
    with pytest.raises(InputError, match="backend: needs auto, numpy or numba"):
        atomsim.Simulation(loaded, backend="cuda")


def test_frames_from_python_come_from_the_backend_that_a_run_would_choose(monkeypatch: pytest.MonkeyPatch) -> None:
    model, state = compiled(PAIR)
    asked: list[tuple[Any, ...]] = []

    def choose(*how: Any) -> Any:
        asked.append(how)
        return type("Chosen", (), {"make_stepper": NumpyStepper})

    monkeypatch.setattr("atomsim.core.simulate.choose", choose)
    list(simulate(model, State(7, state.position, state.velocity), 20))
    list(simulate(model, state, 20, backend="numba", threads=3))
    list(simulate(model, state, 20, 10, NumpyStepper))
    assert asked == [("auto", None, model, 13), ("numba", 3, model, 20)]
