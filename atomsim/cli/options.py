"""Arguments and options that several commands share, and how their values are read: numbers, names of files."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, TypeAlias, TypeVar

import typer

from atomsim.core.backend_table import NAMES
from atomsim.errors import InputError

Part = TypeVar("Part", int, float)


def number(option: str, least: float) -> Callable[[str], float]:
    """Return what reads the value of an option as a finite number, written as in a scene."""

    def read(text: str) -> float:
        value = _resolved(text)
        if value is None or not (math.isfinite(value) and value >= least):
            raise InputError(f"{option} needs a number of {least:g} or more{_meant(text)}")
        return value

    return read


def whole_number(option: str, least: int) -> Callable[[str], int]:
    """Return what reads the value of an option as a whole number, written as in a scene: 1e3 is one."""

    def read(text: str) -> int:
        value = _resolved(text)
        if value is None or not (math.isfinite(value) and value == int(value) and value >= least):
            raise InputError(f"{option} needs a whole number of {least} or more{_meant(text)}")
        return int(value)

    return read


def one_of(option: str, choices: Sequence[str]) -> Callable[[str], str]:
    """Return what reads the value of an option as one of several words."""

    def read(text: str) -> str:
        from atomsim.scene.mistakes.wording import either, readable

        if text.lower() not in choices:
            raise InputError(f"{option} needs {either(choices)} (got {readable(text)})")
        return text.lower()

    return read


def _resolved(text: str) -> int | float | None:
    """Return the number that a text means in a scene, or None."""
    from atomsim.scene.yaml.scalars import resolve

    value: Any = resolve(str(text).strip())  # typer sends defaults here, too
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def _meant(text: str) -> str:
    """Return what was typed, and the number without commas if that was meant."""
    from atomsim.scene.mistakes.wording import readable

    plain = text.replace(",", "").replace("_", "")
    hint = f"; write {plain}" if plain != text and _resolved(plain) is not None else ""
    return f"{hint} (got {readable(text)})"


def numbers(text: str, separator: str, kind: type[Part]) -> list[Part]:
    """Read numbers with a separator between; none if any part is no number."""
    try:
        return [kind(part) for part in text.lower().split(separator)]
    except ValueError:
        return []


def pair(text: str, separator: str, kind: type[Part], option: str, example: str) -> tuple[Part, Part]:
    """Read two numbers with a separator between."""
    found = numbers(text, separator, kind)
    if len(found) != 2:
        raise InputError(f"{option} needs two numbers, as in {example} (got {text})")
    return found[0], found[1]


def file_name(option: str) -> Callable[[str], Path]:
    """Return what reads the value of an option as the name of a file or folder, which no option and no stream is."""

    def read(text: str | Path) -> Path:
        name = str(text)
        if name == "-":
            raise InputError(f"{option} needs a name, not a stream (got -)")
        if name.startswith("-"):
            raise InputError(f"{option} needs a name; one that begins so is written ./{name} (got {name})")
        return Path(text)

    return read


def output(metavar: str, help: str) -> Any:
    """Return the option that names the file to write."""
    return typer.Option("--output", "-o", metavar=metavar, parser=file_name("--output"), show_default=False, help=help)


Backend: TypeAlias = Annotated[
    str,
    typer.Option(
        metavar="|".join(NAMES),
        parser=one_of("--backend", NAMES),
        help="What computes; the trajectory is the same to the last bit.",
        autocompletion=lambda: NAMES,
    ),
]

Threads: TypeAlias = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        parser=whole_number("--threads", 1),
        help="Threads to compute with (Numba only); by default as many as are worth it.",
    ),
]

Settings: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="PATH=VALUE", help="Change a value of the scene; may be repeated."),
]
