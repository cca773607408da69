"""The declarations of the scene language, found from the scene downwards: its sections, and what a path leads to."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeGuard, get_args, get_origin

from atomsim.scene.language import Declaration, Scene
from atomsim.scene.language.base import SelectionText
from atomsim.scene.source import KeyPath


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a scene in which things are declared by name: groups, bonds, collisions, forces.

    Attributes:
        key: the key whose word chooses a declaration among its kind (`shape`, `rule`, `kind`), or None.
        declarations: what may be declared.
    """

    key: str | None
    declarations: tuple[type[Declaration], ...]

    @property
    def words(self) -> dict[str, type[Declaration]]:
        """The words that choose a declaration, in the order of the language; none where there is nothing to choose."""
        chosen = ((discriminator(declaration), declaration) for declaration in self.declarations)
        return {word[1]: declaration for word, declaration in chosen if word is not None}


@functools.cache
def sections() -> dict[str, Section]:
    """Return every section of a scene by its key, in the order of the language."""
    return {
        key: _section(field.annotation)
        for key, field in Scene.fields_by_key().items()
        if get_origin(field.annotation) is dict
    }


def _section(annotation: Any) -> Section:
    declarations = tuple(_options(get_args(annotation)[1], None))
    chosen = discriminator(declarations[0])
    return Section(chosen[0] if chosen is not None else None, declarations)


@functools.cache
def declarations() -> dict[str, type[Declaration]]:
    """Return every declaration of the language by the name of its class, in alphabetical order, the scene last."""
    found: dict[str, type[Declaration]] = {}
    to_visit: list[type[Declaration]] = [Scene]
    while to_visit:
        declaration = to_visit.pop()
        if found.setdefault(declaration.__name__, declaration) is not declaration:
            raise TypeError(f"two declarations are called {declaration.__name__}")
        inner = (part for field in declaration.fields_by_key().values() for part in _parts(field.annotation))
        to_visit += [part for part in inner if is_declaration(part) and part not in found.values()]
    return {name: found[name] for name in sorted(found, key=lambda name: (name == "Scene", name))}


def discriminator(declaration: type[Declaration]) -> tuple[str, str] | None:
    """Return the key and the word by which a declaration is chosen among its kind: ("shape", "ring")."""
    for key, field in declaration.fields_by_key().items():
        words = get_args(field.annotation) if get_origin(field.annotation) is Literal else ()
        if field.is_required() and len(words) == 1 and isinstance(words[0], str):
            return key, words[0]
    return None


@functools.cache
def selecting_keys(declaration: type[Declaration]) -> tuple[str, ...]:
    """Return the keys under which a declaration selects atoms."""
    fields = declaration.fields_by_key().items()
    return tuple(key for key, field in fields if any(part == SelectionText for part in _parts(field.annotation)))


def inner_declarations(declaration: type[Declaration]) -> Iterator[tuple[KeyPath, type[Declaration]]]:
    """Yield, each once and with its path, what may be declared inside a declaration under keys of its own."""
    seen = {declaration}
    to_visit: list[tuple[KeyPath, type[Declaration]]] = [((), declaration)]
    for path, outer in to_visit:
        for key, field in outer.fields_by_key().items():
            for option in _options(field.annotation, None):
                if is_declaration(option) and option not in seen:
                    seen.add(option)
                    to_visit.append(((*path, key), option))
                    yield (*path, key), option


def is_mapping(declaration: type[Declaration], key: str) -> bool:
    """Tell whether further keys or names stand below a key of a declaration, and nothing else may."""
    options = _options(declaration.fields_by_key()[key].annotation, [])
    return any(get_origin(option) is dict or is_declaration(option) for option in options)


def is_declaration(option: Any) -> TypeGuard[type[Declaration]]:
    """Tell whether an annotation is a declaration."""
    return isinstance(option, type) and issubclass(option, Declaration)


def declaration_at(path: KeyPath, data: Any) -> type[Declaration] | None:
    """Return the declaration that a path leads to, as far as the data tell; None for lists, mappings and scalars.

    Args:
        path: keys and indices from the top of the scene.
        data: the plain data of the scene.
    """
    annotation: Any = Scene
    for part in path:
        annotation = _inside(annotation, data, part)
        data = _item(data, part)
    return _chosen(annotation, data)


def _inside(annotation: Any, data: Any, part: str | int) -> Any:
    """Return the annotation of what stands under a key or an index."""
    declaration = _chosen(annotation, data)
    if declaration is not None and part in declaration.fields_by_key():
        return declaration.fields_by_key()[str(part)].annotation
    for option in _options(annotation, data):
        if get_origin(option) is dict:
            return get_args(option)[1]
        if get_origin(option) is tuple and isinstance(part, int):
            return get_args(option)[0]
    return None


def _chosen(annotation: Any, data: Any) -> type[Declaration] | None:
    """Return the declaration among the options that the data name, or the only one."""
    options = _options(annotation, data)
    classes = [option for option in options if is_declaration(option)]
    if len(classes) == 1:
        return classes[0]
    for declaration in classes:
        key, word = discriminator(declaration) or ("", "")
        if _item(data, key) == word:
            return declaration
    return None


def _options(annotation: Any, data: Any) -> list[Any]:
    """Return the alternatives of an annotation, without `Annotated` and unions; one item may stand for a list."""
    is_lone = get_origin(annotation) is tuple and not isinstance(data, list)
    if get_origin(annotation) is Annotated or is_lone:
        return _options(get_args(annotation)[0], data)
    if get_origin(annotation) in (dict, tuple) or isinstance(annotation, type):
        return [annotation]
    return [option for inner in get_args(annotation) for option in _options(inner, data)]


def _parts(annotation: Any) -> Iterator[Any]:
    """Yield an annotation and everything inside it."""
    yield annotation
    for inner in get_args(annotation):
        yield from _parts(inner)


def _item(data: Any, part: str | int) -> Any:
    if isinstance(data, dict):
        return data.get(part)
    if isinstance(data, list) and isinstance(part, int) and part < len(data):
        return data[part]
    return None
