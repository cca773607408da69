"""Two atoms, for which the paper's laws can be solved by hand; convergence and energy of a few more."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from support.running import after, atoms_at, compiled

from atomsim.core.model import Floats, Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.observables import Observer

REST = 3.0


def bound_pair(time_step: float, stretch: float) -> tuple[Model, State]:
    """Two atoms bound at a desired distance, at rest a little further apart."""
    half = (REST + stretch) / 2
    bond = {"within": "pair", "rule": "all-pairs", "rest": REST}
    return compiled({"pair": atoms_at((-half, 0, 0), (half, 0, 0))}, time_step, bonds={"bond": bond})


def stretches(time_step: float, stretch: float, n_rounds: int) -> Floats:
    """Return how much further apart than desired the pair is in every round."""
    stepper = NumpyStepper(*bound_pair(time_step, stretch))
    found = []
    for _ in range(n_rounds):
        position = stepper.state().position
        found.append(position[1, 0] - position[0, 0] - REST)
        stepper.advance(1)
    return np.array(found)


@pytest.mark.parametrize("time_step", [0.001, 0.05, 0.3, 0.7])
def test_a_bound_pair_swings_as_calculated(time_step: float) -> None:
    """Stiffness 2 for each atom: the stretch s gains −4s per round in speed, so s(n+1) − 2s(n) + s(n−1) = −4τ s(n).

    The solution that starts at rest is s(n) = a · cos(ω(n + ½)) / cos(ω/2) with cos ω = 1 − 2τ.
    """
    a = 1e-6
    omega = math.acos(1.0 - 2.0 * time_step)
    expected = a * np.cos(omega * (np.arange(500) + 0.5)) / math.cos(omega / 2)
    assert np.abs(stretches(time_step, a, 500) - expected).max() < 2e-5 * a  # the neglected terms are of order a/r


def test_a_bound_pair_is_stable_below_one_and_unstable_above() -> None:
    """τ · λmax < 4 with λmax = 4: below, |s| ≤ a/√(1 − τ); above, it grows by the root of μ² + (4τ − 2)μ + 1."""
    a = 1e-9
    below = np.abs(stretches(0.99, a, 400))
    assert below.max() <= 1.01 * a / math.sqrt(1 - 0.99)
    above = np.abs(stretches(1.01, a, 30))
    growth = 1.02 + math.sqrt(1.02**2 - 1)
    assert above[-1] / above[-2] == pytest.approx(growth, rel=1e-3)


def head_on(time_step: float) -> tuple[float, float]:
    """Let a moving ball meet one at rest, head on; return both speeds afterwards, in units of the first."""
    groups = {"moving": atoms_at((-1.3, 0, 0), velocity=[0.5, 0, 0]), "resting": atoms_at((1.3, 0, 0))}
    model, state = compiled(groups, time_step, collisions={"contact": {"between": ["moving", "resting"]}})
    end = after(model, state, round(4 / time_step))
    assert end.position[1, 0] - end.position[0, 0] > 2.0, "still in contact"
    assert (end.velocity[:, 1:] == 0.0).all()
    return end.velocity[0, 0] / 0.5, end.velocity[1, 0] / 0.5


def test_equal_balls_exchange_their_velocities() -> None:
    """The collision is elastic as τ → 0: what is missing shrinks as fast as τ."""
    for time_step in (0.04, 0.01, 0.0025, 0.000625):
        first, second = head_on(time_step)
        assert first + second == pytest.approx(1.0, abs=1e-13)
        assert abs(first) < 0.25 * time_step
        assert abs(first * first + second * second - 1.0) < 0.5 * time_step


def test_a_ball_on_a_held_wall_bounces_back() -> None:
    groups = {"wall": atoms_at((0, 0, 0)), "ball": atoms_at((3, 0, 0), velocity=[-0.5, 0, 0])}
    model, state = compiled(
        groups,
        0.001,
        collisions={"contact": {"between": ["wall", "ball"]}},
        forces={"wall": {"kind": "hold", "acts_on": "wall"}},
    )
    end = after(model, state, 6000)
    assert end.velocity[1, 0] == pytest.approx(0.5, rel=1e-3)
    assert (end.position[0] == 0.0).all()


def tumbling(h: float) -> tuple[Model, State]:
    """Four bound atoms far from rest, with the time step h² and velocities scaled by 1/h.

    The impulse is not multiplied by τ. With h = √τ and u = h·v the paper's scheme reads u ← u + h·F(c), c ← c + h·u:
    symplectic Euler with the step h for the same problem (c, u) at every h.
    """
    places = atoms_at((0, 0, 0), (1.2, 0.1, 0), (2.0, 1.1, 0.3), (0.4, 1.3, 0.8))
    bond = {"within": "four", "rule": "all-pairs", "rest": 1.3}
    model, state = compiled({"four": places}, h * h, bonds={"bond": bond})
    u = np.array([[0.2, 0, 0], [0, 0.3, 0], [-0.1, 0, 0.2], [-0.1, -0.3, -0.2]])
    return model, State(0, state.position, u / h)


def tumbled(h: float) -> Floats:
    """Return c and u at the time 2."""
    end = after(*tumbling(h), round(2.0 / h))
    return np.concatenate((end.position, end.velocity * h))


def test_trajectories_converge_in_first_order() -> None:
    """Halving h = √τ (a quarter of τ, velocities doubled) halves the error at a fixed time."""
    reference = tumbled(2.0**-13)
    errors = [float(np.abs(tumbled(2.0**-k) - reference).max()) for k in (4, 5, 6, 7)]
    for coarse, fine in pairwise(errors):
        assert 1.85 < coarse / fine < 2.15


def energies(model: Model, state: State, n_rounds: int) -> Floats:
    """Return the energy of every round."""
    stepper, observer = NumpyStepper(model, state), Observer(model)
    found = []
    for _ in range(n_rounds):
        seen = observer.observe(stepper.state())
        found.append(seen.kinetic_energy + seen.potential_energy_bonds + seen.potential_energy_collisions)
        stepper.advance(1)
    return np.array(found)


def test_energy_swings_in_first_order() -> None:
    """Relative to itself the energy swings by an amount that halves with h = √τ."""
    swings = []
    for k in (4, 5, 6, 7):
        energy = energies(*tumbling(2.0**-k), 8 * 2**k)
        swings.append(float(np.ptp(energy) / energy[0]))
    for coarse, fine in pairwise(swings):
        assert 1.85 < coarse / fine < 2.2


def test_energy_stays_bounded_for_long() -> None:
    """A symplectic scheme: after 20 000 rounds the energy swings about the same mean as at the start."""
    model, state = tumbling(1 / 16)
    early = energies(model, state, 2000)
    late = energies(model, after(model, state, 18_000), 2000)
    assert late.mean() == pytest.approx(early.mean(), rel=0.02)
    assert np.ptp(late) < 1.2 * np.ptp(early)


def test_energy_grows_when_the_step_is_too_large() -> None:
    """Four atoms bound to each other have λmax = 8 (all distances grow together), so τ = 0.6 is beyond the limit."""
    energy = energies(*tumbling(math.sqrt(0.6)), 50)
    assert energy[3:].min() > 50 * energy[0]
