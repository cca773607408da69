"""Runs of the paper's scenes, as they are or with changes, each computed once; knows nothing of behaviours."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from atomsim.compiler import compile_scene
from atomsim.core.model import BondTable, Floats, Indices, Model
from atomsim.core.simulate import simulate
from atomsim.scene import load
from support.running import SCENES


@dataclass(frozen=True, eq=False)
class Run:
    """All frames of a run.

    Attributes:
        model: the compiled scene.
        round: the round of each frame, (n_frames,) int64.
        position: atom centres [length], (n_frames, n_atoms, 3) float64.
        velocity: [length per unit of time], (n_frames, n_atoms, 3) float64.
    """

    model: Model
    round: Indices
    position: Floats
    velocity: Floats

    def atoms(self, group: str) -> slice:
        """Return where a group stands among the atoms."""
        span = next(span for span in self.model.groups if span.name == group)
        return slice(span.start, span.stop)

    def path(self, group: str) -> Floats:
        """Return the positions of a group's atoms, (n_frames, n, 3)."""
        return self.position[:, self.atoms(group)]

    def centre(self, group: str) -> Floats:
        """Return the centroid of a group, (n_frames, 3)."""
        return self.path(group).mean(axis=1)

    def drift(self, group: str) -> Floats:
        """Return the mean velocity of a group, (n_frames, 3)."""
        return self.velocity[:, self.atoms(group)].mean(axis=1)

    def bonds(self, name: str) -> BondTable:
        """Return the bonds of one declaration."""
        return next(table for table in self.model.bonds if table.origin.name == name)

    def frame(self, round_index: int) -> int:
        """Return which frame shows a round."""
        return int(np.flatnonzero(self.round == round_index)[0])


@cache
def run(scene: str, *overrides: str) -> Run:
    """Compute a scene of the paper with `--set` changes, or return what was computed before."""
    loaded = load(SCENES / f"{scene}.yaml", overrides=overrides)
    model, state = compile_scene(loaded)
    frames = list(simulate(model, state, loaded.scene.rounds, loaded.scene.record_every))
    return Run(
        model=model,
        round=np.array([frame.round_index for frame in frames]),
        position=np.stack([frame.position for frame in frames]),
        velocity=np.stack([frame.velocity for frame in frames]),
    )
