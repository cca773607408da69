"""Names that a scene mentions but does not have; needs no atoms, so it is told before compiling."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from typing import Any

from atomsim.scene.declarations import sections, selecting_keys
from atomsim.scene.language import Scene
from atomsim.scene.language.names import normalised
from atomsim.scene.language.selection import SelectionSyntaxError, parse_selection
from atomsim.scene.mistakes.mistake import Mistake
from atomsim.scene.mistakes.wording import meant, readable
from atomsim.scene.source import KeyPath, Source
from atomsim.scene.yaml.tree import Node


def check_references(data: dict[str, Any], source: Source) -> list[Mistake]:
    """Find names that are no groups.

    Args:
        data: the plain data of a scene without nulls; what is malformed is left to validation.
        source: the places of the values.
    """
    groups = list(_mapping(data.get("groups")))
    if not groups:
        return []
    known = {"all", *groups}
    return [
        Mistake(source.mark(path), path, partial(_no_such_group, name, groups))
        for path, name in [*_selected(data), *_colored(data), *_followed(data)]
        if name not in known
    ]


def _no_such_group(name: str, groups: list[str]) -> str:
    return f"there is no group `{readable(name)}`; {meant(name, groups, 'the groups are')}"


def check_silences(data: dict[str, Any], source: Source) -> list[Mistake]:
    """Find names of silences that lead to nothing in the scene.

    Args:
        data: the plain data of a scene without nulls; what is malformed is left to validation.
        source: the places of the values.
    """
    return [
        Mistake(source.mark(path), path, partial(_nothing_to_silence, section, text, data))
        for path, text in _silenced(data)
        for section, _, name in [normalised(text).partition(".")]
        if section not in Scene.model_fields
        or (section in sections() and name and name not in _mapping(data.get(section)))
    ]


def _nothing_to_silence(section: str, text: str, data: dict[str, Any]) -> str:
    if section not in Scene.model_fields:
        return f"there is no `{readable(section)}` in a scene; {meant(section, Scene.model_fields, 'paths begin with')}"
    there = _mapping(data.get(section))
    remedy = meant(text.partition(".")[2], there, f"the {section} are") if there else f"there are no {section}"
    return f"there is no `{readable(text)}`; {remedy}"


def check_deletions(root: Node) -> list[Mistake]:
    """Find names that a scene deletes and what it extends does not have.

    Args:
        root: the merged tree of a scene; what is malformed is left to validation.
    """
    mistakes = []
    for section in sections():
        named = root.child(section)
        entries = named.value if named is not None and isinstance(named.value, dict) else {}
        present = [name for name, node in entries.items() if node.value is not None]
        for name, node in entries.items():
            if node.deletes_nothing:
                mistakes.append(
                    Mistake(node.mark, (section, name), partial(_nothing_to_delete, section, name, present))
                )
    return mistakes


def _nothing_to_delete(section: str, name: str, present: list[str]) -> str:
    remedy = meant(name, present, f"the {section} are") if present else f"there are no {section}"
    return f"there is no `{readable(name)}` to delete; {remedy}"


def _selected(data: dict[str, Any]) -> Iterator[tuple[KeyPath, str]]:
    """Every group that a selection names."""
    for section, declared in sections().items():
        keys = dict.fromkeys(key for declaration in declared.declarations for key in selecting_keys(declaration))
        for name, declaration in _mapping(data.get(section)).items():
            for key in keys:
                for path, text in _texts(_mapping(declaration).get(key), (section, name, key)):
                    with suppress(SelectionSyntaxError):
                        yield path, parse_selection(text).group


def _colored(data: dict[str, Any]) -> Iterator[tuple[KeyPath, str]]:
    for text in _mapping(_mapping(data.get("render")).get("colors")):
        with suppress(SelectionSyntaxError):
            yield ("render", "colors", text), parse_selection(text).group


def _followed(data: dict[str, Any]) -> Iterator[tuple[KeyPath, str]]:
    camera = _mapping(_mapping(data.get("render")).get("camera"))
    for key in ("follow", "close_up"):
        for path, text in _texts(camera.get(key), ("render", "camera", key)):
            with suppress(SelectionSyntaxError):
                yield path, parse_selection(text).group


def _silenced(data: dict[str, Any]) -> Iterator[tuple[KeyPath, str]]:
    """Every path that a silence names."""
    for code, silences in _mapping(data.get("silence")).items():
        listed = silences if isinstance(silences, list) else [silences]
        for index, silence in enumerate(listed):
            place: KeyPath = ("silence", code, index) if silences is listed else ("silence", code)
            yield from _texts(_mapping(silence).get("names"), (*place, "names"))


def _texts(value: Any, path: KeyPath) -> Iterator[tuple[KeyPath, str]]:
    """Every text in a text or in nested lists of texts."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from _texts(inner, (*path, index))


def _mapping(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
