"""How the time of a round grows with the number of atoms of a free fluid; knows no other engine than ours."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from typing import NamedTuple

from atomsim.core.backend import MakeStepper
from atomsim.core.model import Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from benchmarks.fluid import free_fluid
from benchmarks.tables import MISSING, Answer, Table, below, significant
from benchmarks.timing import Results, in_turns, spread

NUMPY, ONE, TWO = "NumPy", "Numba, 1 thread", "Numba, 2 threads"


class Size(NamedTuple):
    """A fluid, and how it is timed: which rounds, and how often.

    Every pass goes over the same rounds, for a free fluid thins out. They hold several renewals of the list of near
    pairs, which cost most.
    """

    n_atoms: int
    warm_up: int
    n_rounds: int
    n_passes: int


SIZES = (Size(1000, 50, 100, 20), Size(10_000, 50, 100, 8), Size(100_000, 30, 60, 4), Size(1_000_000, 10, 25, 2))
QUICK_SIZES = (Size(1000, 50, 100, 2), Size(10_000, 20, 40, 2))


def measure(quick: bool) -> Results:
    """Time fluids in nanoseconds per atom and round."""
    return {"sizes": {str(size.n_atoms): _measure(size) for size in (QUICK_SIZES if quick else SIZES)}}


def _measure(size: Size) -> Results:
    model, state = free_fluid(size.n_atoms)
    makers = _makers()
    seconds: dict[str, list[float]] = {name: [] for name, make in makers.items() if make}
    for _ in range(size.n_passes):
        steppers = {name: make(model, state) for name, make in makers.items() if make}
        for stepper in steppers.values():
            stepper.advance(size.warm_up)
        turns = {name: partial(stepper.advance, size.n_rounds) for name, stepper in steppers.items()}
        for name, times in in_turns(turns, 1).items():
            seconds[name] += times
    unit = 1e-9 * size.n_atoms * size.n_rounds
    return {name: spread(seconds[name], unit) if name in seconds else None for name in makers}


def _makers() -> dict[str, MakeStepper | None]:
    if find_spec("numba") is None:
        return {NUMPY: NumpyStepper, ONE: None, TWO: None}
    from atomsim.core.numba_backend.stepper import NumbaStepper

    def two_threads(model: Model, state: State) -> NumbaStepper:
        return NumbaStepper(model, state, threads=2)

    return {NUMPY: NumpyStepper, ONE: NumbaStepper, TWO: two_threads}


def tables(results: Results) -> list[Table]:
    """Return a row for every size."""
    rows = [
        (f"{int(size):,}", *(significant(row[name]["median"]) if row[name] else MISSING for name in (NUMPY, ONE, TWO)))
        for size, row in results["sizes"].items()
    ]
    caption = "A free fluid, every atom of which may collide with every other: nanoseconds per atom and round (median):"
    return [Table(caption, ("atoms", NUMPY, ONE, TWO), rows)]


def answers(results: Results) -> list[Answer]:
    """Compare with what was aimed at."""
    sizes = {int(size): row for size, row in results["sizes"].items() if row[ONE]}
    found = [
        below(f"fluid of {n_atoms:,} atoms: two threads of Numba", sizes[n_atoms][TWO]["median"], most, "ns")
        for n_atoms, most in ((10_000, 80.0), (1_000_000, 150.0))
        if n_atoms in sizes
    ]
    if sizes:
        worst = max(row[NUMPY]["median"] / row[ONE]["median"] for row in sizes.values())
        found.append(below("fluids: NumPy, than one thread of Numba, at worst", worst, 4.0, "times slower"))
    return found
