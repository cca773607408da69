"""What a command does, without a terminal: run, render, compute again, compare, golden trajectories."""
