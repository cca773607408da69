"""The findings of pydantic in the words of the scene language, each at the place where the user wrote it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from atomsim.scene.declarations import declaration_at, sections
from atomsim.scene.field_docs import descriptions, form
from atomsim.scene.language import Scene
from atomsim.scene.mistakes.hints import begin_with, hint, hint_of_list, hint_of_text
from atomsim.scene.mistakes.mistake import Mistake
from atomsim.scene.mistakes.unknown import (
    MOST_LOOKED_AT,
    Written,
    meant_key,
    misnamed,
    missing_word,
    unknown_key,
    unknown_word,
    value_at,
    written_word,
)
from atomsim.scene.mistakes.wording import shown
from atomsim.scene.source import KeyPath, Source

_NO_WORD = ("union_tag_not_found", "union_tag_invalid")
"""Findings of a declaration whose kind is not known; pydantic looks no further into it."""

_SAYS_ALL = ("together", "code", "min_gap", "push_rounds", "zero_axis", "selection_syntax")
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

_WORDS = {"axis": "xyz", "rest": ("initial",)}
"""Words that stand for a value, by the finding of the language that it is none."""

_Found = dict[tuple[str, KeyPath], ErrorDetails]
"""Findings by their kind and place."""


def complaints(error: ValidationError, data: dict[str, Any], source: Source) -> list[Mistake]:
    """Translate everything that pydantic found.

    A declaration whose kind is misspelt is looked at once more, as what it was meant to be.

    Args:
        error: what validating the scene raised.
        data: the plain data that were validated.
        source: the places of the values.
    """
    found = _by_place(error, data)
    no_words = [path for kind, path in found if kind in _NO_WORD]
    written = {path: _written_word(path, data) for path in no_words[:MOST_LOOKED_AT]}
    mistakes = [_without_word(path, written.get(path), data, source) for path in no_words]
    meant = _as_meant(written, data)
    if meant != data:
        try:
            Scene.model_validate(meant)
            found = {}
        except ValidationError as inner:
            found = _by_place(inner, meant)
    for key in _missing_though_misspelt(found, meant):
        del found[key]
    mistakes += [
        Mistake(source.mark(path), path, partial(_message, details, path, meant, source))
        for (kind, path), details in found.items()
        if kind not in _NO_WORD
    ]
    return mistakes


def _by_place(error: ValidationError, data: dict[str, Any]) -> _Found:
    """Return the findings, one of each kind at a place, and none that only echoes others."""
    found = {(details["type"], _path(details, data)): details for details in error.errors(include_url=False)}
    return {(kind, path): details for (kind, path), details in found.items() if not _is_echo(details, path, data)}


def _is_echo(details: ErrorDetails, path: KeyPath, data: Any) -> bool:
    """Tell whether a list is called too short only because its items, which are complained of too, did not count."""
    if details["type"] != "too_short":
        return False
    value = value_at(path, data)
    return isinstance(value, list) and len(value) >= details["ctx"]["min_length"]


def _written_word(path: KeyPath, data: dict[str, Any]) -> Written | None:
    return written_word(value_at(path, data), sections()[str(path[0])])


def _without_word(path: KeyPath, written: Written | None, data: dict[str, Any], source: Source) -> Mistake:
    """Complain about a declaration that does not say of which kind it is, or of one that there is not."""
    section, declared = sections()[str(path[0])], value_at(path, data)
    if section.key in declared:
        at = (*path, str(section.key))
        return Mistake(source.mark(at), at, partial(unknown_word, section, declared))
    at = (*path, written.key if written is not None else str(section.key))
    return Mistake(source.mark(at), at, partial(missing_word, section, written, path, data, source))


def _as_meant(words: dict[KeyPath, Written | None], data: dict[str, Any]) -> dict[str, Any]:
    """Return the data in which declarations say of which kind they are meant to be, as far as that is known."""
    meant = {
        key: dict(value) if key in sections() and isinstance(value, dict) else value for key, value in data.items()
    }
    for (section, name), written in words.items():
        if written is not None and written.word is not None:
            kept = {key: value for key, value in data[str(section)][name].items() if key != written.key}
            meant[str(section)][name] = {sections()[str(section)].key: written.word, **kept}
    return meant


def _missing_though_misspelt(found: _Found, data: dict[str, Any]) -> Iterator[tuple[str, KeyPath]]:
    """Yield the findings of keys that are missing only because they are misspelt, which is complained of too."""
    missing: dict[KeyPath, set[str]] = {}
    for kind, path in found:
        if kind == "missing" and path and isinstance(path[-1], str):
            missing.setdefault(path[:-1], set()).add(path[-1])
    unknown = ((path[:-1], str(path[-1])) for kind, path in found if kind == "extra_forbidden")
    beside = [(parent, key) for parent, key in unknown if parent in missing][:MOST_LOOKED_AT]
    found_out = set()
    for parent, key in beside:
        declaration = declaration_at(parent, data)
        meant = meant_key(key, list(descriptions(declaration))) if declaration is not None else None
        if meant in missing[parent]:
            found_out.add(("missing", (*parent, str(meant))))
    yield from found_out


def _message(details: ErrorDetails, path: KeyPath, data: dict[str, Any], source: Source) -> str:
    value = value_at(path, data)
    match details["type"]:
        case "missing" if isinstance(details["loc"][-1], str):
            return _missing(path, data)
        case "missing" | "too_long" | "tuple_type":
            return f"needs {_form(path, data)} (got {shown(value)}{hint_of_list(value)})"
        case "extra_forbidden":
            return unknown_key(path, data, source)
        case "model_type" | "model_attributes_type" | "dict_type":
            return (
                f"needs a mapping {_keys(path, data)} (got {shown(value)}{_indentation(path) or hint_of_text(value)})"
            )
        case "name":
            return f"{details['msg']} (got {shown(path[-1])})"
        case "one_of":
            return details["msg"] + (misnamed(path, data, source) or _first_way(details, path, data))
        case kind if kind in _SAYS_ALL:
            return details["msg"]
        case kind:
            needs = _NEEDS[kind].format(**_context(details)) if kind in _NEEDS else details["msg"]
            return f"{needs} (got {shown(value)}{hint(kind, path, value, _choices(details))})"


def _context(details: ErrorDetails) -> dict[str, Any]:
    """Return the bounds and choices that a finding mentions, as a user writes them."""
    given = details.get("ctx", {})
    context = {key: f"{value:g}" if isinstance(value, float) else value for key, value in given.items()}
    if "expected" in context:
        context["expected"] = context["expected"].replace("'", "")
    return context


def _choices(details: ErrorDetails) -> Sequence[str]:
    """Return the words of which one may stand where something else does."""
    if details["type"] == "literal_error":
        return re.findall("'([^']*)'", str(details["ctx"]["expected"]))
    return _WORDS.get(details["type"], ())


def _path(details: ErrorDetails, data: Any) -> KeyPath:
    """Return where the user wrote it: without pydantic's marks of keys, chosen words and items made of scalars.

    The word that chooses a declaration is put into the path of whatever is inside: (groups, hoop, *ring*, count).
    """
    loc = details["loc"][:-1] if details["type"] in ("name", "code") else details["loc"]
    if len(loc) > 2 and _chosen_by(loc) is not None:
        loc = (*loc[:2], *loc[3:])
    path: list[str | int] = []
    for part in loc:
        is_key = isinstance(data, dict) and isinstance(part, str)
        is_index = isinstance(data, list) and isinstance(part, int) and part < len(data)
        if is_key or is_index:
            path.append(part)
            data = value_at((part,), data)
    return tuple(path)


def _chosen_by(path: KeyPath) -> str | None:
    """Return the key whose word chooses a declaration in the section of a path, if there is one."""
    section = sections().get(str(path[0])) if path else None
    return section.key if section is not None else None


def _missing(path: KeyPath, data: Any) -> str:
    declaration = declaration_at(path[:-1], data)
    said = descriptions(declaration)[str(path[-1])].rstrip(".") if declaration is not None else ""
    is_null = path[-1] in value_at(path[:-1], data)
    begin = begin_with(declaration, str(path[-1]), data) if declaration is not None else ""
    return f"needs a value (got null): {said}" if is_null else f"missing: {said}{begin}"


def _first_way(details: ErrorDetails, path: KeyPath, data: dict[str, Any]) -> str:
    """Say how to begin where a declaration says none of the keys of which it needs one."""
    declaration, key = declaration_at(path, data), details["ctx"]["first"]
    is_said = details["ctx"]["found"] != "none"
    return "" if is_said or declaration is None else begin_with(declaration, key, data)


def _form(path: KeyPath, data: Any) -> str:
    """Return how a list is written: the value under a key, or an item in it."""
    key = next(place for place in range(len(path) - 1, -1, -1) if isinstance(path[place], str))
    declaration = declaration_at(path[:key], data)
    return form(declaration, str(path[key]), path[key + 1 :]) if declaration is not None else "a list"


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
    is_key = any(path[-1] in declaration.fields_by_key() for declaration in section.declarations) if section else False
    return "; indent it under the name" if len(path) == 2 and is_key else ""
