"""Pictures of trajectories: what other parts of atomsim may ask for; loads no matplotlib before a strip is made."""

from atomsim.drawing.camera import View
from atomsim.drawing.strip import Report, Row, compose, frames_to

__all__ = ["Report", "Row", "View", "compose", "frames_to"]
