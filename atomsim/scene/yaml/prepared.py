"""A text as a parser of YAML 1.1 has to see it to read what YAML 1.2 and JSON mean, character for character as long."""

from __future__ import annotations

import json
import re

NO_BREAKS = "\x85\u2028\u2029\ufeff"
"""What a parser of YAML 1.1 takes for the end of a line or of nothing, and YAML 1.2 and JSON for a character."""

_PRIVATE = range(0xE000, 0xF900)
"""Characters without a meaning, which stand in for others while a text is parsed."""

_JSON_ONLY = re.compile(r"\t|\\u[dD][89abAB]")
_JSON_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\t')
_JSON_ESCAPE = re.compile(r"\\(?:(u[dD][89abAB][0-9a-fA-F]{2}\\u[dD][c-fC-F][0-9a-fA-F]{2})|.)")


def prepared(text: str) -> tuple[str, dict[int, str]]:
    """Return a text for the parser, and how to translate back what it makes of it.

    Every character that counts stays in its line and column.
    """
    text = _json_as_yaml(text)
    found = [sign for sign in NO_BREAKS if sign in text]
    if not found:
        return text, {}
    unused = (chr(code) for code in _PRIVATE if chr(code) not in text)
    stand_ins = dict(zip(found, unused, strict=False))
    there = {ord(sign): stand_in for sign, stand_in in stand_ins.items()}
    return text.translate(there), {ord(stand_in): sign for sign, stand_in in stand_ins.items()}


def _json_as_yaml(text: str) -> str:
    """Write JSON that is no YAML as YAML: tabs between its parts, and characters escaped as two halves."""
    if not text.lstrip().startswith("{") or _JSON_ONLY.search(text) is None:
        return text
    try:
        json.loads(text)
    except (ValueError, RecursionError):
        return text
    return _JSON_TOKEN.sub(lambda token: _yaml_token(token[0]), text)


def _yaml_token(token: str) -> str:
    """Write a text of JSON with whole characters, and blanks behind it where it became shorter; a tab as a blank."""
    if token == "\t":
        return " "
    whole = _JSON_ESCAPE.sub(lambda escape: json.loads(f'"{escape[0]}"') if escape[1] else escape[0], token)
    return whole + " " * (len(token) - len(whole))
