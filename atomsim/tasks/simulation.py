"""A scene as a simulation that can be stepped, on the backend that `run` would choose."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import overload

from atomsim.compiler.gauges import Subject
from atomsim.core.gauges.block import Block
from atomsim.core.gauges.meter import Meter
from atomsim.core.model import Floats, Observables
from atomsim.core.simulation import Simulation
from atomsim.scene import LoadedScene, load
from atomsim.scene.language.measures import Measure
from atomsim.tasks.measure import gauge, read_measure, texts_of
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
        self._subject = Subject.compiled(self.scene.scene, prepared.model, prepared.first)
        self._meters: dict[Measure, Meter] = {}

    @overload
    def measure(self) -> Observables: ...

    @overload
    def measure(self, measures: str | Sequence[str]) -> dict[str, float | Floats]: ...

    def measure(self, measures: str | Sequence[str] | None = None) -> Observables | dict[str, float | Floats]:
        """Return the observables of the present state, or measures of it.

        Args:
            measures: such as `height of ring` or `["gap between ring and floor", "energy"]`. Turns are counted from
                one asking to the next.

        Returns:
            The observables; or, by measure as it was written, a number, or (3,) of a vector.

        Raises:
            InputError: a text that is no measure, or a measure that makes no sense for these atoms.
        """
        if measures is None:
            return super().measure()
        block = Block.of_frame(self.frame())
        return {text: self._take(read_measure(text), block) for text in texts_of(measures)}

    def _take(self, measure: Measure, block: Block) -> float | Floats:
        if measure not in self._meters:
            self._meters[measure] = Meter([gauge(measure, self._subject)])
        values = self._meters[measure].take(block)[0]
        return float(values[0]) if values.size == 1 else values
