"""The findings of pydantic in the words of the scene language; knows the data model, not how scenes are read."""

from __future__ import annotations

import re
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from atomsim.errors import Problem
from atomsim.scene.declarations import declaration_at, discriminator, sections
from atomsim.scene.field_docs import descriptions, form
from atomsim.scene.language.css_colors import CSS_COLORS
from atomsim.scene.mistakes.wording import NEEDS_BRACKETS, either, meant, readable, shown, suggestion
from atomsim.scene.overrides import is_setting
from atomsim.scene.source import KeyPath, Source
from atomsim.scene.yaml.scalars import is_number

_BOOLEANS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false", "n": "false"}


def complaints(error: ValidationError, data: Any, source: Source) -> list[Problem]:
    """Translate everything that pydantic found.

    Args:
        error: what validating the scene raised.
        data: the plain data that were validated.
        source: the places of the values.
    """
    findings = [found for found in error.errors(include_url=False) if not _is_echo(found, data)]
    last_by_place = {(found["type"], _path(found, data)): found for found in findings}
    return [_complaint(found, data, source) for found in last_by_place.values()]


def _is_echo(found: ErrorDetails, data: Any) -> bool:
    """Tell whether a list is called too short only because its items, which are complained of too, did not count."""
    value = _value(_path(found, data), data)
    return found["type"] == "too_short" and isinstance(value, list) and len(value) >= found["ctx"]["min_length"]


def _complaint(found: ErrorDetails, data: Any, source: Source) -> Problem:
    path = _path(found, data)
    value = _value(path, data)
    match found["type"]:
        case "union_tag_not_found" | "union_tag_invalid":
            return _unknown_word(found, path, data, source)
        case "missing" if isinstance(found["loc"][-1], str):
            message = _missing(path, data)
        case "missing" | "too_long" | "tuple_type":
            message = f"needs {_form(found, path, data)} (got {shown(value)})"
        case "extra_forbidden":
            message = _unknown_key(path, data, source)
        case "model_type" | "model_attributes_type" | "dict_type":
            message = f"needs a mapping {_keys(path, data)} (got {shown(value)}{_indentation(path)})"
        case "name":
            message = f"{found['msg']} (got {shown(path[-1])})"
        case "one_of":
            message = found["msg"] + _misnamed(path, data, source)
        case kind if kind in _SAYS_ALL:
            message = found["msg"]
        case kind:
            needs = _NEEDS[kind].format(**_context(found)) if kind in _NEEDS else found["msg"]
            message = f"{needs} (got {shown(value)}{_hint(kind, path, value)})"
    return source.problem(path, message)


def _context(found: ErrorDetails) -> dict[str, Any]:
    """Return the bounds and choices that a finding mentions, as a user writes them."""
    given = found.get("ctx", {})
    context = {key: f"{value:g}" if isinstance(value, float) else value for key, value in given.items()}
    if "expected" in context:
        context["expected"] = context["expected"].replace("'", "")
    return context


_SAYS_ALL = ("code", "min_gap", "push_rounds", "zero_axis", "selection_syntax")
"""Findings of the language itself that say in their own words what they got."""

_NEEDS = {
    "float_type": "needs a number",
    "finite_number": "needs a finite number",
    "int_type": "needs a whole number",
    "bool_type": "needs true or false",
    "string_type": "needs text",
    "literal_error": "needs {expected}",
    "greater_than": "needs a number above {gt}",
    "greater_than_equal": "needs {ge} or more",
    "less_than_equal": "needs {le} or less",
    "too_short": "needs {min_length} or more entries",
}
"""What a value needs, by pydantic's name of the finding."""


def _path(found: ErrorDetails, data: Any) -> KeyPath:
    """Return where the user wrote it: without pydantic's marks of keys, chosen words and items made of scalars.

    The word that chooses a declaration is put into the path of whatever is inside: (groups, hoop, *ring*, count).
    """
    loc = found["loc"][:-1] if found["type"] in ("name", "code") else found["loc"]
    if len(loc) > 2 and _chosen_by(loc) is not None:
        loc = (*loc[:2], *loc[3:])
    path: list[str | int] = []
    for part in loc:
        is_key = isinstance(data, dict) and isinstance(part, str)
        is_index = isinstance(data, list) and isinstance(part, int) and part < len(data)
        if is_key or is_index:
            path.append(part)
            data = _value((part,), data)
    return tuple(path)


def _chosen_by(path: KeyPath) -> str | None:
    """Return the key whose word chooses a declaration in the section of a path, if there is one."""
    section = sections().get(str(path[0])) if path else None
    return section.key if section is not None else None


def _value(path: KeyPath, data: Any) -> Any:
    """Return the value at a path, None where there is none."""
    for part in path:
        data = data.get(part) if isinstance(data, dict) else data[part]
    return data


def _missing(path: KeyPath, data: Any) -> str:
    declaration = declaration_at(path[:-1], data)
    said = descriptions(declaration)[str(path[-1])].rstrip(".") if declaration is not None else ""
    is_null = path[-1] in _value(path[:-1], data)
    return f"needs a value (got null): {said}" if is_null else f"missing: {said}"


def _form(found: ErrorDetails, path: KeyPath, data: Any) -> str:
    """Return how a list is written, or at least how long it is."""
    declaration = declaration_at(path[:-1], data)
    if declaration is not None:
        return form(declaration, str(path[-1]))
    match found:
        case {"type": "missing", "loc": (*_, int(last))}:
            return f"{last + 1} entries"
        case {"type": "too_long", "ctx": {"max_length": n_entries}}:
            return f"{n_entries} entries"
    return "a list"


def _unknown_key(path: KeyPath, data: Any, source: Source) -> str:
    key = str(path[-1])
    declaration = declaration_at(path[:-1], data)
    keys = list(descriptions(declaration)) if declaration is not None else []
    message = f"unknown key `{readable(key)}`; "
    before_colon = key.partition(":")[0].strip()
    if ":" in key and before_colon in keys:
        return f"{message}write `{before_colon}: ` with a space after the colon"
    if is_number(key) and _value(path, data) is None:
        return message + NEEDS_BRACKETS
    chosen = discriminator(declaration) if declaration is not None else None
    words = sections()[str(path[0])].words if chosen is not None else {}
    owners = [word for word, other in words.items() if key in other.model_fields]
    mark, reopened = source.mark(path), source.mark(path[:-1])
    if mark.file != reopened.file and not is_setting(mark) and (owners or suggestion(key, keys) is None):
        return f"{message}to drop what is extended, write `{readable(key)}: null` in {reopened.file}"
    if chosen is None:
        return message + meant(key, keys, "the keys here are")
    kind, word = chosen
    if owners:
        return f"{message}it belongs to {kind} {either(owners)}; the keys of {kind} {word} are {', '.join(keys)}"
    return message + meant(key, keys, f"the keys of {kind} {word} are")


def _misnamed(path: KeyPath, data: Any, source: Source) -> str:
    """Say which declaration of another file was probably meant to be changed, where a name is new."""
    here = source.mark(path).file
    section = path[:-1]
    inherited = [name for name in _value(section, data) if source.mark((*section, name)).file != here]
    close = suggestion(str(path[-1]), inherited)
    return f"; did you mean `{readable(close)}`?" if close is not None else ""


def _unknown_word(found: ErrorDetails, path: KeyPath, data: Any, source: Source) -> Problem:
    """Complain about the word that chooses a declaration: the shape, rule or kind."""
    key = found["ctx"]["discriminator"].strip("'")
    words = list(sections()[str(path[0])].words)
    declared = _value(path, data)
    if key not in declared:
        return source.problem((*path, key), f"missing: {either(words)}{_misnamed(path, data, source)}")
    value = declared[key]
    if not isinstance(value, str):
        return source.problem((*path, key), f"needs {either(words)} (got {shown(value)})")
    remedy = meant(value, words, f"the {key}s are")
    return source.problem((*path, key), f"unknown {key} {shown(value)}; {remedy}")


def _keys(path: KeyPath, data: Any) -> str:
    """Return how a mapping is written."""
    declaration = declaration_at(path, data)
    if declaration is not None:
        return f"{{{', '.join(f'{key}: …' for key in descriptions(declaration))}}}"
    chosen_by = _chosen_by(path) if len(path) > 1 else None
    return f"{{{chosen_by}: …}}" if chosen_by is not None else "of names, `name: …`"


def _indentation(path: KeyPath) -> str:
    """Say where a key belongs that stands where a name is expected."""
    section = sections().get(str(path[0]))
    is_key = any(path[-1] in declaration.model_fields for declaration in section.declarations) if section else False
    return "; indent it under the name" if len(path) == 2 and is_key else ""


def _hint(kind: str, path: KeyPath, value: Any) -> str:
    """Say how to write what was probably meant."""
    if kind == "string_type" and len(path) == 1 and not isinstance(value, (dict, list)):
        return f'; write "{shown(value)}"'
    if kind == "version" and str(value) in ("1", "1.0"):
        return "; remove the quotes" if value == "1" else "; write 1"
    if kind in ("float_type", "int_type") and isinstance(value, str):
        if is_number(value):
            return "; remove the quotes"
        plain = re.sub(r"^([-+]?)0+(?=[0-9])", r"\1", value.replace("_", "").replace(",", "."))
        return f"; write {plain}" if plain != value and is_number(plain) else ""
    if kind == "int_type" and isinstance(value, float) and value.is_integer():
        return f"; write {int(value)}"
    if kind == "bool_type" and isinstance(value, str):
        word = _BOOLEANS.get(value.lower(), value.lower())
        return f"; write {word}" if word in ("true", "false") else ""
    if kind == "color" and isinstance(value, str):
        close = suggestion(value, CSS_COLORS)
        return f"; did you mean {close}?" if close is not None else ""
    return ""
