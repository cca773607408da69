"""What it costs to record a run: measuring frames, and writing them to a file; knows no file format."""

from __future__ import annotations

import tempfile
from collections import deque
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from atomsim.compiler import compile_scene
from atomsim.core.backend import choose
from atomsim.core.simulate import simulate
from atomsim.scene import load
from atomsim.tasks.run import run
from benchmarks.rounds import SCENES
from benchmarks.tables import Answer, Table, below, significant
from benchmarks.timing import Results, in_turns, spread

ALONE, MEASURED, WRITTEN = "rounds alone", "and frames", "and the file"


def measure(quick: bool) -> Results:
    """Time the rods, as they stand in the scene, in milliseconds."""
    names = ("numpy", "numba") if find_spec("numba") else ("numpy",)
    with tempfile.TemporaryDirectory() as folder:
        actions = {
            f"{name}: {part}": action
            for name in names
            for part, action in _actions(name, Path(folder) / f"{name}.h5").items()
        }
        if not quick:
            in_turns(actions, 1)
        seconds = in_turns(actions, 1 if quick else 9)
    return {
        name: {part: spread(seconds[f"{name}: {part}"], 1e-3) for part in (ALONE, MEASURED, WRITTEN)} for name in names
    }


def _actions(backend: str, path: Path) -> dict[str, Callable[[], object]]:
    """Return the run without recording, with frames that nobody keeps, and as a user has it; all compile the scene."""
    loaded = load(SCENES / "rods.yaml")
    rounds, record_every = loaded.scene.rounds, loaded.scene.record_every

    def alone() -> None:
        model, state = compile_scene(loaded)
        choose(backend, 1, model, rounds).make_stepper(model, state).advance(rounds)

    def measured() -> None:
        model, state = compile_scene(loaded)
        make = choose(backend, 1, model, rounds).make_stepper
        deque(simulate(model, state, rounds, record_every, make), maxlen=0)

    written = partial(run, loaded, path, replace=True, backend=backend, threads=1)
    return {ALONE: alone, MEASURED: measured, WRITTEN: written}


def tables(results: Results) -> list[Table]:
    """Return a row for every backend."""
    rows = [
        (
            name,
            *(significant(row[part]["median"]) for part in (ALONE, MEASURED, WRITTEN)),
            f"{_share(row, ALONE, MEASURED):.0f} %",
            f"{_share(row, MEASURED, WRITTEN):.0f} %",
        )
        for name, row in results.items()
    ]
    caption = "A run of `scenes/rods.yaml` with the default `record_every`, inside one process: milliseconds (median):"
    return [Table(caption, ("backend", ALONE, MEASURED, WRITTEN, "share of measuring", "share of writing"), rows)]


def answers(results: Results) -> list[Answer]:
    """Compare with what was aimed at: `auto` runs the rods with NumPy."""
    row = results["numpy"]
    return [
        below("rods: writing frames, of the run", _share(row, MEASURED, WRITTEN), 15.0, "%"),
        below("rods: measuring and writing frames, of the run", _share(row, ALONE, WRITTEN), 15.0, "%"),
    ]


def _share(row: Results, without: str, including: str) -> float:
    """Return what one part adds to another, in percent of the whole run."""
    added: float = row[including]["median"] - row[without]["median"]
    whole: float = row[WRITTEN]["median"]
    return 100.0 * added / whole
