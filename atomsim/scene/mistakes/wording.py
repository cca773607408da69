"""How values and words of a user appear in messages: short, on one line, printable; knows no scene."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from itertools import islice
from typing import Any

from atomsim.scene.mistakes.lookalikes import first_odd, plain

_LONGEST = 60

_MOST_COMPARED = 1000
"""Of more choices than this, only the first may be what was meant: to compare them all would take too long."""


def printable(text: str) -> str:
    r"""Return a text as one line that no terminal takes for a command: unprintable characters are escaped.

    >>> printable("two\nlines")
    'two\\nlines'
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def readable(text: str) -> str:
    """Return a text fit for a message: printable, visible when it is empty, cut off when it is long."""
    escaped = printable(text[: _LONGEST + 1]) or '""'
    return escaped if len(escaped) <= _LONGEST else escaped[: _LONGEST - 1] + "…"


def shown(value: Any) -> str:
    """Return a value as the user could have written it, shortened.

    >>> shown({"axis": "x", "degrees": [1.5, None, True]})
    '{axis: "x", degrees: [1.5, null, true]}'
    """
    return readable(_written(value))


def suggestion(word: str, choices: Iterable[str]) -> str | None:
    """Return the choice that was probably meant, if any comes close: three of four letters.

    >>> suggestion("laod", ["load", "brick"]), suggestion("spring", ["damping"])
    ('load', None)
    """
    import difflib  # only a mistake needs it

    by_lower_case = {choice.lower(): choice for choice in islice(choices, _MOST_COMPARED)}
    close = difflib.get_close_matches(plain(word[:_LONGEST]).lower(), by_lower_case, n=1, cutoff=0.75)
    return by_lower_case[close[0]] if close else None


def did_you_mean(word: str, close: str) -> str:
    r"""Ask for what was probably meant, and name a character that only looks right.

    >>> did_you_mean("laod", "load"), did_you_mean("lo\u0430d", "load")
    ('did you mean `load`?', 'did you mean `load`, without U+0430 CYRILLIC SMALL LETTER A?')
    """
    less, more = first_odd(word, plainly=close), first_odd(close, plainly=word)
    differs = f", without {less}" if less is not None else f", with {more}" if more is not None else ""
    return f"did you mean `{readable(close)}`{differs}?"


def either(choices: Iterable[str]) -> str:
    """List alternatives.

    >>> either(["x", "y", "z"])
    'x, y or z'
    """
    *most, last = choices
    return f"{', '.join(most)} or {last}" if most else last


def meant(word: str, choices: Iterable[str], otherwise: str) -> str:
    """Say which of the choices was probably meant, or else list them all.

    >>> meant("rong", ["ring", "string"], "the shapes are")
    'did you mean `ring`?'
    >>> meant("sphere", ["ring", "block"], "the shapes are")
    'the shapes are ring, block'
    """
    choices = list(choices)
    close = suggestion(word, choices)
    return did_you_mean(word, close) if close is not None else f"{otherwise} {listed(choices)}"


def listed(choices: list[str], most: int = 20) -> str:
    """List names, and say how many more there are when there are many."""
    more = f" and {len(choices) - most} more" if len(choices) > most else ""
    return ", ".join(readable(choice) for choice in choices[:most]) + more


def _written(value: Any) -> str:
    """Write a value in YAML's flow style, as far as a message can use it."""
    if isinstance(value, str):
        return json.dumps(value[: _LONGEST + 1], ensure_ascii=False)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_written(inner)}" for key, inner in _first(value.items())) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_written(inner) for inner in _first(value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    return json.dumps(value)


def _first(values: Iterable[Any]) -> list[Any]:
    """Return as many values as can possibly be seen."""
    return [value for value, _ in zip(values, range(_LONGEST), strict=False)]
