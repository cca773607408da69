"""Which backend computes a run, and what is said of it."""

from __future__ import annotations

import pytest
from support.running import compiled

from atomsim.core import backend as backends
from atomsim.core.backend import MakeStepper, choose
from atomsim.core.backend_table import BackendKind
from atomsim.core.numba_backend import cache
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.errors import InputError, Remedy

MODEL, STATE = compiled({"pair": {"shape": "string", "count": 2, "step": [1, 0, 0]}})

LONG = 10**9


def missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pretend that Numba is not installed."""
    monkeypatch.setattr(backends, "_is_installed", lambda kind: kind.package is None)


def installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pretend that Numba is installed."""
    monkeypatch.setattr(backends, "_is_installed", lambda _: True)


def broken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pretend that Numba is installed for another NumPy."""

    def maker(kind: BackendKind) -> type[NumpyStepper]:
        if kind.package is not None:
            raise ImportError("Numba needs NumPy 1.9 or less\nmore about it")
        return NumpyStepper

    installed(monkeypatch)
    monkeypatch.setattr(backends, "_maker", maker)


def test_a_short_run_is_not_worth_a_start() -> None:
    backend = choose("auto", None, MODEL, 100)
    assert str(backend) == "numpy, 1 thread (the run is short)"
    assert isinstance(backend.make_stepper(MODEL, STATE), NumpyStepper)


def test_a_long_run_is() -> None:
    pytest.importorskip("numba", reason="the backend is an extra")
    backend = choose("auto", None, MODEL, LONG)
    assert str(backend) == "numba, 1 thread (the run is long)"
    stepper = backend.make_stepper(MODEL, STATE)
    stepper.advance(3)
    assert stepper.state().round_index == 3


def test_kernels_are_compiled_only_for_a_very_long_run(monkeypatch: pytest.MonkeyPatch) -> None:
    installed(monkeypatch)
    monkeypatch.setattr(cache, "has_kernels", lambda: False)
    backend = choose("auto", None, MODEL, 100_000)
    assert str(backend) == "numpy, 1 thread (the run is too short to compile Numba kernels for)"


def test_a_crowd_is_slower_than_its_atoms_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the cache does not hold them, half the rounds repay compiling that would otherwise."""
    installed(monkeypatch)
    monkeypatch.setattr(cache, "has_kernels", lambda: False)
    monkeypatch.setattr(backends, "_maker", lambda _: NumpyStepper)
    for n_atoms, rounds, name in ((19_000, 5000, "numpy"), (21_000, 5000, "numba"), (21_000, 1000, "numpy")):
        fluid = {"shape": "string", "count": n_atoms, "step": [3, 0, 0]}
        model, _ = compiled({"fluid": fluid}, collisions={"c": {"within": "fluid"}})
        assert choose("auto", None, model, rounds).name == name


def test_numba_as_asked_for() -> None:
    pytest.importorskip("numba", reason="the backend is an extra")
    assert str(choose("numba", 3, MODEL, 1)) == "numba, 3 threads (as asked for)"
    assert choose("numba", None, MODEL, 1).threads == 1


def test_many_atoms_are_shared_out(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba", reason="the backend is an extra")
    monkeypatch.setattr(backends, "_n_cores", lambda: 4)
    model, _ = compiled({"dust": {"shape": "string", "count": 15_000, "step": [3, 0, 0]}})
    assert choose("numba", None, model, 1).threads == 3
    monkeypatch.setattr(backends, "_n_cores", lambda: 2)
    assert choose("numba", None, model, 1).threads == 2


def test_without_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    missing(monkeypatch)
    backend = choose("auto", None, MODEL, LONG)
    assert str(backend) == "numpy, 1 thread (pip install 'atomsim[fast]' makes it several times faster)"
    with pytest.raises(InputError, match=r"needs Numba; install it with: pip install 'atomsim\[fast\]'"):
        choose("numba", None, MODEL, 1)


def test_a_broken_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    broken(monkeypatch)
    backend = choose("auto", None, MODEL, LONG)
    assert str(backend) == "numpy, 1 thread (Numba does not work here: Numba needs NumPy 1.9 or less)"
    with pytest.raises(InputError) as caught:
        choose("numba", None, MODEL, 1)
    assert str(caught.value) == (
        "Numba is installed but does not work here: Numba needs NumPy 1.9 or less; "
        "install it anew with: pip install --force-reinstall 'atomsim[fast]'"
    )
    assert caught.value.remedies == (Remedy("numpy"),)


def test_damaged_kernels_are_made_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba", reason="the backend is an extra")
    cleared = []

    def prove(_: MakeStepper) -> None:
        if not cleared:
            raise EOFError

    monkeypatch.setattr("atomsim.core.proof.prove", prove)
    monkeypatch.setattr(cache, "clear", lambda: cleared.append(True))
    assert choose("numba", None, MODEL, 1).name == "numba"
    assert cleared


@pytest.mark.parametrize(
    ("name", "threads", "message"),
    [
        ("cuda", None, "backend: needs auto, numpy or numba (got 'cuda')"),
        ("auto", 0, "threads: needs a whole number from 1 to 256 (got 0)"),
        ("numba", 257, "threads: needs a whole number from 1 to 256 (got 257)"),
        ("numpy", 2, "the NumPy backend has one thread; several need Numba: pip install 'atomsim[fast]'"),
    ],
)
def test_what_cannot_be_chosen(name: str, threads: int | None, message: str) -> None:
    with pytest.raises(InputError) as caught:
        choose(name, threads, MODEL, 1)
    assert str(caught.value) == message
