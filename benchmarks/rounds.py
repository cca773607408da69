"""How long a round of a scene takes every engine, and how far apart their positions are; knows only ours by name.

All engines go through the same rounds in short turns, several times over.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from atomsim.compiler import compile_scene
from atomsim.core.backend import MakeStepper, Stepper
from atomsim.core.digest import state_digest
from atomsim.core.model import Model, State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.scene import load
from benchmarks.engines import ENGINES, NUMBA, NUMPY, PLAIN, Engine
from benchmarks.pairs import pair_table
from benchmarks.tables import MISSING, Answer, Table, at_least, significant
from benchmarks.timing import Results, in_turns, spread

SCENES = Path(__file__).parent.parent / "scenes"

START = 200
"""By this round things touch in both scenes."""

COMPARED = 100
"""After so many rounds positions are compared."""

TURN = 100
"""Rounds in a turn: milliseconds, too short for much noise to hit one engine alone."""

AGREEMENT = 1e-9
"""Positions this near are those of the same physics, added up in another order [length]."""

FASTER = {"rods": {"plain": 2.8, "numba": 5.0}, "balls": {"plain": 1.3, "numba": 8.0}}
"""How many times faster our NumPy should be than the plain loop, and our Numba than our NumPy."""


def measure(scene: str, quick: bool, engines: Sequence[Engine] = ENGINES) -> Results:
    """Time the rounds of a scene in microseconds.

    Args:
        scene: its name, without `.yaml`.
        quick: fewer turns.
        engines: who takes part; NumPy has to.
    """
    loaded = load(SCENES / f"{scene}.yaml")
    model, state = compile_scene(loaded)
    start = _after(NumpyStepper, model, state, START).state()
    makers = {engine.name: make for engine in engines if (make := engine.load())}
    steppers = {name: _after(make, model, start, COMPARED) for name, make in makers.items()}
    compared = {name: stepper.state() for name, stepper in steppers.items()}
    reference = compared[NUMPY.name]
    seconds = _time(model, reference, makers, n_passes=2 if quick else 6, n_turns=4 if quick else 20)
    pairs = pair_table(model)
    is_bond = pairs.ceiling > 0.0
    return {
        "scene": scene,
        "atoms": model.n_atoms,
        "bonds": int(is_bond.sum()),
        "collision_pairs": int((~is_bond).sum()),
        "engines": {
            engine.name: spread(seconds[engine.name], TURN * 1e-6) | _agreement(compared[engine.name], reference)
            if engine.name in makers
            else None
            for engine in engines
        },
    }


def _time(
    model: Model, state: State, makers: dict[str, MakeStepper], n_passes: int, n_turns: int
) -> dict[str, list[float]]:
    """Return the seconds of every turn of every pass."""
    seconds: dict[str, list[float]] = {name: [] for name in makers}
    for _ in range(n_passes):
        turns = {name: partial(_after(make, model, state, 1).advance, TURN) for name, make in makers.items()}
        for name, times in in_turns(turns, n_turns).items():
            seconds[name] += times
    return seconds


def _after(make: MakeStepper, model: Model, state: State, n_rounds: int) -> Stepper:
    stepper = make(model, state)
    stepper.advance(n_rounds)
    return stepper


def _agreement(state: State, reference: State) -> Results:
    """Return how far positions are from the reference, and whether everything is the same to the last bit."""
    digests = {state_digest(each.position, each.velocity) for each in (state, reference)}
    return {
        "difference": float(np.abs(state.position - reference.position).max()),
        "is_same": len(digests) == 1,
    }


def tables(results: Results) -> list[Table]:
    """Return the table of a scene, the fastest engine first."""
    installed = {name: row for name, row in results["engines"].items() if row}
    numpy = installed[NUMPY.name]["median"]
    rows = [
        (
            name,
            significant(row["median"]),
            significant(row["minimum"]),
            f"{row['median'] / numpy:.2f}",
            "same bits" if row["is_same"] else f"{row['difference']:.0e}",
        )
        for name, row in sorted(installed.items(), key=lambda item: item[1]["median"])
    ]
    rows += [(name, MISSING, "", "", "") for name, row in results["engines"].items() if row is None]
    caption = (
        f"`scenes/{results['scene']}.yaml` ({results['atoms']:,} atoms, {results['bonds']:,} bonds, "
        f"{results['collision_pairs']:,} collision pairs): microseconds per round, one thread, and how far positions "
        f"are from ours after {COMPARED} rounds from round {START}:"
    )
    return [Table(caption, ("engine", "median", "minimum", "ratio to NumPy", "difference"), rows)]


def answers(results: Results) -> list[Answer]:
    """Compare with what was aimed at."""
    scene, engines = results["scene"], results["engines"]
    numpy, targets = engines[NUMPY.name]["median"], FASTER[results["scene"]]
    found = [
        at_least(f"{scene}: our NumPy, than the plain loop", engines[PLAIN.name]["median"] / numpy, targets["plain"])
    ]
    if engines.get(NUMBA.name):
        ratio = numpy / engines[NUMBA.name]["median"]
        found.append(at_least(f"{scene}: our Numba, than our NumPy", ratio, targets["numba"]))
    furthest = max(row["difference"] for row in engines.values() if row)
    question = f"{scene}: the furthest that any engine's positions are from ours"
    return [*found, Answer(question, f"{furthest:.0e}", f"< {AGREEMENT:.0e}", furthest < AGREEMENT)]
