"""Pictures of trajectories: what other parts of atomsim may ask for; loads no matplotlib before a strip is made."""

from atomsim.drawing.camera import View, direction_of
from atomsim.drawing.page import BLACK, WHITE, Paper
from atomsim.drawing.strip import Report, Row, compose, frames_to
from atomsim.drawing.survey import Motion, Survey, survey, telling

__all__ = [
    "BLACK",
    "WHITE",
    "Motion",
    "Paper",
    "Report",
    "Row",
    "Survey",
    "View",
    "compose",
    "direction_of",
    "frames_to",
    "survey",
    "telling",
]
