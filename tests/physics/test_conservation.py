"""Momentum and angular momentum stay what they are, to rounding, unless something from outside acts.

The bound: a round adds to each atom its pair forces and its impulse. Every addition rounds by at most half an ulp of
what it adds up to, which is at most S, the largest |v| + Σ|t| of any atom; so after N rounds Σv is off by at most
N · n_atoms · n_additions · ε · S (a factor of two to spare, for S is sampled), and Σ c × v by that times four times
the largest |c|: two products per component, the forces' rounded directions and the rounded positions.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.running import atoms_at, compiled, paper_scene

from atomsim.compiler import compile_scene
from atomsim.core.model import Floats, Indices, Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.observables import Observer
from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.scene import LoadedScene

ROUNDS = 400

EPSILON = float(np.finfo(np.float64).eps)

KNOT: dict[str, Any] = {
    "groups": {
        "one": {
            "shape": "ring",
            "count": 9,
            "radius": 1.7,
            "velocity": [0.3, 0.1, 0],
            "spin": {"axis": "z", "rate": 0.2},
        },
        "other": {
            "shape": "block",
            "counts": [3, 2, 2],
            "spacing": 1.1,
            "centre": [4, 1, 0.5],
            "velocity": [-0.4, 0, 0],
        },
    },
    "bonds": {
        "one": {"within": "one", "rule": "neighbour", "reach": 2},
        "other": {"within": "other", "rule": "all-pairs"},
    },
    "collisions": {"contact": {"between": ["one", "other"]}},
}


def drift(model: Model, state: State) -> tuple[float, float, float]:
    """Return how far momentum and angular momentum move in a run, in units of their bounds, and the former's bound."""
    stepper, observer = NumpyStepper(model, state), Observer(model)
    first = observer.observe(state)
    lost = turned = load = reach = 0.0
    for _ in range(ROUNDS // 10):
        stepper.advance(10)
        state = stepper.state()
        now = observer.observe(state)
        lost = max(lost, float(np.abs(now.momentum - first.momentum).max()))
        turned = max(turned, float(np.abs(now.angular_momentum - first.angular_momentum).max()))
        load = max(load, largest_load(model, state))
        reach = max(reach, float(np.abs(state.position).max()))
    bound = ROUNDS * model.n_atoms * n_additions(model) * EPSILON * load
    return lost / bound, turned / (4 * reach * bound), bound


def largest_load(model: Model, state: State) -> float:
    """Return the largest |v| + Σ|t| of any atom."""
    load = np.linalg.norm(state.velocity, axis=1)
    for table in model.bonds:
        add_load(load, state, table.first, table.second, np.sqrt(table.rest_squared))
    for contact in model.collisions:
        first, second = table_pairs_near(contact, state.position.T, 2.0)
        add_load(load, state, first, second, np.full(first.size, 2.0))
    return float(load.max())


def add_load(load: Floats, state: State, first: Indices, second: Indices, rest: Floats) -> None:
    """Add |t| = |d − r²/d| of every pair to both its atoms."""
    distance = np.linalg.norm(state.position[second] - state.position[first], axis=1)
    force = np.abs(distance - rest * rest / distance)
    np.add.at(load, first, force)
    np.add.at(load, second, force)


def n_additions(model: Model) -> int:
    """Return how many numbers at most are added up on one atom in a round: bonds, contacts, tables, velocity."""
    bonds = sum(np.bincount(np.concatenate((table.first, table.second))).max() for table in model.bonds)
    return int(bonds) + 12 + len(model.bonds) + len(model.collisions) + 1


@pytest.mark.parametrize("name", ["rods", "rod-thread", "threads"])
def test_paper_strings_conserve_both_momenta(name: str) -> None:
    lost, turned, bound = drift(*compile_scene(LoadedScene(paper_scene(name))))
    assert bound < 1e-7
    assert lost < 1
    assert turned < 1


def test_a_collision_conserves_both_momenta() -> None:
    model, state = compiled(**KNOT)
    assert Observer(model).observe(_touching(model, state)).contacts > 0
    lost, turned, bound = drift(model, state)
    assert bound < 1e-8
    assert lost < 1
    assert turned < 1


def _touching(model: Model, state: State) -> State:
    stepper, observer = NumpyStepper(model, state), Observer(model)
    for _ in range(ROUNDS):
        if observer.observe(stepper.state()).contacts:
            break
        stepper.advance(1)
    return stepper.state()


@pytest.mark.parametrize(
    ("force", "loses_momentum"),
    [
        ({"kind": "damping", "coefficient": 1e-6}, True),
        ({"kind": "gravity", "acts_on": "one[0]", "impulse": [0, 0, 1e-8]}, True),
        ({"kind": "hold", "acts_on": "one[0]"}, True),
        ({"kind": "tether", "acts_on": "one[0]", "target": [9, 9, 9], "rest": 1}, True),
        ({"kind": "torque", "axis": "y", "magnitude": 1e-6}, False),
    ],
)
def test_what_acts_from_outside_breaks_it(force: dict[str, Any], loses_momentum: bool) -> None:
    lost, turned, _ = drift(*compiled(**KNOT, forces={"outside": force}))
    assert (lost > 10) == loses_momentum
    assert turned > 10


def test_mirrored_balls_keep_a_momentum_of_exactly_zero() -> None:
    left, right = atoms_at((-3, 0.3, 0), velocity=[0.7, 0, 0]), atoms_at((3, -0.3, 0), velocity=[-0.7, 0, 0])
    model, state = compiled({"left": left, "right": right}, collisions={"contact": {"between": ["left", "right"]}})
    stepper = NumpyStepper(model, state)
    stepper.advance(200)
    velocity: Floats = stepper.state().velocity
    assert velocity[0, 1] != 0.0, "they have not met"
    assert (velocity[0] + velocity[1] == 0.0).all()
