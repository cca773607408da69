"""Draws the numbers of the benchmark: engines as bars, the fluid as lines; knows no Markdown."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.timing import Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes

OURS, OTHERS = "firebrick", "lightslategray"
LINES = ("firebrick", "steelblue", "goldenrod")


def draw(results: Results, path: Path) -> None:
    """Draw a picture of those sections that were measured: rods, balls, fluid."""
    from matplotlib.figure import Figure

    shown = [name for name in ("rods", "balls", "fluid") if name in results]
    figure = Figure(figsize=(4.0 * len(shown), 3.4), dpi=110, layout="constrained")
    for name, axes in zip(shown, figure.subplots(1, len(shown), squeeze=False)[0], strict=True):
        if name == "fluid":
            _draw_fluid(results[name], axes)
        else:
            _draw_engines(results[name], axes)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, metadata={"Software": None})


def _draw_engines(results: Results, axes: Axes) -> None:
    """One bar for each engine, the fastest on top."""
    times = {name: row["median"] for name, row in results["engines"].items() if row}
    names = sorted(times, key=times.__getitem__, reverse=True)
    colors = [OURS if name.startswith("atomsim") else OTHERS for name in names]
    bars = axes.barh(names, [times[name] for name in names], color=colors)
    axes.bar_label(bars, fmt="%.3g", padding=3)
    axes.margins(x=0.15)
    axes.set_title(f"{results['scene']}: µs per round")


def _draw_fluid(results: Results, axes: Axes) -> None:
    """One line for each backend."""
    sizes = {int(size): row for size, row in results["sizes"].items()}
    names = [name for name, value in next(iter(sizes.values())).items() if value]
    for name, color in zip(names, LINES, strict=False):
        axes.semilogx(list(sizes), [row[name]["median"] for row in sizes.values()], "o-", color=color, label=name)
    axes.set_ylim(0.0, 1.5 * axes.dataLim.ymax)  # the legend stands above the lines
    axes.set_title("free fluid: ns per atom and round")
    axes.set_xlabel("atoms")
    axes.legend(frameon=False)
