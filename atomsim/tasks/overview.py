"""All runs of a picture looked over together, so that its rows show the same rounds from the same side."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Indices
from atomsim.drawing import Motion, Survey, survey, telling
from atomsim.trajectory import Trajectory


class Overview:
    """What happens in some runs; they are read only if somebody asks.

    Args:
        trajectories: the runs, open.
    """

    def __init__(self, trajectories: Sequence[Trajectory]) -> None:
        self._trajectories = trajectories

    @cached_property
    def _surveys(self) -> list[Survey]:
        return [survey(trajectory, trajectory.header.groups) for trajectory in self._trajectories]

    def azimuth(self, up: str) -> float:
        """Return the direction of a viewer who sees the motion of all runs best, `up` being the axis that points up."""
        return Motion.total([one.motion for one in self._surveys]).azimuth(up)

    def scenery(self, trajectory: Trajectory) -> NDArray[np.bool_]:
        """Return which atoms of one of the runs are scenery, (n_atoms,) bool."""
        return self._own(trajectory).scenery

    def _own(self, trajectory: Trajectory) -> Survey:
        return self._surveys[self._trajectories.index(trajectory)]

    def telling(self, trajectory: Trajectory, n_frames: int) -> Indices:
        """Return the places of frames of one of the runs that tell most, the same for all runs with the same rounds."""
        own = self._own(trajectory)
        alike = [
            one
            for run, one in zip(self._trajectories, self._surveys, strict=True)
            if np.array_equal(run.rounds, trajectory.rounds) and np.array_equal(one.places, own.places)
        ]
        return telling(alike, n_frames)
