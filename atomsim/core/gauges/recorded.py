"""What was measured while a run was computed, found again with its frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from atomsim.core.gauges.block import Block, Memoryless
from atomsim.core.model import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Recorded(Memoryless):
    """The sum of some observables that are one number each.

    Attributes:
        names: those in `Observables`, at least one.
    """

    names: tuple[str, ...]
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return their sum, taken in order."""
        return np.add.accumulate(np.stack([block.observables[name] for name in self.names]), axis=0)[-1:]
