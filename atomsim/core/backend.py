"""Which backend computes a run: the reference always, another where it is installed, works and is worth its start.

Whatever is chosen, a run has the same bits, so the choice only ever shows in its time. What a backend needs is imported
when it is chosen, and not before.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

from atomsim import arguments
from atomsim.core.backend_table import BACKENDS, NAMES, BackendKind
from atomsim.core.model import Floats, Model, State
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

MAX_THREADS = 256

ATOMS_PER_THREAD = 5000
"""Threads that share fewer atoms than that lose more time meeting after every round than they save."""


@dataclass(frozen=True, slots=True)
class Backend:
    """What computes a run.

    Attributes:
        name: that of its kind.
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
        name: `auto`, or the name of a backend.
        threads: how many threads to use; None for as many as are worth it.
        model: the compiled scene.
        rounds_ahead: iteration rounds that are going to be computed.

    Raises:
        InputError: an unknown name, an impossible number of threads, or what is asked for is missing or broken.
    """
    arguments.choice("backend", name, NAMES)
    if threads is not None:
        threads = arguments.whole("threads", threads, most=MAX_THREADS)
    if name == "auto":
        return _best(threads, model, rounds_ahead)
    (kind,) = (kind for kind in BACKENDS if kind.name == name)
    return _as_asked_for(kind, threads, model)


def _as_asked_for(kind: BackendKind, threads: int | None, model: Model) -> Backend:
    if threads is not None and threads > 1 and not kind.has_threads:
        other = next(other for other in BACKENDS if other.has_threads)
        raise InputError(f"the {kind.title} backend has one thread; several need {other.title}: {_install(other)}")
    if not _is_installed(kind):
        raise InputError(f"the {kind.title} backend needs {kind.title}; install it with: {_install(kind)}")
    try:
        return _started(kind, threads, model, "as asked for")
    except Exception as error:
        raise InputError(
            f"{kind.title} is installed but does not work here: {_first_line(error)}{_settings(kind)}; "
            f"install it anew with: {_install(kind, '--force-reinstall ')}",
            Remedy("numpy"),
        ) from error


def _best(threads: int | None, model: Model, rounds_ahead: int) -> Backend:
    """Use what is done first; that something is missing or fails is never an error."""
    reference, *others = BACKENDS
    n_bonds = sum(table.first.size for table in model.bonds)
    n_colliding = involved_atoms(model.collisions, model.n_atoms).size

    def seconds(kind: BackendKind, *, is_kept: bool = True) -> float:
        return kind.cost.of(rounds_ahead, n_bonds, n_colliding, is_kept=is_kept)

    reason = "the run is short"
    for kind in sorted(others, key=seconds):
        if seconds(kind) > seconds(reference):
            break
        if not _is_installed(kind):
            reason = f"{_install(kind)} makes it several times faster"
        elif seconds(kind, is_kept=_has_kernels(kind)) > seconds(reference):
            reason = f"the run is too short to compile {kind.title} kernels for"
        else:
            try:
                return _started(kind, threads, model, "the run is long")
            except Exception as error:
                reason = f"{kind.title} does not work here: {_first_line(error)}"
    return _started(reference, None, model, reason)


def _started(kind: BackendKind, threads: int | None, model: Model, reason: str) -> Backend:
    """Load a backend and prove it; raises whatever a broken installation raises."""
    make = _maker(kind)
    if kind is not BACKENDS[0]:
        _prove(kind, make)
    if not kind.has_threads:
        return Backend(kind.name, 1, reason, make)
    threads = threads or max(1, min(_n_cores(), model.n_atoms // ATOMS_PER_THREAD))
    return Backend(kind.name, threads, reason, partial(make, threads=threads))


def _maker(kind: BackendKind) -> Any:
    """Return the class of a backend's stepper."""
    module, name = kind.stepper
    return getattr(importlib.import_module(module), name)


def _prove(kind: BackendKind, make_stepper: MakeStepper) -> None:
    from atomsim.core.proof import prove

    try:
        prove(make_stepper)
    except Exception:  # perhaps only what was kept of the kernels is damaged
        if kind.keeper is None:
            raise
        importlib.import_module(kind.keeper).clear()
        prove(make_stepper)


def _has_kernels(kind: BackendKind) -> bool:
    return kind.keeper is None or bool(importlib.import_module(kind.keeper).has_kernels())


def _is_installed(kind: BackendKind) -> bool:
    return kind.package is None or importlib.util.find_spec(kind.package) is not None


def _install(kind: BackendKind, options: str = "") -> str:
    """Return what to type to have what a backend needs."""
    return f"pip install {options}'atomsim[{kind.extra}]'"


def _settings(kind: BackendKind) -> str:
    """Name what in the environment may keep a backend from working."""
    names = sorted(name for name in os.environ if name.startswith(f"{kind.name.upper()}_"))
    return f" ({', '.join(names)} in the environment)" if names else ""


def _n_cores() -> int:
    """Return how many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not every system can tell
        return os.cpu_count() or 1


def _first_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__
