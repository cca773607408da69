"""What the report of a blow-up says, line by line, and that looking for one costs next to nothing."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from support.running import atoms_at, compiled

from atomsim.core.diagnosis.blowup import FLOWN_APART, explain, is_sound, loss
from atomsim.core.diagnosis.energy import EnergyBudget, total_energy
from atomsim.core.model import Model, State
from atomsim.core.observables import Observer
from atomsim.core.simulate import simulate
from atomsim.errors import BlowUpError

PAIR = {"calm": atoms_at((0, 0, 9)), "pair": atoms_at((0, 0, 0), (1.5, 0, 0))}


def report_of(groups: dict[str, Any], time_step: float, **sections: Any) -> str:
    """Run a scene that blows up; return what is said of it."""
    model, state = compiled(groups, time_step, **sections)
    with pytest.raises(BlowUpError) as caught:
        list(simulate(model, state, 5000, 1000))
    return str(caught.value)


def test_a_bond_that_is_too_stiff_for_the_time_step() -> None:
    groups = {"calm": atoms_at((0, 0, 9)), "rod": {"shape": "string", "count": 20, "step": [1.5, 0, 0]}}
    text = report_of(
        groups, 0.5, bonds={"b": {"within": "rod", "rule": "all-pairs"}}, jitter={"amplitude": 1e-3, "seed": 1}
    )
    first, pushed, stiff, remedy = text.splitlines()
    assert re.fullmatch(
        r"the simulation blew up in round \d+: rod\[\d+\] \(atom \d+\) is the fastest, "
        r"and the energy is \d+, where the scene accounts for 0\.0212",
        first,
    )
    assert re.fullmatch(
        r"  pushed hardest by bonds\.b \(<scene>:1\), against rod\[\d+\] \(atom \d+\), "
        r"with an impulse of \S+ in one round",
        pushed,
    )
    assert re.fullmatch(r"  time_step is 0\.5; the stiffness of the scene allows less than 0\.\d+", stiff)
    assert remedy == "  remedy: a smaller time_step or fewer bonds per atom"


def test_damping_that_is_too_much_for_the_time_step() -> None:
    """A tether of stiffness 1 at its target needs τ < 4 − 2m, and is as elastic at any distance."""
    scene = {"t": {"kind": "tether", "acts_on": "calm", "target": [0, 0, 0], "rest": 0}}
    mud = {"kind": "damping", "coefficient": 0.9, "acts_on": "calm"}
    text = report_of(PAIR, 2.3, forces={**scene, "mud": mud})
    assert text.splitlines()[-2:] == [
        "  time_step is 2.3; the stiffness of the scene allows less than 2.2 with its damping",
        "  remedy: a smaller time_step or fewer bonds per atom, or less damping",
    ]


def test_a_force_that_is_too_strong() -> None:
    force = {"kind": "gravity", "acts_on": "calm", "impulse": [0, 0, -1e9]}
    assert report_of(PAIR, 0.1, forces={"wind": {"kind": "damping", "coefficient": 0.1}, "storm": force}) == (
        "the simulation blew up in round 1: calm[0] (atom 0) flew off\n"
        "  pushed hardest by forces.storm (<scene>:1), with an impulse of 1e+09 in one round\n"
        "  nothing here is elastic: look at speeds\n"
        "  remedy: weaker external forces, lower velocities, more damping, or a smaller time_step"
    )


def test_a_collision_out_of_nearly_nothing() -> None:
    groups = {"a": atoms_at((0, 0, 0), (1e-9, 0, 0))}
    assert report_of(groups, 0.1, collisions={"c": {"within": "a"}}) == (
        "the simulation blew up in round 1: a[0] (atom 0) flew off\n"
        "  pushed hardest by collisions.c (<scene>:1), against a[1] (atom 1), with an impulse of 4e+09 in one round\n"
        "  time_step is 0.1; the stiffness of the scene allows less than 5e-19\n"
        "  remedy: a smaller time_step or fewer bonds per atom"
    )


def test_bound_atoms_that_meet_exactly() -> None:
    """A bond of rest 0 moves both by τ times their distance: at τ = 0.5 both are in the middle after a round."""
    bonds = {
        "calm": {"between": ["pair", "calm"], "rule": "all-pairs"},
        "pull": {"within": "pair", "rule": "all-pairs", "rest": 0},
    }
    assert report_of({**PAIR, "calm": atoms_at((0.75, 0, 9))}, 0.5, bonds=bonds) == (
        "the simulation blew up in round 1: pair[0] (atom 1) and pair[1] (atom 2) met exactly\n"
        "  bonds.pull (<scene>:1) acts between them, and at one place a force has no direction\n"
        "  remedy: another time_step or a tiny jitter, so that they miss each other; for a bond, a larger rest"
    )


@pytest.mark.parametrize("magnitude", [0, 1])
def test_colliding_atoms_that_meet_exactly(magnitude: float) -> None:
    """Whether their infinite energy tells, or, where a torque hides it, the round after."""
    groups = {**PAIR, "a": atoms_at((-3, 0, 0), velocity=[3, 0, 0]), "b": atoms_at((3, 0, 0), velocity=[-3, 0, 0])}
    forces = {"t": {"kind": "torque", "acts_on": "calm", "about": "pair", "axis": "z", "magnitude": magnitude}}
    text = report_of(groups, 1.0, collisions={"c": {"between": ["a", "b"]}}, forces=forces if magnitude else {})
    assert text.splitlines()[:2] == [
        "the simulation blew up in round 1: a[0] (atom 3) and b[0] (atom 4) met exactly",
        "  collisions.c (<scene>:1) acts between them, and at one place a force has no direction",
    ]


def test_an_atom_that_nothing_pushes() -> None:
    model, state = compiled({"a": atoms_at((0, 0, 0), velocity=[1, 0, 0])}, 1.0)
    with pytest.raises(BlowUpError) as caught:
        list(simulate(model, State(0, state.position, 1e9 * state.velocity), 10))
    assert str(caught.value).splitlines()[:2] == [
        "the simulation blew up in round 1: a[0] (atom 0) flew off",
        "  nothing here is elastic: look at speeds",
    ]


DRAG = {"kind": "damping", "coefficient": 0.9}


def test_damping_does_not_push() -> None:
    """It takes more in a round than the bond gives, but what it takes was there."""
    rod = {"rod": {"shape": "string", "count": 12, "step": [1.5, 0, 0], "velocity": [0, 0, 1]}}
    bonds = {"b": {"within": "rod", "rule": "all-pairs"}}
    text = report_of(rod, 0.1, bonds=bonds, forces={"drag": DRAG}, jitter={"amplitude": 1e-3, "seed": 1})
    _, pushed, stiff, remedy = text.splitlines()
    assert pushed.startswith("  pushed hardest by bonds.b (<scene>:1), against rod[")
    assert stiff == "  time_step is 0.1; the stiffness of the scene allows less than 0.0917 with its damping"
    assert remedy == "  remedy: a smaller time_step or fewer bonds per atom, or less damping"


def test_a_storm_is_to_blame_and_not_what_resists_it() -> None:
    storm = {"kind": "push", "impulse": [0, 0, 5e7], "acts_on": "calm", "from_round": 2}
    text = report_of(PAIR, 0.1, forces={"storm": storm, "drag": DRAG})
    assert "  pushed hardest by forces.storm (<scene>:1), with an impulse of 5e+07 in one round" in text.splitlines()


def test_damping_that_takes_more_than_there_is() -> None:
    forces = {
        "drag": DRAG,
        "mud": {**DRAG, "coefficient": 1, "acts_on": ["calm", "pair[0]"]},
        "oil": {**DRAG, "acts_on": "calm"},
    }
    groups = {**PAIR, "calm": atoms_at((0, 0, 9), velocity=[1, 0, 0])}
    all_three = "forces.drag (<scene>:1), forces.mud (<scene>:1), forces.oil (<scene>:1)"
    assert report_of(groups, 0.1, forces=forces).splitlines()[1:] == [
        f"  {all_three} take 2.8 times its velocity in a round",
        "  remedy: less damping, so that the coefficients on an atom add up to less than 2",
    ]


def state_with(number: float, what: str) -> tuple[Model, State]:
    model, state = compiled(PAIR, 0.5)
    position, velocity = state.position.copy(), state.velocity.copy()
    {"position": position, "velocity": velocity}[what][1, 2] = number
    return model, State(7, position, velocity)


@pytest.mark.parametrize("what", ["position", "velocity"])
@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_not_sound(what: str, number: float) -> None:
    model, state = state_with(number, what)
    assert not is_sound(model, state)
    assert "pair[0] (atom 1) flew off" in explain(model, state, state_with(0.0, what)[1], state)


def test_an_atom_has_flown_off_when_it_moves_too_far_in_a_round() -> None:
    assert is_sound(*state_with(2 * FLOWN_APART, "velocity"))
    assert not is_sound(*state_with(2.1 * FLOWN_APART, "velocity"))
    assert is_sound(*state_with(1e100, "position"))


def test_a_resumed_run_tells_the_same_story() -> None:
    """The limit in the report is that of the scene's first state, whichever round the run went on from."""
    chain = {"a": {"shape": "string", "count": 3, "step": [1.1, 0, 0]}}
    model, first = compiled(
        chain, 3.0, bonds={"b": {"within": "a", "rule": "all-pairs"}}, jitter={"amplitude": 1e-3, "seed": 1}
    )
    whole: list[State] = []
    with pytest.raises(BlowUpError) as story:
        whole.extend(frame.state for frame in simulate(model, first, 5000, 1))
    for state in (whole[len(whole) // 2], whole[-1]):
        with pytest.raises(BlowUpError) as again:
            list(simulate(model, state, 5000, 1, first=first))
        assert str(again.value) == str(story.value)


ROD = {"rod": {"shape": "string", "count": 12, "step": [1.5, 0, 0], "velocity": [0, 0, 1]}}
BOUND = {"b": {"within": "rod", "rule": "all-pairs"}}
TREMBLE = {"amplitude": 1e-3, "seed": 1}


def test_energy_out_of_nowhere_ends_a_run_long_before_an_atom_flies_off() -> None:
    model, state = compiled(ROD, 0.18, bonds=BOUND, jitter=TREMBLE)  # the limit is 4/24
    frames = []
    with pytest.raises(BlowUpError, match="is the fastest, and the energy is"):
        frames.extend(simulate(model, state, 5000, 10))
    assert all(is_sound(model, frame.state) for frame in frames)
    assert max(total_energy(frame.observables) for frame in frames) < 1001 * (total_energy(frames[0].observables) + 1)


@pytest.mark.parametrize(
    "forces",
    [
        {"weight": {"kind": "gravity", "impulse": [0, 0, -0.5]}},
        {"shove": {"kind": "push", "impulse": [0, 3, 0], "from_round": 5, "until_round": 30}},
        {"swing": {"kind": "oscillate", "impulse": [1, 0, 0], "period": 12}},
        {"turn": {"kind": "torque", "axis": "z", "magnitude": 5}},
        {"magnet": {"kind": "push", "towards": [0, 0, 500], "magnitude": 3, "until_round": 30}},
        {"leash": {"kind": "tether", "target": [0, 0, 500], "rest": 1}},
        {"bed": {"kind": "tether", "acts_on": "rod[::2]", "target": "initial"}},
        {"belt": {"kind": "hold", "acts_on": "rod[0]"}, "weight": {"kind": "gravity", "impulse": [0, 0, -0.5]}},
        {"mud": {"kind": "damping", "coefficient": 0.5}},
    ],
)
def test_energy_that_forces_give_is_no_blow_up(forces: dict[str, Any]) -> None:
    model, state = compiled(ROD, 0.1, bonds=BOUND, forces=forces, jitter=TREMBLE)
    assert len(list(simulate(model, state, 2000, 50))) == 41


def test_a_push_beyond_all_numbers_that_never_comes() -> None:
    """The budget of energy is infinite then, without a warning."""
    storm = {"kind": "push", "impulse": [0, 0, 1e200], "from_round": 90}
    model, state = compiled(PAIR, 0.1, forces={"storm": storm})
    assert len(list(simulate(model, state, 50, 10))) == 6


@pytest.mark.parametrize("what", ["position", "velocity"])
@pytest.mark.parametrize("number", [np.nan, np.inf, 1e300, 2.1 * FLOWN_APART])
def test_what_observables_tell_is_what_atoms_tell(what: str, number: float) -> None:
    """Frames are first judged by their observables, which are at hand."""
    model, state = state_with(number, what)
    _, sound = state_with(0.0, "position")
    budget = EnergyBudget(model, sound, Observer(model).observe(sound))
    is_lost = loss(model, state, Observer(model).observe(state), budget) == "flew off"
    assert is_lost != is_sound(model, state)
