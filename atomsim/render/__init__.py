"""Pictures of trajectories: unit balls with true depth, frames side by side in a strip; knows no scenes."""

from atomsim.render.camera import View
from atomsim.render.strip import Row, atom_color, compose, frames_to

__all__ = ["Row", "View", "atom_color", "compose", "frames_to"]
