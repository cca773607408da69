"""Diagnoses after a run: what its frames show, a kind a file."""
