"""How near selections come on the way from one recorded frame to the next, which no frame shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from atomsim.core.gauges.block import Block, Memoryless, dot
from atomsim.core.gauges.motion import Fastest
from atomsim.core.gauges.near import Gap
from atomsim.core.model import Floats
from atomsim.core.pairs.collisions import as_index
from atomsim.core.pairs.near import near_pairs

FURTHEST = 8.0
"""Atoms that are further apart than contact by more than this [length] are not looked at, however fast they are."""


@dataclass(frozen=True, slots=True, eq=False)
class Passing(Memoryless):
    """The gap between two selections now, and the least gap in a time to come if every atom goes straight on.

    Limitations: bonds and forces bend the paths, so the time should be short against that in which they act.

    Attributes:
        gap: the gap now.
        span: the time to come.
    """

    gap: Gap
    span: float
    n_columns = 2

    def measure(self, block: Block, memory: Floats) -> Floats:
        """Return the gap, and the least gap ahead where it may be less than zero; elsewhere again the gap."""
        gap = self.gap.measure(block, memory)[0]
        speeds = [Fastest(as_index(side)).measure(block, memory)[0] for side in (self.gap.left, self.gap.right)]
        reach = np.minimum((speeds[0] + speeds[1]) * self.span, FURTHEST)
        ahead = gap.copy()
        for frame in np.flatnonzero((gap > 0.0) & (gap < reach)).tolist():
            ahead[frame] = self._ahead(block.position[:, :, frame], block.velocity[:, :, frame], float(reach[frame]))
        return np.stack([gap, ahead])

    def _ahead(self, position: Floats, velocity: Floats, reach: float) -> float:
        """Return min |Δc + Δv t| − 2 over pairs that may meet and times from zero to the span."""
        left, right = self.gap.left, self.gap.right
        one, other = near_pairs(position[:, left], position[:, right], 2.0 + reach)
        first, second = left[one], right[other]
        first, second = first[first != second], second[first != second]
        way = position[:, second] - position[:, first]
        speed = velocity[:, second] - velocity[:, first]
        squared = dot(speed, speed)
        time = np.clip(-dot(way, speed) / np.where(squared == 0.0, 1.0, squared), 0.0, self.span)
        nearest = way + time * speed
        return float(np.sqrt(dot(nearest, nearest).min())) - 2.0
