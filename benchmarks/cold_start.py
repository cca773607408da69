"""How long whole processes take, and from how many rounds on Numba pays; knows nothing of what happens inside."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from atomsim.compiler import compile_scene
from atomsim.core.backend import choose
from atomsim.core.model import Model
from atomsim.scene import load
from benchmarks.one_thread import environment_of_a_user
from benchmarks.rounds import SCENES
from benchmarks.tables import Answer, Table, below, significant
from benchmarks.timing import Results, in_turns, spread

RODS = SCENES / "rods.yaml"

ROUNDS = 4000
"""As many as the scene says."""

HELP, CHECK, RUN = "atomsim --help", "atomsim check scenes/rods.yaml", "atomsim run scenes/rods.yaml"

IMPORTS = ("numpy", "pydantic", "typer", "h5py", "matplotlib.figure", "numba")


def measure(quick: bool) -> Results:
    """Time processes in milliseconds, and find how many rounds repay the start of Numba."""
    backends = ("numpy", "numba") if find_spec("numba") else ("numpy",)
    with tempfile.TemporaryDirectory() as folder:
        processes = _processes(backends, Path(folder) / "out.h5")
        in_turns(processes, 1)  # files into the system's cache, kernels into ours
        seconds = in_turns(processes, 1 if quick else 11)
    times = {name: spread(taken, 1e-3) for name, taken in seconds.items()}
    return {"processes": times, "break_even": _break_even(times) if "numba" in backends else None}


def _processes(backends: tuple[str, ...], path: Path) -> dict[str, Callable[[], object]]:
    atomsim = ("-m", "atomsim")
    run = (*atomsim, "run", str(RODS), "-o", str(path), "--force", "--quiet")
    arguments: dict[str, tuple[str, ...]] = {"python -c pass": ("-c", "pass")}
    arguments |= {f"import {name}": ("-c", f"import {name}") for name in IMPORTS if find_spec(name.partition(".")[0])}
    arguments |= {HELP: (*atomsim, "--help"), CHECK: (*atomsim, "check", str(RODS)), RUN: run}
    for backend in backends:
        arguments[_run_name(backend, ROUNDS)] = (*run, "--backend", backend)
        arguments[_run_name(backend, 1)] = (*run, "--backend", backend, "--rounds", "1")
    environment = environment_of_a_user()
    return {
        name: partial(subprocess.run, [sys.executable, *rest], env=environment, check=True, stdout=subprocess.DEVNULL)
        for name, rest in arguments.items()
    }


def _run_name(backend: str, rounds: int) -> str:
    return f"{RUN} --backend {backend}" + ("" if rounds == ROUNDS else f" --rounds {rounds}")


def _break_even(times: Results) -> Results:
    """Return how many rounds of rods repay the start of Numba, as measured, and from how many on `auto` chooses it."""
    start, whole = (
        {name: times[_run_name(name, rounds)]["median"] for name in ("numpy", "numba")} for rounds in (1, ROUNDS)
    )
    per_round = {name: (whole[name] - start[name]) / (ROUNDS - 1) for name in start}
    gain = per_round["numpy"] - per_round["numba"]
    loaded = load(RODS)
    model, _ = compile_scene(loaded)
    return {
        "measured": (start["numba"] - start["numpy"]) / gain if gain > 0.0 else None,
        "auto": _auto_switches_at(model),
    }


def _auto_switches_at(model: Model) -> int:
    """Return the least number of rounds for which `auto` chooses Numba."""
    low, high = 1, 1 << 30
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if choose("auto", 1, model, middle).name == "numba" else (middle + 1, high)
    return low


def tables(results: Results) -> list[Table]:
    """Return the processes, and when Numba pays."""
    rows = [
        (f"`{name}`", significant(row["median"]), significant(row["minimum"]))
        for name, row in results["processes"].items()
    ]
    found = [Table("Whole processes: milliseconds:", ("process", "median", "minimum"), rows)]
    if even := results["break_even"]:
        measured = f"{even['measured']:,.0f}" if even["measured"] else "never"
        rows_even = [("Numba's start is repaid after", measured), ("`auto` chooses Numba from", f"{even['auto']:,}")]
        found.append(Table("When Numba pays, for `scenes/rods.yaml`:", ("", "rounds"), rows_even))
    return found


def answers(results: Results) -> list[Answer]:
    """Compare with what was aimed at."""
    times = results["processes"]
    return [
        below(f"`{HELP}`", times[HELP]["median"] / 1e3, 0.3, "s"),
        below(f"`{RUN}`, 4,000 rounds and the file", times[RUN]["median"] / 1e3, 0.8, "s"),
    ]
