"""Behaviours measured from trajectories: from frames to numbers; knows no expected number."""
