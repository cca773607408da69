"""A strip of two balls in three formats, drawn here or as a program: `python small_strip.py FOLDER`."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from atomsim.core.model import Frame, Observables, State
from atomsim.drawing.strip import Row, compose

EXTENSIONS = ("png", "svg", "pdf")


def small_strip(folder: Path) -> None:
    """Draw it into a folder."""
    position = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.5]])
    nothing = Observables(0.0, 0.0, 0.0, np.zeros(3), np.zeros(3), 0)
    frame = Frame(State(0, position, np.zeros((2, 3))), 0.0, "", nothing)
    row = Row("Two balls, $x^2$, 環", (frame,), (0,), lambda frame: np.ones((2, 3)))
    for extension in EXTENSIONS:
        compose([row], folder / f"strip.{extension}", (64, 48))


if __name__ == "__main__":
    small_strip(Path(sys.argv[1]))
    assert not {"matplotlib.pyplot", "matplotlib.style"} & set(sys.modules)
