"""Checks of arguments that a Python program passes: an error names the argument, what it needs and what it got."""

from __future__ import annotations

import operator
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from atomsim.errors import InputError

Kind = TypeVar("Kind")

LOADED_SCENE = "a loaded scene, as atomsim.load returns it"
MODEL, STATE = "a model, as atomsim.compile returns it", "a state, as atomsim.compile returns it or a frame has it"

_LONGEST = 80
"""Letters of a value that a message shows."""


def refused(name: str, needs: str, got: object) -> InputError:
    """Return the error for an argument.

    >>> print(refused("rounds", "a whole number of 1 or more", -1))
    rounds: needs a whole number of 1 or more (got -1)
    """
    try:
        shown = repr(got)
    except Exception:  # a stranger's class may do anything
        shown = f"a {type(got).__name__}"
    shown = " ".join(shown.split())
    return InputError(f"{name}: needs {needs} (got {shown[:_LONGEST]}{'…' if len(shown) > _LONGEST else ''})")


def whole(name: str, value: object, *, least: int = 1, most: int | None = None) -> int:
    """Return a whole number; one written as 1e3, or as NumPy has them, is one too.

    Raises:
        InputError: it is no such number, below `least` or above `most`.
    """
    try:
        number = int(value) if isinstance(value, float) and value.is_integer() else operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        number = least - 1
    if isinstance(value, bool) or number < least or (most is not None and number > most):
        raise refused(
            name, f"a whole number {f'of {least} or more' if most is None else f'from {least} to {most}'}", value
        )
    return number


def path(name: str, value: object) -> Path:
    """Return the name of a file as a path.

    Raises:
        InputError: it is none, or one that no file can have.
    """
    if isinstance(value, str | os.PathLike):
        text = os.fspath(value)
        if isinstance(text, str) and text and "\0" not in text:
            return Path(text)
    raise refused(name, "the name of a file", value)


def paths(name: str, value: Any) -> list[Path]:
    """Return the names of files as paths; one alone need not be in a list.

    Raises:
        InputError: there is none, or one that no file can have.
    """
    if isinstance(value, str | os.PathLike):
        return [path(name, value)]
    return [path(name, part) for part in sequence(name, value, "the name of a file, or a list of such names")]


def whole_pair(name: str, value: Any, needs: str) -> tuple[int, int]:
    """Return two whole numbers.

    Raises:
        InputError: they are not two, or not whole.
    """
    try:
        first, second = (operator.index(part) for part in value)
    except (TypeError, ValueError):
        raise refused(name, needs, value) from None
    return first, second


def real_pair(name: str, value: Any, needs: str) -> tuple[float, float]:
    """Return two numbers.

    Raises:
        InputError: they are not two, or no numbers.
    """
    try:
        first, second = (float(part) for part in value)
    except (TypeError, ValueError):
        raise refused(name, needs, value) from None
    return first, second


def function(name: str, value: object) -> None:
    """Make sure that an argument, if there is one, can be called: else it would show only after long work.

    Raises:
        InputError: it cannot.
    """
    if value is not None and not callable(value):
        raise refused(name, "a function", value)


def flag(name: str, value: object) -> bool:
    """Return whether something is wished: a text that says no would count as yes.

    Raises:
        InputError: it is neither true nor false.
    """
    if not isinstance(value, bool):
        raise refused(name, "True or False", value)
    return value


def texts(name: str, value: Any, needs: str) -> tuple[str, ...]:
    """Return texts, which may be none: not a single one, taken letter by letter, nor a mapping, taken by its keys.

    Raises:
        InputError: they are no texts, or do not come one after the other.
    """
    try:
        found = () if isinstance(value, str | bytes | Mapping) else tuple(value)
    except TypeError:
        found = (None,)
    if isinstance(value, str | bytes | Mapping) or not all(isinstance(text, str) for text in found):
        raise refused(name, needs, value)
    return found


def instance(name: str, value: object, kind: type[Kind], needs: str) -> Kind:
    """Return a value that is of a kind.

    Args:
        name: of the argument.
        value: what was passed.
        kind: the class that it must be of.
        needs: what that is called, and where it comes from.

    Raises:
        InputError: it is of another kind.
    """
    if not isinstance(value, kind):
        raise refused(name, needs, value)
    return value


def choice(name: str, value: object, choices: Sequence[str]) -> str:
    """Return one of several words.

    Raises:
        InputError: it is none of them.
    """
    if not (isinstance(value, str) and value in choices):
        raise refused(name, f"{', '.join(choices[:-1])} or {choices[-1]}", value)
    return value


def sequence(name: str, value: Any, needs: str) -> list[Any]:
    """Return what several things were passed in, as a list: not a text, which would be taken letter by letter.

    Raises:
        InputError: they do not come one after the other, or there are none.
    """
    if isinstance(value, str | bytes):
        raise refused(name, needs, value)
    try:
        found = list(value)
    except TypeError:
        found = []
    if not found:
        raise refused(name, needs, value)
    return found
