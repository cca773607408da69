"""Scenes: the language, the loader with its messages, the schema; knows no atoms, no arrays, no files but scenes."""

from atomsim.scene.loader import LoadedScene, load, load_stream, loads

__all__ = ["LoadedScene", "load", "load_stream", "loads"]
