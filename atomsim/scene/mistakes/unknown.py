"""Keys and words that the language does not have, and which of those it has was meant."""

from __future__ import annotations

from itertools import islice
from typing import Any, NamedTuple

from atomsim.scene.declarations import (
    Section,
    declaration_at,
    discriminator,
    inner_declarations,
    sections,
    selecting_keys,
)
from atomsim.scene.field_docs import descriptions, form
from atomsim.scene.language import Declaration, Scene
from atomsim.scene.mistakes.lookalikes import first_odd
from atomsim.scene.mistakes.numbers import around
from atomsim.scene.mistakes.wording import (
    did_you_mean,
    either,
    listed,
    meant,
    readable,
    shown,
    suggestion,
)
from atomsim.scene.overrides import is_setting
from atomsim.scene.source import KeyPath, Source, dotted

MOST_LOOKED_AT = 1000
"""Of more mistakes of one kind than this, the others are taken as they stand."""


class Written(NamedTuple):
    """The key under which a declaration says of which kind it is, perhaps misspelt, and the word that is meant."""

    key: str
    word: str | None


def meant_key(key: str, keys: list[str]) -> str | None:
    """Return which of the keys an unknown key was meant to be."""
    before_colon = _before_colon(key)
    return before_colon if before_colon in keys else suggestion(key, keys)


def _before_colon(key: str) -> str | None:
    """Return the key that was taken for a longer one because no space follows its colon: `count` of `count:20`."""
    before, colon, _ = key.partition(":")
    return before.strip(" ") if colon else None


def written_word(declared: dict[str, Any], section: Section) -> Written | None:
    """Find out of which kind a declaration was meant to be.

    Args:
        declared: what stands under the name; there is no valid word under the key that chooses.
        section: where it is declared.
    """
    assert section.key is not None  # else there is nothing to choose
    if section.key in declared:
        return Written(section.key, _word(declared[section.key], section))
    known = {key for declaration in section.declarations for key in declaration.fields_by_key()}
    unknown = list(islice((key for key in declared if key not in known), MOST_LOOKED_AT))
    for key in unknown:
        if _before_colon(key) == section.key:
            return Written(key, _word(key.partition(":")[2].strip(), section))
    close = suggestion(section.key, unknown)
    by_value = (key for key in unknown if isinstance(declared[key], str) and declared[key] in section.words)
    misspelt = close if close is not None else next(by_value, None)
    return Written(misspelt, _word(declared[misspelt], section)) if misspelt is not None else None


def _word(value: Any, section: Section) -> str | None:
    if not isinstance(value, str):
        return None
    return value if value in section.words else suggestion(value, section.words)


def value_at(path: KeyPath, data: Any) -> Any:
    """Return the value at a path, None where there is none."""
    for part in path:
        data = data.get(part) if isinstance(data, dict) else data[part]
    return data


def missing_word(section: Section, written: Written | None, path: KeyPath, data: dict[str, Any], source: Source) -> str:
    """Complain that nothing says of which kind a declaration is, or that the key which should is misspelt."""
    if written is None:
        return f"missing: {either(section.words)}{misnamed(path, data, source)}"
    return _unknown(written.key, _written_right(written.key, str(section.key)))


def unknown_word(section: Section, declared: dict[str, Any]) -> str:
    """Complain about the word that chooses a declaration: the shape, rule or kind."""
    value = declared[str(section.key)]
    if not isinstance(value, str):
        return f"needs {either(section.words)} (got {shown(value)})"
    return f"unknown {section.key} {shown(value)}; {meant(value, section.words, f'the {section.key}s are')}"


def unknown_key(path: KeyPath, data: dict[str, Any], source: Source) -> str:
    """Complain about a key that its declaration does not have."""
    key = str(path[-1])
    declaration = declaration_at(path[:-1], data)
    keys = list(descriptions(declaration)) if declaration is not None else []
    number = _number_around(key, value_at(path[:-1], data), declaration)
    if number is not None:
        return _unknown(key, number)
    close = meant_key(key, keys)
    chosen = discriminator(declaration) if declaration is not None else None
    words = sections()[str(path[0])].words if chosen is not None else {}
    owners = [word for word, other in words.items() if key in other.fields_by_key()]
    mark, reopened = source.mark(path), source.mark(path[:-1])
    if mark.file != reopened.file and not is_setting(mark) and (owners or close is None):
        return _unknown(key, f"to drop what is extended, write `{readable(key)}: null` in {reopened.file}")
    there = f"the keys of {' '.join(chosen)} are" if chosen is not None else "the keys here are"
    if owners and chosen is not None:
        return _unknown(key, f"it belongs to {chosen[0]} {either(owners)}; {there} {', '.join(keys)}")
    odd = first_odd(key)
    if close is None and odd is not None:
        return _unknown(key, f"{odd} is not what it looks like")
    home = _home(key, value_at(path, data), declaration)
    if home is not None or close is not None:
        return _unknown(key, home or _written_right(key, str(close)))
    return _unknown(key, f"{there} {listed(keys)}")


def _unknown(key: str, remedy: str) -> str:
    return f"unknown key `{readable(key)}`; {remedy}"


def _written_right(key: str, meant: str) -> str:
    """Say how a misspelt key is written."""
    if _before_colon(key) == meant:
        return f"write `{meant}: ` with a space after the colon"
    return did_you_mean(key, meant)


def _home(key: str, value: Any, declaration: type[Declaration] | None) -> str | None:
    """Say where a key belongs that stands too far out, or how what it selects is selected here."""
    if declaration is None:
        return None
    homes = [dotted(path) for path, inner in inner_declarations(declaration) if key in inner.fields_by_key()]
    if homes:
        return f"it belongs under {either(f'`{home}`' for home in homes)}"
    if declaration is Scene and isinstance(value, dict):
        for name, section in sections().items():
            if section.key is not None and value.get(section.key) in section.words:
                return f"indent it under `{name}`"
    here = selecting_keys(declaration)
    if here and any(key in selecting_keys(other) for section in sections().values() for other in section.declarations):
        return f"atoms are selected by {either(f'`{name}`' for name in here)} here"
    return None


def _number_around(key: str, declared: dict[str, Any], declaration: type[Declaration] | None) -> str | None:
    """Say how a number or a list is written of which this key is only a part: {count: 1,000} or {step: 3, 0, 0}."""
    if declared[key] is not None or not around(key):
        return None
    before = list(declared)[: list(declared).index(key)]
    number = next((other for other in reversed(before) if declared[other] is not None), None)
    is_list = declaration is not None and number in declaration.fields_by_key() and form(declaration, number)[0] == "["
    return around(key, in_list=is_list)


def misnamed(path: KeyPath, data: dict[str, Any], source: Source) -> str:
    """Say which declaration of another file was probably meant to be changed, where a name is new."""
    here = source.mark(path).file
    section = path[:-1]
    inherited = [name for name in data[str(section[0])] if source.mark((*section, name)).file != here]
    close = suggestion(str(path[-1]), inherited)
    return f"; did you mean `{readable(close)}`?" if close is not None else ""
