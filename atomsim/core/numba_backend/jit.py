"""How kernels are compiled; knows nothing of what they compute."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any, TypeVar

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # Numba complains of settings in the environment, which are others' affairs
    import numba

from atomsim.core.numba_backend.cache import writable_folder

Function = TypeVar("Function", bound=Callable[..., object])

_numba: Any = numba
"""Kernels are annotated as the Python functions they are written as."""

if _numba.config.DISABLE_JIT:
    raise ImportError("its compiler is switched off by NUMBA_DISABLE_JIT")

OPTIONS = {"nogil": True, "error_model": "numpy", "_nrt": False}
"""Kernels run without the interpreter's lock, in IEEE arithmetic exactly as written, and allocate nothing: all arrays
belong to Python, so no references are counted, which would cost more than the arithmetic."""


def inner(function: Function) -> Function:
    """Compile a function that only other kernels call, into each of them."""
    compiled: Function = _numba.njit(**OPTIONS, forceinline=True, no_cpython_wrapper=True)(function)
    return compiled


def kernel(function: Function) -> Function:
    """Compile a function that Python calls, and keep the machine code where that is possible."""
    folder = writable_folder()
    setting = _numba.config.CACHE_DIR
    _numba.config.CACHE_DIR = str(folder or "")
    try:
        compiled: Function = _numba.njit(**OPTIONS, cache=folder is not None)(function)
        return compiled
    finally:
        _numba.config.CACHE_DIR = setting
