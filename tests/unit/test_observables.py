"""What is measured of a state, against sums by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.running import atoms_at, compiled

from atomsim.core import observables
from atomsim.core.model import State
from atomsim.core.numpy_backend.bonds import joined
from atomsim.core.observables import Observer


def potential(distance: float, rest: float) -> float:
    """U(d) = (d² − r²)/2 − r² ln(d/r)."""
    return (distance**2 - rest**2) / 2 - (rest**2 * math.log(distance / rest) if rest else 0.0)


def test_energies_momenta_and_contacts() -> None:
    model, state = compiled(
        {"a": atoms_at((0, 0, 0), (3, 0, 0), (0, 1.5, 0)), "b": atoms_at((0, 0, 1.9), velocity=[0, 1, -2])},
        time_step=0.1,
        bonds={
            "set": {"between": ["a[0]", "a[1]"], "rule": "all-pairs", "rest": 2},
            "none": {"within": "a", "rule": "pairs", "pairs": [[0, 2]], "rest": 0},
            "initial": {"within": "a", "rule": "all-pairs"},
        },
        collisions={"c": {"within": "all"}, "again": {"between": ["a[0]", "b"]}},
    )
    seen = Observer(model).observe(state)
    assert seen.kinetic_energy == 2.5
    assert seen.potential_energy_bonds == pytest.approx((potential(3, 2) + 1.5**2 / 2) / 0.1)
    assert seen.potential_energy_collisions == pytest.approx((potential(1.5, 2) + 2 * potential(1.9, 2)) / 0.1)
    assert seen.contacts == 3
    assert seen.momentum.tolist() == [0, 1, -2]
    assert seen.angular_momentum.tolist() == [-1.9, 0, 0]


def test_the_force_is_the_slope_of_the_potential() -> None:
    """One round from rest gives a bound pair the velocity −dU/dd each; so the energies belong to the forces."""
    for rest in (0.0, 1.2, 5.0):
        bond = {"within": "a", "rule": "all-pairs", "rest": rest}
        model, _ = compiled({"a": atoms_at((0, 0, 0), (2.5, 0, 0))}, time_step=1.0, bonds={"b": bond})
        observer = Observer(model)

        def energy(distance: float, observer: Observer = observer) -> float:
            position = np.array([[0.0, 0, 0], [distance, 0, 0]])
            return observer.observe(State(0, position, np.zeros((2, 3)))).potential_energy_bonds

        slope = (energy(2.5 + 1e-6) - energy(2.5 - 1e-6)) / 2e-6
        assert slope == pytest.approx(2.5 * (1 - rest**2 / 2.5**2), rel=1e-8)


@pytest.mark.parametrize("block", [1, 7, 1000])
def test_energies_have_the_bits_of_one_sum_over_all_pairs(monkeypatch: pytest.MonkeyPatch, block: int) -> None:
    """How many pairs are looked at together shows in no bit; where the rest is zero, there is no logarithm."""
    monkeypatch.setattr(observables, "BLOCK", block)
    position = np.random.default_rng(1).normal(scale=2.0, size=(12, 3))
    model, _ = compiled(
        {"a": atoms_at(*position.round(1).tolist())},
        time_step=0.3,
        bonds={
            "some": {"within": "a", "rule": "distance-threshold", "threshold": 3},
            "none": {"within": "a", "rule": "pairs", "pairs": [[0, 11]], "rest": 0},
        },
        collisions={"c": {"within": "a"}},
    )
    expected = 0.0
    for table in joined(model.bonds):
        squared = ((position[table.second] - position[table.first]) ** 2).T
        squared = (squared[0] + squared[1]) + squared[2]
        rest = table.rest_squared
        logarithm = rest * np.log(squared / np.where(rest == 0, 1, rest))
        expected += float(((squared - rest - logarithm) * 0.5).sum())
    first, second = np.triu_indices(12, 1)
    apart = ((position[second] - position[first]) ** 2).sum(axis=1)
    seen = Observer(model).observe(State(0, position, np.zeros((12, 3))))
    assert seen.potential_energy_bonds == expected / 0.3
    assert seen.contacts == (apart < 4).sum() > 0


def test_an_observer_follows_atoms_that_come_near() -> None:
    model, state = compiled({"a": atoms_at((0, 0, 0), (50, 0, 0))}, collisions={"c": {"within": "a"}})
    observer = Observer(model)
    for place, contacts in [(50.0, 0), (1.0, 1), (2.0, 0), (1.9999, 1), (-1.0, 1), (9.0, 0)]:
        position = np.array([[0.0, 0, 0], [place, 0, 0]])
        assert observer.observe(State(0, position, state.velocity)).contacts == contacts


def test_states_near_a_blow_up_are_measured_in_silence() -> None:
    """Finite numbers whose squares are not: warnings are errors here."""
    model, _ = compiled(
        {"a": atoms_at((0, 0, 0), (1, 0, 0))},
        bonds={"b": {"within": "a", "rule": "all-pairs"}},
        collisions={"c": {"within": "a"}},
    )
    position = np.array([[1e200, 0, 0], [-1e200, 1, 0]])
    assert Observer(model).observe(State(0, position, position)).kinetic_energy == math.inf
