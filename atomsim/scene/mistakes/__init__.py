"""Mistakes in scenes, in the words of the scene language."""
