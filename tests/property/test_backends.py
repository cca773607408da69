"""Whatever computes a run, in how many threads, by which forms of tables and lists, its bits are those of NumPy."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.everything import EVERYTHING
from support.running import PAPER_SCENES, after, compiled, digest_of, is_finite, paper_scene, without_mistakes
from support.strategies import scenes

from atomsim.compiler import compile_scene
from atomsim.core.model import Model, State
from atomsim.scene import LoadedScene

pytest.importorskip("numba", reason="the backend is an extra")

from atomsim.core.numba_backend.stepper import NumbaStepper
from atomsim.core.plans import bond_plan, near_plan

THREADS = [1, 2, 3]

FORMS = {"as is best": bond_plan.PASS_ENTRIES, "tiles": 0, "rows": 10**9}
"""How dear a tile is thought to be."""


def run(model: Model, state: State, n_rounds: int, **how: Any) -> State:
    """Return the state so many rounds later, as Numba computes it."""
    stepper = NumbaStepper(model, state, **how)
    stepper.advance(n_rounds)
    return stepper.state()


def fluid(n_side: int, spacing: float) -> tuple[Model, State]:
    """Return a cube of colliding atoms in random motion."""
    groups = {"fluid": {"shape": "block", "counts": [n_side] * 3, "spacing": spacing}}
    model, state = compiled(groups, collisions={"contact": {"within": "fluid"}})
    velocity = np.random.default_rng(1).uniform(-1, 1, (n_side**3, 3))
    return model, State(0, state.position, velocity)


@pytest.mark.parametrize("name", PAPER_SCENES)
def test_scenes_of_the_paper(name: str) -> None:
    model, state = compile_scene(LoadedScene(paper_scene(name)))
    digest = digest_of(after(model, state, 400))
    for threads in THREADS:
        assert digest_of(run(model, state, 400, threads=threads)) == digest


@pytest.mark.parametrize("threads", THREADS)
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("few", [0, near_plan.FEW, 10**9])
def test_a_scene_of_everything(threads: int, form: str, few: int) -> None:
    model, state = compiled(**EVERYTHING)
    with patch.object(bond_plan, "PASS_ENTRIES", FORMS[form]), patch.object(near_plan, "FEW", few):
        assert digest_of(run(model, state, 60, threads=threads)) == digest_of(after(model, state, 60))


@pytest.mark.parametrize("threads", THREADS)
@pytest.mark.parametrize("spacing", [1.2, 2.1])
def test_a_fluid(threads: int, spacing: float) -> None:
    model, state = fluid(11, spacing)
    assert digest_of(run(model, state, 60, threads=threads)) == digest_of(after(model, state, 60))


@given(scenes(), st.sampled_from(THREADS), st.sampled_from([*FORMS.values()]), st.sampled_from([0.0, 0.3, 2.0]))
def test_random_scenes(data: dict[str, Any], threads: int, pass_entries: int, skin: float) -> None:
    _, model, state = without_mistakes(data)
    with patch.object(bond_plan, "PASS_ENTRIES", pass_entries), patch.object(near_plan, "FEW", 2):
        stepper = NumbaStepper(model, state, threads, skin)
    for n_rounds in (1, 4, 7):
        state = after(model, state, n_rounds)
        stepper.advance(n_rounds)
        assert is_finite(stepper.state()) == is_finite(state)
        if not is_finite(state):
            return
        assert digest_of(stepper.state()) == digest_of(state)
