"""Flights against the stepper that they foretell, and first meetings known by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.running import atoms_at
from support.running import compiled as compile_data

from atomsim.core.diagnosis.bodies import bodies
from atomsim.core.diagnosis.flight import Mover, TooManyMoversError, movers
from atomsim.core.diagnosis.meeting import first_meeting
from atomsim.core.diagnosis.outlook import Surroundings, outlooks
from atomsim.core.forces import held_atoms
from atomsim.core.model import Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper


def moving(model: Model, state: State) -> list[Mover]:
    group = np.repeat(np.arange(len(model.groups)), [span.stop - span.start for span in model.groups])
    body = bodies([(table.first, table.second) for table in model.bonds], model.n_atoms)
    return movers(model, state, body, group)


def looking(rounds: int, groups: dict[str, Any], time_step: float = 0.05, **sections: Any):
    model, state = compile_data(groups, time_step, **sections)
    found = moving(model, state)
    is_held = np.zeros(model.n_atoms, dtype=bool)
    is_held[held_atoms(model.forces)] = True
    return outlooks(model, Surroundings(model, state, found, is_held), found, rounds)


def after(model: Model, state: State, n_rounds: int) -> State:
    stepper = NumpyStepper(model, state)
    stepper.advance(n_rounds)
    return stepper.state()


BODY = {"shape": "block", "counts": [2, 2, 2], "spacing": 1.2, "velocity": [1.0, 0.5, -0.25]}
STIFF = {"a": {"within": "a", "rule": "all-pairs"}}


@pytest.mark.parametrize(
    "forces",
    [
        {},
        {"weight": {"kind": "gravity", "impulse": [0, 0, -0.01]}},
        {"air": {"kind": "damping", "coefficient": 0.03}},
        {"air": {"kind": "damping", "coefficient": 1.0}, "weight": {"kind": "gravity", "impulse": [0, 0.1, 0]}},
        {"air": {"kind": "damping", "coefficient": 1e-9}, "weight": {"kind": "gravity", "impulse": [0, 0.1, 0]}},
        {
            "air": {"kind": "damping", "coefficient": 0.02},
            "weight": {"kind": "gravity", "impulse": [0, 0, -0.01]},
            "motor": {"kind": "push", "impulse": [0.05, 0, 0], "from_round": 7, "until_round": 31},
            "brake": {"kind": "push", "impulse": [-0.2, 0, 0], "from_round": 25},
        },
        {"part": {"kind": "push", "acts_on": "a[0:2]", "impulse": [0, 0.04, 0]}},
    ],
)
@pytest.mark.parametrize("rounds", [1, 7, 30, 31, 200])
def test_the_centroid_goes_where_the_flight_says(forces: dict[str, Any], rounds: int) -> None:
    """Exactly, but for rounding: whatever the bonds do inside, the centroid follows the mean of what acts."""
    model, state = compile_data({"a": BODY}, 0.05, bonds=STIFF, forces=forces)
    (mover,) = moving(model, state)
    way, velocity = mover.flight.at(float(rounds))
    then = after(model, state, rounds)
    assert then.position.mean(axis=0) - state.position.mean(axis=0) == pytest.approx(way, rel=1e-6, abs=1e-9)
    assert then.velocity.mean(axis=0) == pytest.approx(velocity, rel=1e-6, abs=1e-9)
    assert mover.is_turning == ("part" in forces)


def test_what_is_held_tethered_or_swung_is_not_foretold() -> None:
    held = {"grip": {"kind": "hold", "acts_on": "a[0]"}}
    tied = {"cord": {"kind": "tether", "acts_on": "a[3]", "target": [0, 0, 9]}}
    swung = {"wind": {"kind": "oscillate", "impulse": [0.1, 0, 0], "period": 40}}
    pulled = {"magnet": {"kind": "push", "towards": [0, 0, 9], "magnitude": 0.1}}
    for forces in (held, tied, swung, pulled):
        assert moving(*compile_data({"a": BODY}, 0.05, bonds=STIFF, forces=forces)) == []
    still = {"wind": {"kind": "oscillate", "impulse": [0, 0, 0], "period": 40}}
    assert len(moving(*compile_data({"a": BODY}, 0.05, bonds=STIFF, forces=still))) == 1


def test_loose_atoms_that_move_alike_are_one_mover() -> None:
    groups = {"a": BODY, "b": BODY | {"centre": [9, 0, 0]}}
    first, second = moving(*compile_data(groups, 0.05))
    assert (first.atoms.tolist(), second.atoms.tolist()) == (list(range(8)), list(range(8, 16)))
    assert first.is_loose
    assert not first.is_turning
    spread = {"a": BODY, "b": BODY | {"spin": {"axis": "z", "rate": 1}, "centre": [9, 0, 0]}}
    assert len(moving(*compile_data(spread, 0.05))) == 5  # the corners of b have four velocities
    part = {"wind": {"kind": "push", "acts_on": "a[0:3]", "impulse": [1, 0, 0]}}
    assert [mover.atoms.size for mover in moving(*compile_data({"a": BODY}, 0.05, forces=part))] == [5, 3]


def test_too_many_movers_are_not_followed() -> None:
    crowd = {"a": {"shape": "string", "count": 400, "step": [3, 0, 0], "spin": {"axis": "z", "rate": 1}}}
    with pytest.raises(TooManyMoversError):
        moving(*compile_data(crowd, 0.05))


FLOOR = {"shape": "plane", "counts": [9, 9], "step_x": [1.5, 0, 0], "step_y": [0, 1.5, 0]}
GROUND = {"ground": {"kind": "hold", "acts_on": "floor"}}


def test_a_fall_meets_the_floor_in_the_round_in_which_it_does() -> None:
    """From 10 above to 2 above: τ g n(n + 1)/2 = 8."""
    groups = {"floor": FLOOR, "ball": atoms_at((0, 0, 10))}
    forces = {"weight": {"kind": "gravity", "acts_on": "ball", "impulse": [0, 0, -0.01]}, **GROUND}
    (ahead,) = looking(1000, groups, collisions={"land": {"between": ["floor", "ball"]}}, forces=forces)
    assert ahead.first is not None
    exact = next(n for n in range(1000) if 0.05 * 0.01 * n * (n + 1) / 2 > 8)
    assert exact - 1 <= ahead.first.round_index <= exact + 4  # within 0.3 of way
    assert ahead.first.other == 40  # the atom in the middle
    assert ahead.first.speed[2] == pytest.approx(-0.01 * ahead.first.round_index)


def test_what_rises_comes_back() -> None:
    groups = {"floor": FLOOR, "ball": atoms_at((0, 0, 3), velocity=[0, 0, 4])}
    forces = {"weight": {"kind": "gravity", "acts_on": "ball", "impulse": [0, 0, -0.01]}, **GROUND}
    (ahead,) = looking(100, groups, collisions={"land": {"between": ["floor", "ball"]}}, forces=forces)
    assert ahead.first is not None
    assert 800 < ahead.first.round_index < 830
    assert ahead.horizon > 800


def test_what_lands_stops_for_those_who_come_later() -> None:
    crate = {"shape": "block", "counts": [2, 2, 2], "spacing": 1.4}
    groups = {"floor": FLOOR, "low": crate | {"centre": [0, 0, 4]}, "high": crate | {"centre": [0, 0, 12]}}
    bonds = {"stiff": {"within": ["low", "high"], "rule": "all-pairs"}}
    forces = {"weight": {"kind": "gravity", "acts_on": ["low", "high"], "impulse": [0, 0, -0.01]}, **GROUND}
    pile = {"pile": {"among": ["floor", "low", "high"]}}
    low, high = looking(1000, groups, bonds=bonds, collisions=pile, forces=forces)
    assert low.first is not None
    assert high.first is not None
    assert high.first.other in low.mover.atoms
    assert low.first.round_index < high.first.round_index < 250


def test_moving_partners_are_met_where_they_will_be() -> None:
    belt = {"shape": "string", "count": 3, "step": [2, 0, 0], "centre": [-20, 0, 0], "velocity": [1.0, 0, 0]}
    groups = {"belt": belt, "ball": atoms_at((0, 0, 2.5))}
    forces = {"drive": {"kind": "hold", "acts_on": "belt"}}
    (ahead,) = looking(1000, groups, collisions={"ride": {"between": ["belt", "ball"]}}, forces=forces)
    assert ahead.first is None  # it passes below, 2.5 away
    groups["ball"] = atoms_at((0, 0, 1.5))
    (ahead,) = looking(1000, groups, collisions={"ride": {"between": ["belt", "ball"]}}, forces=forces)
    assert ahead.first is not None
    assert ahead.first.round_index == pytest.approx((18 - np.sqrt(4 - 1.5**2)) / 0.05, abs=7)


def test_a_path_is_looked_at_even_between_rounds() -> None:
    """Ten lengths a round: the wall is met all the same."""
    groups = {
        "wall": FLOOR | {"step_x": [0, 1.5, 0], "step_y": [0, 0, 1.5]},
        "shot": atoms_at((-20, 0.2, 0.1), velocity=[200, 0, 0]),
    }
    (ahead,) = looking(
        50,
        groups,
        collisions={"stop": {"between": ["wall", "shot"]}},
        forces={"fixed": {"kind": "hold", "acts_on": "wall"}},
    )
    assert ahead.first is not None
    assert 1.8 <= ahead.first.round_index <= 1.85


def test_a_body_that_turns_is_taken_for_a_ball() -> None:
    rod = {"shape": "string", "count": 9, "step": [1, 0, 0], "centre": [0, 0, 9], "spin": {"axis": "y", "rate": 1}}
    groups = {"floor": FLOOR, "rod": rod}
    forces = {"weight": {"kind": "gravity", "acts_on": "rod", "impulse": [0, 0, -0.01]}, **GROUND}
    (ahead,) = looking(1000, groups, bonds={"rod": {"within": "rod", "rule": "all-pairs"}},
                       collisions={"land": {"between": ["floor", "rod"]}}, forces=forces)  # fmt: skip
    assert ahead.mover.is_turning
    assert ahead.mover.radius == pytest.approx(4.0)
    assert ahead.first is not None
    way, _ = ahead.mover.flight.at(ahead.first.round_index)
    assert 9 + way[2] == pytest.approx(6.0, abs=0.35)


def test_meetings_beyond_the_last_round_are_none() -> None:
    model, state = compile_data({"ball": atoms_at((0, 0, 0), velocity=[1, 0, 0])}, 0.1)
    (mover,) = moving(model, state)
    target = np.array([[10.0], [0.0], [0.0]])
    start = np.ascontiguousarray(state.position.T)
    assert first_meeting(mover.flight, start, target, 2.0, last=79.0) is None
    met = first_meeting(mover.flight, start, target, 2.0, last=100.0)
    assert met is not None
    assert met.round_index == pytest.approx(80, abs=3.1)
