"""The findings of pydantic in the words of the scene language; knows the data model, not how scenes are read."""

from __future__ import annotations

import re
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from atomsim.errors import Problem
from atomsim.scene.css_colors import CSS_COLORS
from atomsim.scene.field_docs import declaration_at, descriptions, discriminator, words_in
from atomsim.scene.overrides import is_setting
from atomsim.scene.scalars import resolve
from atomsim.scene.source import Path, Source
from atomsim.scene.wording import either, meant, readable, shown, suggestion

_TAGGED_SECTIONS = ("groups", "bonds", "forces")
"""Sections below whose names pydantic puts the word that chose the declaration: (groups, ring, *ring*, count)."""

_BOOLEANS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false", "n": "false"}


def complaints(error: ValidationError, data: Any, source: Source) -> list[Problem]:
    """Translate everything that pydantic found.

    Args:
        error: what validating the scene raised.
        data: the plain data that were validated.
        source: the places of the values.
    """
    problems = [_complaint(found, data, source) for found in error.errors(include_url=False)]
    return list(dict.fromkeys(problems))


def _complaint(found: ErrorDetails, data: Any, source: Source) -> Problem:
    path = _path(found, data)
    value = _value(path, data)
    match found["type"]:
        case "missing" if isinstance(found["loc"][-1], int):
            message = f"needs {int(found['loc'][-1]) + 1} entries (got {shown(value)})"
        case "missing":
            message = _missing(path, data)
        case "extra_forbidden":
            message = _unknown_key(path, data, source)
        case "union_tag_not_found" | "union_tag_invalid":
            return _unknown_word(found, path, data, source)
        case "model_type" | "model_attributes_type" | "dict_type":
            message = _no_mapping(path, value, data)
        case "name":
            message = f"{found['msg']} (got {shown(path[-1])})"
        case kind if kind in _SAYS_ALL:
            message = found["msg"]
        case kind:
            needs = _NEEDS[kind].format(**found.get("ctx", {})) if kind in _NEEDS else found["msg"]
            message = f"{needs} (got {shown(value)}{_hint(kind, value)})"
    return source.problem(path, message)


_SAYS_ALL = ("one_of", "min_gap", "push_rounds", "zero_axis", "selection_syntax")
"""Findings of the language itself that say in their own words what they got."""

_NEEDS = {
    "float_type": "needs a number",
    "finite_number": "needs a finite number",
    "int_type": "needs a whole number",
    "bool_type": "needs true or false",
    "string_type": "needs text",
    "tuple_type": "needs a list",
    "literal_error": "needs {expected}",
    "greater_than": "needs a number above {gt:g}",
    "greater_than_equal": "needs {ge:g} or more",
    "less_than_equal": "needs {le:g} or less",
    "too_short": "needs at least {min_length} in it",
    "too_long": "needs {max_length} entries",
}
"""What a value needs, by pydantic's name of the finding."""


def _path(found: ErrorDetails, data: Any) -> Path:
    """Return where the user wrote it: without pydantic's marks of keys, chosen words and items made of scalars."""
    loc = found["loc"][:-1] if found["type"] == "name" else found["loc"]
    if len(loc) > 2 and loc[0] in _TAGGED_SECTIONS:
        loc = (*loc[:2], *loc[3:])
    path: list[str | int] = []
    for part in loc:
        is_key = isinstance(data, dict) and isinstance(part, str)
        is_index = isinstance(data, list) and isinstance(part, int) and part < len(data)
        if is_key or is_index:
            path.append(part)
            data = _value((part,), data)
    return tuple(path)


def _value(path: Path, data: Any) -> Any:
    """Return the value at a path, None where there is none."""
    for part in path:
        data = data.get(part) if isinstance(data, dict) else data[part]
    return data


def _missing(path: Path, data: Any) -> str:
    declaration = declaration_at(path[:-1], data)
    said = descriptions(declaration)[str(path[-1])].rstrip(".") if declaration is not None else ""
    is_null = path[-1] in _value(path[:-1], data)
    return f"needs a value (got null): {said}" if is_null else f"missing: {said}"


def _unknown_key(path: Path, data: Any, source: Source) -> str:
    key = str(path[-1])
    declaration = declaration_at(path[:-1], data)
    keys = list(descriptions(declaration)) if declaration is not None else []
    message = f"unknown key `{readable(key)}`; "
    before_colon = key.partition(":")[0].strip()
    if ":" in key and before_colon in keys:
        return f"{message}write `{before_colon}: ` with a space after the colon"
    mark, reopened = source.mark(path), source.mark(path[:-1])
    if mark.file != reopened.file and not is_setting(mark):
        return f"{message}to drop what is extended, write `{readable(key)}: null` in {reopened.file}"
    word = discriminator(declaration) if declaration is not None else None
    return message + meant(key, keys, f"the keys of {word[0]} {word[1]} are" if word else "the keys here are")


def _unknown_word(found: ErrorDetails, path: Path, data: Any, source: Source) -> Problem:
    """Complain about the word that chooses a declaration: the shape, rule or kind."""
    key = found["ctx"]["discriminator"].strip("'")
    words = words_in(str(path[0]))
    declared = _value(path, data)
    if key not in declared:
        return source.problem((*path, key), f"missing: {either(words)}")
    value = declared[key]
    if not isinstance(value, str):
        return source.problem((*path, key), f"needs {either(words)} (got {shown(value)})")
    remedy = meant(value, words, f"the {key}s are")
    return source.problem((*path, key), f"unknown {key} {shown(value)}; {remedy}")


def _no_mapping(path: Path, value: Any, data: Any) -> str:
    declaration = declaration_at(path, data)
    if declaration is not None:
        keys = ", ".join(f"{key}: …" for key in descriptions(declaration))
        return f"needs keys: {{{keys}}} (got {shown(value)})"
    if len(path) == 1 or path == ("render", "colors"):
        return f"needs a mapping from names to declarations (got {shown(value)})"
    return f"needs a declaration: a mapping of keys (got {shown(value)})"


def _hint(kind: str, value: Any) -> str:
    """Say how to write what was probably meant."""
    if kind in ("float_type", "int_type") and isinstance(value, str):
        if isinstance(resolve(value), (int, float)) and not isinstance(resolve(value), bool):
            return "; remove the quotes"
        plain = re.sub(r"^([-+]?)0+(?=[0-9])", r"\1", value.replace("_", "").replace(",", "."))
        return f"; write {plain}" if plain != value and isinstance(resolve(plain), (int, float)) else ""
    if kind == "int_type" and isinstance(value, float) and value.is_integer():
        return f"; write {int(value)}"
    if kind == "bool_type" and isinstance(value, str):
        word = _BOOLEANS.get(value.lower(), value.lower())
        return f"; write {word}" if word in ("true", "false") else ""
    if kind == "color" and isinstance(value, str):
        close = suggestion(value, CSS_COLORS)
        return f"; did you mean {close}?" if close is not None else ""
    return ""
