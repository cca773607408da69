"""Errors travel: pickled, copied, or raised in another process, each says what it said before."""

from __future__ import annotations

import copy
import importlib
import pickle
import pkgutil
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import pytest

import atomsim
from atomsim.errors import Mark, Problem, SceneError
from atomsim.scene.loader import loads

ARGUMENTS: dict[str, tuple[Any, ...]] = {
    "SceneError": (
        [Problem(Mark("s.yaml", 3, 5), "groups.ring", "needs a number"), Problem(Mark("t", 1, 1), "", "no")],
    ),
    "_TooMuchError": ([Problem(Mark("s.yaml", 3, 5), "", "too much")],),
    "SelectionError": ("ring[9]", "`ring[9]` is out of range"),
    "RuleError": ("pairs", "index 9 is out of range"),
}
"""What the classes are called with that take more than a message."""

WAYS: dict[str, Callable[[Any], Any]] = {
    "pickle": lambda error: pickle.loads(pickle.dumps(error)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


def own_errors() -> list[type[Exception]]:
    """Return every class of errors of the package."""
    modules = [
        importlib.import_module(module.name)
        for module in pkgutil.walk_packages(atomsim.__path__, "atomsim.")
        if not module.name.endswith("__main__")
    ]
    found = {
        value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Exception) and value.__module__.startswith("atomsim")
    }
    return sorted(found, key=lambda error: error.__name__)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("error_class", own_errors(), ids=lambda error_class: error_class.__name__)
def test_an_error_arrives_as_it_left(error_class: type[Exception], way: str) -> None:
    error = error_class(*ARGUMENTS.get(error_class.__name__, ("a.h5: what is wrong",)))
    arrived = WAYS[way](error)
    assert type(arrived) is error_class
    assert str(arrived) == str(error)
    assert vars(arrived) == vars(error)


def fail() -> None:
    """Load a scene with several mistakes."""
    loads("atomsim: 1\ntime_step: x\nrounds: y\n", "s.yaml")


def test_an_error_comes_out_of_another_process() -> None:
    with pytest.raises(SceneError) as here:
        fail()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        error = pool.submit(fail).exception(timeout=60)
    assert isinstance(error, SceneError)
    assert str(error) == str(here.value)
    assert error.problems == here.value.problems
