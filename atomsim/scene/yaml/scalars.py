"""What a plain word of YAML means: the core schema of YAML 1.2 without its surprises; knows no documents."""

from __future__ import annotations

import re

_INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]*)")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|(?:0|[1-9][0-9]*)(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_WORDS = {"": None, "~": None, "null": None, "true": True, "false": False}
_LONGEST_NUMBER = 300

NUMBER = re.compile(f"(?:{_FLOAT.pattern}|{_NOT_FINITE.pattern})$")
"""Every plain word that means a number."""

NUMBER_STARTS = "-+.0123456789"
"""The characters a number begins with."""


def resolve(text: str) -> str | int | float | bool | None:
    """Return the value of a plain (unquoted) scalar.

    Only `true` and `false` are booleans; only `null`, `~` and nothing are null. Words whose meaning differs between
    YAML readers (`yes`, `010`, `0x1F`, `1_000`, `1:30`, dates) are text; so is a number of over 300 characters.

    >>> [resolve(text) for text in ("1e-3", "-.5", "12", "yes", "010", "~")]
    [0.001, -0.5, 12, 'yes', '010', None]
    """
    if text in _WORDS:
        return _WORDS[text]
    if text[0] not in NUMBER_STARTS or len(text) > _LONGEST_NUMBER:
        return text
    if _INTEGER.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _NOT_FINITE.fullmatch(text):
        return float(text.replace(".", ""))
    return text


def is_number(text: str) -> bool:
    """Return whether a plain scalar is a number."""
    value = resolve(text)
    return isinstance(value, (int, float)) and not isinstance(value, bool)
