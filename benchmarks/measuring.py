"""What it costs to measure a long run, to find its events and to draw them; knows no formula."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import atomsim
from benchmarks.rounds import SCENES
from benchmarks.tables import Answer, Table, below, significant
from benchmarks.timing import Results, in_turns, spread

READ, EVENTS, PLOT = "reading alone", "events", "a plot"

MEASURES: dict[str, tuple[str, ...]] = {
    "height of ball_1": ("height of ball_1",),
    "energy": ("energy",),
    "gap between ball_1 and surface": ("gap between ball_1 and surface",),
    "turning of surface": ("turning of surface",),
    "mean strain of surface": ("mean strain of surface",),
    "contacts": ("contacts",),
    "height, speed, gap and tilt": (
        "height of ball_1",
        "speed of ball_2",
        "gap between ball_1 and surface",
        "tilt of surface",
    ),
}
"""What is measured, by what stands in the table; the last is several at once."""

SEVERAL = list(MEASURES)[-1]


def measure(quick: bool) -> Results:
    """Time the balls, every round of which is recorded, in seconds."""
    n_rounds = 100 if quick else 10_000
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "balls.h5"
        atomsim.run(atomsim.load(SCENES / "balls.yaml", [f"rounds={n_rounds}", "record_every=1"]), path)
        actions: dict[str, Callable[[], object]] = {READ: partial(_read, path)}
        actions |= {name: partial(atomsim.measure, path, list(texts)) for name, texts in MEASURES.items()}
        actions |= {EVENTS: partial(atomsim.events, path), PLOT: partial(atomsim.plot, path, path.with_suffix(".png"))}
        in_turns(actions, 1)
        seconds = in_turns(actions, 1 if quick else 5)
    return {"frames": n_rounds + 1, "seconds": {name: spread(times) for name, times in seconds.items()}}


def _read(path: Path) -> None:
    """Read all frames, each of which is checked against its digest."""
    with atomsim.Trajectory(path) as trajectory:
        trajectory.verify()


def tables(results: Results) -> list[Table]:
    """Return a row for everything that was done."""
    rows = [(name, significant(times["median"])) for name, times in results["seconds"].items()]
    caption = f"`scenes/balls.yaml`, {results['frames']:,} frames of 627 atoms: seconds (median):"
    return [Table(caption, ("what", "seconds"), rows)]


def answers(results: Results) -> list[Answer]:
    """Compare with what was aimed at."""
    seconds = results["seconds"][SEVERAL]["median"]
    return [below("several measures of 10,000 frames of 627 atoms", seconds, 1.0, "s")]
