"""The compiled stepper as a stepper: copies, threads, calls, numbers that leave the finite."""

from __future__ import annotations

import numpy as np
import pytest
from support.everything import EVERYTHING
from support.running import after, compiled, digest_of, is_finite

from atomsim.core.model import State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.simulate import simulate
from atomsim.errors import BlowUpError

pytest.importorskip("numba", reason="the backend is an extra")

from atomsim.core.numba_backend import stepper
from atomsim.core.numba_backend.near_kernels import find_near, sort_into_buckets
from atomsim.core.numba_backend.round_kernels import advance_rounds
from atomsim.core.numba_backend.stepper import NumbaStepper
from atomsim.core.plans import force_plan


def test_how_rounds_are_cut_into_calls_never_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    model, state = compiled(**EVERYTHING)
    digest = digest_of(after(model, state, 50))
    monkeypatch.setattr(force_plan, "AHEAD", 7)
    monkeypatch.setattr(stepper, "CALL_ATOM_ROUNDS", 3 * model.n_atoms)
    one_by_one, by_fives, at_once = (NumbaStepper(model, state) for _ in range(3))
    for _ in range(50):
        one_by_one.advance(1)
    for _ in range(10):
        by_fives.advance(5)
        by_fives.advance(0)
    at_once.advance(50)
    assert {digest_of(each.state()) for each in (one_by_one, by_fives, at_once)} == {digest}


def test_it_goes_on_from_any_round() -> None:
    model, state = compiled(**EVERYTHING)
    half_way = NumbaStepper(model, state)
    half_way.advance(21)
    rest = NumbaStepper(model, half_way.state(), threads=2)
    rest.advance(19)
    assert rest.state().round_index == 40
    assert digest_of(rest.state()) == digest_of(after(model, state, 40))


def test_a_state_is_a_copy() -> None:
    model, state = compiled({"pair": {"shape": "string", "count": 2, "step": [1, 0, 0]}})
    moving = NumbaStepper(model, State(0, state.position, np.ones((2, 3))))
    first = moving.state()
    moving.advance(1)
    assert first.position.tolist() == state.position.tolist()
    assert moving.state().position.tolist() != state.position.tolist()


def test_more_threads_than_atoms() -> None:
    groups = {"pair": {"shape": "string", "count": 2, "step": [1.5, 0, 0]}}
    model, state = compiled(groups, collisions={"c": {"within": "pair"}})
    many = NumbaStepper(model, state, threads=5)
    many.advance(10)
    assert digest_of(many.state()) == digest_of(after(model, state, 10))


@pytest.mark.parametrize("threads", [1, 2])
def test_nan_stays_in_the_state(threads: int) -> None:
    groups = {"string": {"shape": "string", "count": 100, "step": [0.9, 0, 0]}}
    bonds = {"b": {"within": "string", "rule": "neighbour"}}
    model, state = compiled(groups, bonds=bonds, collisions={"c": {"within": "string"}})
    position = state.position.copy()
    position[50] = np.nan
    lost = NumbaStepper(model, State(0, position, state.velocity), threads)
    lost.advance(100)
    assert not np.isfinite(lost.state().position[50]).any()
    assert not np.isfinite(lost.state().velocity[49:52]).any()


def test_a_blow_up_is_found_in_the_same_round_and_atom() -> None:
    groups = {"rod": {"shape": "string", "count": 30, "step": [0.1, 0, 0], "velocity": [0, 1, 0]}}
    bonds = {"b": {"within": "rod", "rule": "all-pairs", "rest": 3}}
    model, state = compiled(groups, time_step=1e3, bonds=bonds, collisions={"c": {"within": "rod"}})
    messages = []
    for make_stepper in (NumpyStepper, NumbaStepper):
        with pytest.raises(BlowUpError) as caught:
            list(simulate(model, state, 10**4, 500, make_stepper))
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


def test_every_model_uses_the_same_machine_code() -> None:
    for sections in (EVERYTHING, {"groups": {"one": {"shape": "atoms", "positions": [[0, 0, 0]]}}}):
        model, state = compiled(**sections)
        for threads in (1, 2):
            single = NumbaStepper(model, state, threads)
            single.advance(2)
            assert is_finite(single.state())
    for kernel in (advance_rounds, find_near, sort_into_buckets):
        assert len(kernel.signatures) == 1  # type: ignore[attr-defined]
