"""Compiles a scene to the flat force tables of a model and its first state."""

from atomsim.compiler.compile import compile_scene

__all__ = ["compile_scene"]
