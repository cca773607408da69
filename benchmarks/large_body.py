"""How much memory a body of thousands of atoms takes, every one bound to every other; knows nothing of time."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable
from importlib.util import find_spec
from typing import TypeVar

from atomsim.compiler import compile_scene
from atomsim.core.backend import Stepper
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.observables import Observer
from atomsim.core.simulation import frame_of
from atomsim.scene import LoadedScene
from atomsim.scene.language import Scene
from benchmarks.tables import Answer, Table, below, significant
from benchmarks.timing import Results

COUNTS, QUICK_COUNTS = (10, 20, 25), (6, 8, 10)

MEGABYTE = 1e6

Made = TypeVar("Made")


def measure(quick: bool) -> Results:
    """Go through a run step by step and note, in megabytes, what each step keeps and what it needs on top meanwhile."""
    counts = QUICK_COUNTS if quick else COUNTS
    scene = Scene.model_validate(
        {
            "atomsim": 1,
            "time_step": 0.001,
            "rounds": 10,
            "groups": {"body": {"shape": "block", "counts": list(counts), "spacing": 1.0}},
            "bonds": {"body": {"within": "body", "rule": "all-pairs"}},
        }
    )
    memory = _Memory()
    model, state = memory.of("compiling the scene", lambda: compile_scene(LoadedScene(scene)))
    memory.of("measuring a frame", lambda: frame_of(model, state, Observer(model).observe(state)))
    memory.of("NumPy: one round", lambda: _one_round(NumpyStepper(model, state)))
    if find_spec("numba"):
        from atomsim.core.numba_backend.stepper import NumbaStepper

        memory.of("Numba: one round", lambda: _one_round(NumbaStepper(model, state)))
    return {"atoms": model.n_atoms, "bonds": sum(table.first.size for table in model.bonds), "steps": memory.finish()}


def _one_round(stepper: Stepper) -> Stepper:
    stepper.advance(1)
    return stepper


class _Memory:
    """What was noted so far."""

    def __init__(self) -> None:
        self._steps: Results = {}
        tracemalloc.start()

    def of(self, step: str, make: Callable[[], Made]) -> Made:
        """Do something, note it, and return what it made."""
        gc.collect()
        tracemalloc.reset_peak()
        before, _ = tracemalloc.get_traced_memory()
        made = make()
        after, peak = tracemalloc.get_traced_memory()
        self._steps[step] = {"kept": (after - before) / MEGABYTE, "on_top": (peak - after) / MEGABYTE}
        return made

    def finish(self) -> Results:
        tracemalloc.stop()
        return self._steps


def tables(results: Results) -> list[Table]:
    """Return a row for every step."""
    rows = [
        (step, significant(max(0.0, row["kept"])), significant(row["on_top"])) for step, row in results["steps"].items()
    ]
    caption = f"A body of {results['atoms']:,} atoms and {results['bonds']:,} bonds: megabytes (`tracemalloc`):"
    return [Table(caption, ("step", "kept", "on top meanwhile"), rows)]


def answers(results: Results) -> list[Answer]:
    """Compare with what was aimed at."""
    most = max(row["on_top"] for row in results["steps"].values())
    return [below(f"body of {results['atoms']:,} atoms: the most that any step needs on top", most, 256.0, "MB")]
