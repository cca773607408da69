"""A scene as a simulation that can be stepped, on the backend that `run` would choose."""

from __future__ import annotations

import os

from atomsim.core.simulation import Simulation
from atomsim.scene import LoadedScene, load
from atomsim.tasks.prepare import prepare


class SceneSimulation(Simulation):
    """A scene that is run by hand: stepped by as many rounds as one likes, measured, pushed.

    Args:
        scene: as `load` returns it, or its file.
        backend: `auto`, `numpy` or `numba`; whichever it is, the states have the same bits.
        threads: how many threads to use; by default as many as are worth it.

    Raises:
        SceneError: the scene has mistakes.
        InputError: an unknown backend, or an impossible number of threads.

    Attributes:
        scene: the scene and where it came from.
        backend: what computes it, and why that.
    """

    def __init__(
        self, scene: LoadedScene | str | os.PathLike[str], *, backend: str = "auto", threads: int | None = None
    ) -> None:
        self.scene = scene if isinstance(scene, LoadedScene) else load(scene)
        prepared = prepare(self.scene)
        self.backend = prepared.choose(backend, threads)
        super().__init__(prepared.model, prepared.first, self.backend.make_stepper)
