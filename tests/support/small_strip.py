"""A strip and a plot of two balls in three formats, drawn here or as a program: `python small_strip.py FOLDER`."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from atomsim.core.model import Frame, Observables, State
from atomsim.drawing.chart import Chart, Line, Mark
from atomsim.drawing.plot import plot_to
from atomsim.drawing.strip import Row, compose

EXTENSIONS = ("png", "svg", "pdf")


PICTURES = tuple(f"{what}.{extension}" for what in ("strip", "plot") for extension in EXTENSIONS)


def small_strip(folder: Path) -> None:
    """Draw both into a folder."""
    position = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.5]])
    nothing = Observables(0.0, 0.0, 0.0, np.zeros(3), np.zeros(3), 0)
    frame = Frame(State(0, position, np.zeros((2, 3))), 0.0, "", nothing)
    row = Row("Two balls, $x^2$, 環", (frame,), (0,), lambda frame: np.ones((2, 3)))
    for extension in EXTENSIONS:
        compose([row], folder / f"strip.{extension}", (64, 48))
        small_plot(folder / f"plot.{extension}")


def small_plot(out: Path, size: tuple[int, int] | None = (400, 300)) -> None:
    """Draw two lines and two events."""
    rounds, counts = np.arange(0, 50, 10), np.ones(5, dtype=bool)
    values = np.array([[0.0, 1.0, 4.0, 9.0, 16.0], [3.0, np.nan, 3.0, np.inf, -3.0]])
    labels = ("$x^2$", "環")
    lines = [Line(label, rounds, series, "#4682b4", counts) for label, series in zip(labels, values, strict=True)]
    marks = [Mark(10, "$y$ touches x", "#b22222"), Mark(20, "", "#b22222")]
    plot_to([Chart("height", "length", tuple(lines))], marks, "Two balls, $x^2$, 環", out, size)


if __name__ == "__main__":
    small_strip(Path(sys.argv[1]))
    assert not {"matplotlib.pyplot", "matplotlib.style"} & set(sys.modules)
