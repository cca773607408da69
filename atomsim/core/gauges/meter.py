"""Several gauges taken together, state after state or block after block, with what they have to remember."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from atomsim.core.gauges.block import Block, Gauge
from atomsim.core.model import Floats


class Meter:
    """Takes gauges of states in the order of their rounds.

    Args:
        gauges: what to measure.

    Attributes:
        n_columns: how many numbers they give together.
        memory: what they remember, one gauge after the other: with it a meter goes on from where another was.
    """

    def __init__(self, gauges: Sequence[Gauge]) -> None:
        self._gauges = tuple(gauges)
        self.n_columns = sum(gauge.n_columns for gauge in self._gauges)
        memories = [gauge.begin() for gauge in self._gauges]
        self._ends = np.cumsum([memory.size for memory in memories])
        self.memory = np.concatenate([np.empty(0), *memories])

    @property
    def is_running(self) -> bool:
        """Whether what a state gives depends on the states before, none of which may then be left out."""
        return self.memory.size > 0

    def take(self, block: Block) -> Floats:
        """Return all values, (n_frames, n_columns) float64, and remember.

        What is not finite, as in a state that blew up, gives values that are not.
        """
        values = np.empty((block.n_frames, self.n_columns))
        column = 0
        with np.errstate(all="ignore"):
            for gauge, end in zip(self._gauges, self._ends.tolist(), strict=True):
                memory = self.memory[end - gauge.begin().size : end]
                values[:, column : column + gauge.n_columns] = gauge.measure(block, memory).T
                column += gauge.n_columns
        return values
