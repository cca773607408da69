"""Pictures of trajectories: what other parts of atomsim may ask for; loads no matplotlib before a strip is made."""

from atomsim.render.camera import View
from atomsim.render.strip import Row, atom_color, compose, frames_to

__all__ = ["Row", "View", "atom_color", "compose", "frames_to"]
