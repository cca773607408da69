"""Which backend computes a run: NumPy always, Numba where it is installed, works and is worth its start.

Whatever is chosen, a run has the same bits, so the choice only ever shows in its time. Numba is imported when it is
chosen, and not before.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Protocol

from atomsim import arguments
from atomsim.core.model import Floats, Model, State
from atomsim.core.numba_backend import cache
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.errors import InputError, Remedy


class Stepper(Protocol):
    """What a backend does: it advances one state of one model, always to the same bits."""

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""

    def set_forces(self, impulse: Floats | None) -> None:
        """Add an impulse to each atom in every round to come, (n_atoms, 3); None for nothing. It is copied."""

    def state(self) -> State:
        """Return a copy of the present state."""


MakeStepper = Callable[[Model, State], Stepper]

BACKENDS = ("auto", "numpy", "numba")

MAX_THREADS = 256

ATOMS_PER_THREAD = 5000
"""Threads that share fewer atoms than that lose more time meeting after every round than they save."""

ROUND_SECONDS, BOND_SECONDS, COLLIDING_ATOM_SECONDS = 3e-5, 7e-9, 1e-7
"""What a round costs the NumPy stepper, about: at all, per bond, per atom that may collide."""

CROWD, CROWDED_ATOM_SECONDS = 20_000, 3e-7
"""From so many atoms on that may collide, the cache does not hold them, and each takes longer."""

SAVED = 0.8
"""The part of this that Numba saves."""

LOAD_SECONDS, COMPILE_SECONDS = 0.8, 12.0
"""What it takes to start Numba with kernels that are kept, and without."""


@dataclass(frozen=True, slots=True)
class Backend:
    """What computes a run.

    Attributes:
        name: `numpy` or `numba`.
        threads: how many threads share the atoms.
        reason: why this one, for the run's summary.
        make_stepper: makes its stepper.
    """

    name: str
    threads: int
    reason: str
    make_stepper: MakeStepper

    def __str__(self) -> str:
        threads = "1 thread" if self.threads == 1 else f"{self.threads} threads"
        return f"{self.name}, {threads} ({self.reason})"


def choose(name: str, threads: int | None, model: Model, rounds_ahead: int) -> Backend:
    """Choose what computes a run.

    Args:
        name: `auto`, `numpy` or `numba`.
        threads: how many threads to use; None for as many as are worth it.
        model: the compiled scene.
        rounds_ahead: iteration rounds that are going to be computed.

    Raises:
        InputError: an unknown name, an impossible number of threads, or Numba is asked for and missing or broken.
    """
    arguments.choice("backend", name, BACKENDS)
    if threads is not None:
        threads = arguments.whole("threads", threads, most=MAX_THREADS)
    if name == "numpy":
        if threads is not None and threads > 1:
            raise InputError("the NumPy backend has one thread; several need Numba: pip install 'atomsim[fast]'")
        return _numpy("as asked for")
    if name == "numba":
        return _numba_as_asked_for(threads, model)
    return _best(threads, model, rounds_ahead)


def _numpy(reason: str) -> Backend:
    return Backend("numpy", 1, reason, NumpyStepper)


def _numba(threads: int | None, model: Model, reason: str) -> Backend:
    """Start Numba; raises whatever a broken installation raises."""
    from atomsim.core.numba_backend.proof import prove
    from atomsim.core.numba_backend.stepper import NumbaStepper

    try:
        prove()
    except Exception:  # perhaps only what was kept of the kernels is damaged
        cache.clear()
        prove()
    threads = threads or max(1, min(_n_cores(), model.n_atoms // ATOMS_PER_THREAD))
    return Backend("numba", threads, reason, partial(NumbaStepper, threads=threads))


def _numba_as_asked_for(threads: int | None, model: Model) -> Backend:
    if not _is_installed():
        raise InputError("the Numba backend needs Numba; install it with: pip install 'atomsim[fast]'")
    try:
        return _numba(threads, model, "as asked for")
    except Exception as error:
        raise InputError(
            f"Numba is installed but does not work here: {_first_line(error)}{_settings()}; "
            "install it anew with: pip install --force-reinstall 'atomsim[fast]'",
            Remedy("numpy"),
        ) from error


def _settings() -> str:
    """Name what in the environment may keep Numba from working."""
    names = sorted(name for name in os.environ if name.startswith("NUMBA_"))
    return f" ({', '.join(names)} in the environment)" if names else ""


def _best(threads: int | None, model: Model, rounds_ahead: int) -> Backend:
    """Use Numba where it pays; its absence or its failure is never an error."""
    saved = SAVED * rounds_ahead * _numpy_seconds(model)
    if saved < LOAD_SECONDS:
        return _numpy("the run is short")
    if not _is_installed():
        return _numpy("pip install 'atomsim[fast]' makes it several times faster")
    if saved < COMPILE_SECONDS and not cache.has_kernels():
        return _numpy("the run is too short to compile Numba kernels for")
    try:
        return _numba(threads, model, "the run is long")
    except Exception as error:
        return _numpy(f"Numba does not work here: {_first_line(error)}")


def _is_installed() -> bool:
    return importlib.util.find_spec("numba") is not None


def _numpy_seconds(model: Model) -> float:
    """Estimate what a round takes the NumPy stepper."""
    n_bonds = sum(table.first.size for table in model.bonds)
    n_colliding = involved_atoms(model.collisions, model.n_atoms).size
    per_atom = COLLIDING_ATOM_SECONDS if n_colliding < CROWD else CROWDED_ATOM_SECONDS
    return ROUND_SECONDS + BOND_SECONDS * n_bonds + per_atom * n_colliding


def _n_cores() -> int:
    """Return how many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not every system can tell
        return os.cpu_count() or 1


def _first_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__
