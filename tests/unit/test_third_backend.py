"""A third backend is a stepper and a row of the table: asked for, chosen where it is faster, proved before use."""

from __future__ import annotations

import numpy as np
import pytest
from support.running import compiled

from atomsim.core import backend as backends
from atomsim.core.backend import choose
from atomsim.core.backend_table import BACKENDS, NAMES, BackendKind, Cost
from atomsim.core.model import State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.proof import prove
from atomsim.errors import InputError

MODEL, STATE = compiled({"pair": {"shape": "string", "count": 2, "step": [1, 0, 0]}})


class ToyStepper(NumpyStepper):
    """A backend that is right."""


class LateStepper(NumpyStepper):
    """A backend that forgets the forces from outside."""

    def set_forces(self, impulse: object) -> None:
        """Do nothing."""


class RoughStepper(NumpyStepper):
    """A backend that is off by one bit."""

    def state(self) -> State:
        """Return the state, nearly."""
        state = super().state()
        state.velocity[7, 1] = np.nextafter(state.velocity[7, 1], 1.0)
        return state


class IdleStepper(NumpyStepper):
    """A backend that computes nothing."""

    def advance(self, n_rounds: int) -> None:
        """Stay."""


def row(stepper: type[NumpyStepper], **changes: object) -> BackendKind:
    cost = Cost(load=0.1, compile=0.1, round=1e-7, bond=1e-10, colliding_atom=1e-9, crowded_atom=1e-9)
    return BackendKind("toy", "Toy", (__name__, stepper.__name__), cost, **changes)  # type: ignore[arg-type]


def with_row(monkeypatch: pytest.MonkeyPatch, kind: BackendKind, stepper: type[NumpyStepper]) -> None:
    monkeypatch.setattr(backends, "BACKENDS", (*BACKENDS, kind))
    monkeypatch.setattr(backends, "NAMES", (*NAMES, kind.name))
    maker = backends._maker
    monkeypatch.setattr(backends, "_maker", lambda each: stepper if each is kind else maker(each))


def test_it_is_used_when_asked_for_and_where_it_is_faster(monkeypatch: pytest.MonkeyPatch) -> None:
    with_row(monkeypatch, row(ToyStepper), ToyStepper)
    assert str(choose("toy", None, MODEL, 10)) == "toy, 1 thread (as asked for)"
    assert isinstance(choose("toy", None, MODEL, 10).make_stepper(MODEL, STATE), ToyStepper)
    assert str(choose("auto", None, MODEL, 10**6)) == "toy, 1 thread (the run is long)"
    assert choose("auto", None, MODEL, 10).name == "numpy"


def test_it_has_one_thread_unless_it_says_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    with_row(monkeypatch, row(ToyStepper), ToyStepper)
    with pytest.raises(InputError, match="the Toy backend has one thread; several need Numba: pip install"):
        choose("toy", 2, MODEL, 10)


def test_what_it_needs_is_named_with_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    with_row(monkeypatch, row(ToyStepper, package="no_such_package", extra="toys"), ToyStepper)
    with pytest.raises(InputError) as caught:
        choose("toy", None, MODEL, 10)
    assert str(caught.value) == "the Toy backend needs Toy; install it with: pip install 'atomsim[toys]'"
    monkeypatch.setattr(backends, "_is_installed", lambda kind: kind.package is None)
    reasons = {choose("auto", None, MODEL, rounds).reason for rounds in (10**6, 10**9)}
    assert all(reason.startswith("pip install 'atomsim[") for reason in reasons)


@pytest.mark.parametrize("stepper", [LateStepper, RoughStepper, IdleStepper])
def test_a_backend_of_other_bits_is_not_used(monkeypatch: pytest.MonkeyPatch, stepper: type[NumpyStepper]) -> None:
    with pytest.raises(ArithmeticError, match="not that of NumPy"):
        prove(stepper)
    with_row(monkeypatch, row(stepper), stepper)
    with pytest.raises(
        InputError, match="Toy is installed but does not work here: its arithmetic is not that of NumPy"
    ):
        choose("toy", None, MODEL, 10)
    monkeypatch.setattr(backends, "_is_installed", lambda kind: kind.package is None)
    assert choose("auto", None, MODEL, 10**5).name == "numpy"


def test_the_proof_can_succeed() -> None:
    prove(ToyStepper)


@pytest.mark.parametrize("kind", BACKENDS, ids=[kind.name for kind in BACKENDS])
def test_every_row_leads_to_what_it_names(kind: BackendKind) -> None:
    if kind.package is not None:
        pytest.importorskip(kind.package, reason="the backend is an extra")
    module, name = kind.stepper
    made = getattr(__import__(module, fromlist=[name]), name)(MODEL, STATE)
    made.advance(1)
    assert made.state().round_index == 1


def test_more_takes_longer() -> None:
    """Where nothing has to start, more rounds of more bonds take longer."""
    cost = BACKENDS[0].cost
    assert cost.of(0, 10, 10) == 0.0
    assert cost.of(10, 10, 10) < cost.of(10, 20, 10) < cost.of(10, 20, 30)
    assert cost.of(1, 0, 30_000) > 2 * cost.of(1, 0, 15_000)
