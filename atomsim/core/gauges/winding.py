"""How far one selection winds about another; knows a string by the order of its atoms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from atomsim.core.gauges.block import Atoms, Block, Memoryless, dot, one_row, ordered_sum
from atomsim.core.gauges.eigen import eigen
from atomsim.core.gauges.motion import mean
from atomsim.core.gauges.rigid import grained
from atomsim.core.model import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Winding(Memoryless):
    """The angle through which a string winds about the long axis of a body.

    The axis goes through the centroid, along the direction in which the body reaches farthest in the mean square. The
    polar angle about it is followed from atom to atom, each time by at most half a turn; its range is the winding.

    Attributes:
        string: what winds.
        body: about what.
    """

    string: Atoms
    body: Atoms
    n_columns = 1

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the range of the polar angle [degrees]."""
        around = block.position[:, self.body]
        centre = mean(around)
        offset = around - centre[:, None]
        moments = np.stack([ordered_sum(row * offset) for row in offset])
        axes = eigen(moments)[1]
        place = block.position[:, self.string] - centre[:, None]
        angle = grained(np.degrees(np.arctan2(dot(axes[:, 2, None], place), dot(axes[:, 1, None], place))))
        step = np.diff(angle, axis=0)
        step -= 360.0 * np.round(step / 360.0)
        followed = np.add.accumulate(np.concatenate([np.zeros((1, block.n_frames)), step]), axis=0)
        return one_row(followed.max(axis=0) - followed.min(axis=0))
