"""A fluid of a hundred thousand atoms falls onto a plane, from YAML to trajectory; knows nothing of what goes on."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from benchmarks.one_thread import environment_of_a_user
from benchmarks.tables import Table, significant
from benchmarks.timing import Results

COUNTS, QUICK_COUNTS = (50, 50, 40), (10, 10, 10)

SPACING = 2.1
"""Distance between neighbours in the fluid at the start [length]; the plane's atoms are closer, so nothing leaks."""

ROUNDS, RECORD_EVERY = 400, 20

MEASURED = """
import atexit, re
from pathlib import Path
from atomsim.cli import main
status = Path("/proc/self/status")
atexit.register(lambda: print(re.search("VmHWM:(.*) kB", status.read_text())[1]))
main()
"""
"""The command line, which tells in the end how many kilobytes it had in memory at most."""


def measure(quick: bool) -> Results:
    """Run whole processes, one for every backend, and note their time, their memory at most, and the file's size."""
    scene = pouring(QUICK_COUNTS if quick else COUNTS)
    backends = ("numpy", "numba") if find_spec("numba") else ("numpy",)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pour.yaml"
        path.write_text(json.dumps(scene), encoding="utf-8")  # JSON is YAML
        return {"title": scene["title"], "runs": {name: _run(path, name) for name in backends}}


def pouring(counts: tuple[int, int, int]) -> dict[str, Any]:
    """Return the scene as data: a block just above a plane twice as wide that is held."""
    width = round(2 * max(counts[:2]) * SPACING / 1.5)
    n_atoms = counts[0] * counts[1] * counts[2]
    height = (counts[2] - 1) / 2 * SPACING + 4.0
    return {
        "atomsim": 1,
        "title": f"A fluid of {n_atoms:,} atoms falls onto a plane of {width * width:,}",
        "time_step": 0.05,
        "rounds": ROUNDS,
        "record_every": RECORD_EVERY,
        "groups": {
            "floor": {"shape": "plane", "counts": [width, width], "step_x": [1.5, 0, 0], "step_y": [0, 1.5, 0]},
            "fluid": {"shape": "block", "counts": list(counts), "spacing": SPACING, "centre": [0, 0, height]},
        },
        "jitter": {"amplitude": 0.05, "seed": 1},
        "collisions": {"fluid": {"within": "fluid"}, "floor": {"between": ["fluid", "floor"]}},
        "forces": {
            "weight": {"kind": "gravity", "acts_on": "fluid", "impulse": [0, 0, -0.01]},
            "floor": {"kind": "hold", "acts_on": "floor"},
        },
    }


def _run(scene: Path, backend: str) -> Results:
    """Run a scene in a process of its own."""
    target = scene.with_name(f"{backend}.h5")
    command = ["run", str(scene), "-o", str(target), "--backend", backend, "--quiet"]
    begin = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", MEASURED, *command],
        env=environment_of_a_user(),
        check=True,
        capture_output=True,
        text=True,
    )
    return {
        "seconds": time.perf_counter() - begin,
        "megabytes": int(done.stdout) / 1e3,
        "file": target.stat().st_size / 1e6,
    }


def tables(results: Results) -> list[Table]:
    """Return a row for every backend."""
    rows = [
        (name, *(significant(row[column]) for column in ("seconds", "megabytes", "file")))
        for name, row in results["runs"].items()
    ]
    head = ("backend", "seconds", "memory at most, MB", "file, MB")
    return [Table(f"{results['title']}, {ROUNDS} rounds, as a whole process:", head, rows)]
