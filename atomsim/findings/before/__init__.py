"""Diagnoses that need no run: a file for each kind, all of them in the table of `diagnose`."""
