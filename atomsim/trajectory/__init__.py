"""Trajectories of runs: recorded, read back, gone on with."""

from atomsim.trajectory.header import End, Header
from atomsim.trajectory.journal.form import journal_path
from atomsim.trajectory.reader import Frames, Trajectory, later_version
from atomsim.trajectory.recorder import Recorder, check_target, recover
from atomsim.trajectory.rows import count_frames, trajectory_bytes
from atomsim.trajectory.stopped import StoppedRun

__all__ = [
    "End",
    "Frames",
    "Header",
    "Recorder",
    "StoppedRun",
    "Trajectory",
    "check_target",
    "count_frames",
    "journal_path",
    "later_version",
    "recover",
    "trajectory_bytes",
]
