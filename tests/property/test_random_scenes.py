"""Random scenes: however a run is computed and cut, its bits are those of the loop oracle."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

from hypothesis import assume, given, reject, settings
from hypothesis import strategies as st
from support.oracle import build
from support.running import after, digest_of, is_finite, without_mistakes
from support.strategies import scenes

from atomsim.core.model import Model, State
from atomsim.core.numpy_backend import bonds
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.pairs import near_list
from atomsim.core.simulate import simulate
from atomsim.errors import BlowUpError

ROUNDS = 12

FORMS = {
    "dense": {"DENSE_FILL": 0.0, "FEW_PAIRS": 0},
    "offset": {"DENSE_FILL": 2.0, "FEW_PAIRS": 0, "RUN_PAIRS": 0},
    "offset, no gaps": {"DENSE_FILL": 2.0, "FEW_PAIRS": 0, "RUN_PAIRS": 0, "RUN_GAP": 1},
    "general": {"DENSE_FILL": 2.0, "FEW_PAIRS": 0, "RUN_PAIRS": 10**9},
}
"""Thresholds that leave one form of bonds only."""


def finite_run(data: dict[str, Any]) -> tuple[Model, State, str]:
    """Compile random data; return the digest they come to, too, unless they blow up."""
    _, model, state = without_mistakes(data)
    last = after(model, state, ROUNDS)
    assume(is_finite(last))
    return model, state, digest_of(last)


@given(scenes())
@settings(max_examples=3 * settings().max_examples)
def test_stepper_is_the_oracle(data: dict[str, Any]) -> None:
    scene, model, state = without_mistakes(data)
    world = build(scene.model_dump())
    assert digest_of(state) == world.digest()
    stepper = NumpyStepper(model, state)
    for _ in range(ROUNDS):
        stepper.advance(1)
        world.advance(1)
        assert is_finite(stepper.state()) == world.is_finite()
        if not world.is_finite():
            return
        assert digest_of(stepper.state()) == world.digest(), f"differs at round {world.round_index}"


@given(scenes())
def test_every_form_of_bonds_gives_the_same_bits(data: dict[str, Any]) -> None:
    model, state, digest = finite_run(data)
    for thresholds in FORMS.values():
        with patch.multiple(bonds, **thresholds):
            assert digest_of(after(model, state, ROUNDS)) == digest


@given(scenes(), st.sampled_from([0.0, 0.01, 0.3, 2.0]), st.booleans())
def test_the_skin_never_shows(data: dict[str, Any], skin: float, counts_as_many: bool) -> None:
    model, state, digest = finite_run(data)
    stepper = NumpyStepper(model, state)
    with patch.object(near_list, "MANY_ATOMS", 0 if counts_as_many else 10**9):
        stepper._near = near_list.NearList(model.collisions, model.n_atoms, skin)
    stepper.advance(ROUNDS)
    assert digest_of(stepper.state()) == digest


@given(scenes(), st.sampled_from([1, 3, 7]))
def test_how_a_run_is_cut_never_shows(data: dict[str, Any], record_every: int) -> None:
    model, state, digest = finite_run(data)
    try:
        frames = list(simulate(model, state, ROUNDS, record_every))
    except BlowUpError:
        reject()
    assert [frame.round_index for frame in frames] == [*range(0, ROUNDS, record_every), ROUNDS]
    assert frames[-1].digest == digest
    for frame in frames:
        *_, last = simulate(model, frame.state, ROUNDS, record_every=100)
        assert last.digest == digest
