"""Rounds that a scene wants shown and never runs."""

from __future__ import annotations

from collections.abc import Iterator

from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject


def no_such_round(subject: Subject) -> Iterator[Symptom]:
    """Find rounds of `render.rounds` beyond the last one of the run."""
    scene = subject.scene
    shown = scene.render.rounds or ()
    beyond = [round_index for round_index in shown if round_index > scene.rounds]
    if beyond:
        kept = [round_index for round_index in shown if round_index <= scene.rounds]
        yield Symptom(
            at=("render", "rounds"),
            names=(("render", "rounds"), ("rounds",)),
            message=f"there is no round {beyond[0]} to show; the run ends at {scene.rounds}",
            remedy={"render": {"rounds": kept or [scene.rounds]}},
            rounds=tuple(beyond),
        )
