"""How elastic a collision of two atoms is: the numbers of docs/theory.md, measured."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from support.running import after, compiled

from atomsim.core.model import Floats, State

THEORY = (Path(__file__).parents[2] / "docs" / "theory.md").read_text(encoding="utf-8")

ROW = re.compile(r"^\| (0\.\d+) \| ([\d.]+) \| −([\d.]+) to \+([\d.]+) % \| ([−+][\d.]+) % \|$", re.MULTILINE)

PHASES = 2000
"""Collisions measured, begun evenly spread between one round and the next."""


def changes(time_step: float, speed: float) -> Floats:
    """Return by what share the energy of two atoms changes that meet head on, for each phase."""
    line = {"shape": "string", "count": PHASES, "step": [0, 9, 0]}
    pairs = {f"pair_{side}": {**line, "centre": [x, 0, 0], "velocity": [-x * speed, 0, 0]} for side, x in SIDES.items()}
    model, state = compiled(pairs, time_step, collisions={"hit": {"between": [*pairs]}})
    gap = time_step * speed * (np.arange(PHASES) + 0.5) / PHASES
    reach = np.concatenate((-(1.0 + 0.5 * gap), 1.0 + 0.5 * gap))
    state = State(0, np.column_stack((reach, state.position[:, 1:])), state.velocity)
    end = after(model, state, 400)
    assert (np.diff(end.position[:, 0].reshape(2, PHASES), axis=0) > 2.0).all(), "some still touch"
    change: Floats = (end.velocity[:PHASES] ** 2).sum(axis=1) / (0.25 * speed * speed) - 1.0
    return change


def measures(change: Floats) -> tuple[float, float, float]:
    """Return the least, the most and the mean."""
    return change.min(), change.max(), change.mean()


SIDES = {"left": -0.5, "right": 0.5}


@pytest.mark.parametrize("row", ROW.findall(THEORY), ids=lambda row: f"{row[0]} at {row[1]}")
def test_the_numbers_of_the_theory(row: tuple[str, str, str, str, str]) -> None:
    change = 100.0 * changes(float(row[0]), float(row[1]))
    said = [-float(row[2]), float(row[3]), float(row[4].replace("−", "-"))]
    digits = [len(number.partition(".")[2]) for number in row[2:]]
    measured = [round(float(number), places) for number, places in zip(measures(change), digits, strict=True)]
    assert measured == said


def test_the_theory_has_these_numbers() -> None:
    assert [row[:2] for row in ROW.findall(THEORY)] == [
        ("0.05", "1"),
        ("0.05", "0.2"),
        ("0.01", "1"),
        ("0.01", "0.2"),
        ("0.001", "1"),
        ("0.001", "0.2"),
    ]
