"""The strings below the fields of the language, and which declaration a path leads to; knows no wording of its own."""

from __future__ import annotations

import ast
import functools
import inspect
import sys
from collections.abc import Iterator
from typing import Annotated, Any, TypeGuard, get_args, get_origin

from atomsim.scene.language import Declaration, Scene
from atomsim.scene.source import KeyPath


@functools.cache
def descriptions(declaration: type[Declaration]) -> dict[str, str]:
    """Return the string below each field of a declaration: its own fields first, then those it inherits.

    They are read from the source when somebody asks: pydantic would read them at every start.
    """
    found: dict[str, str] = {}
    for ancestor in declaration.__mro__:
        if issubclass(ancestor, Declaration):
            inherited = _in_module(ancestor.__module__).get(ancestor.__name__, {})
            found |= {field: text for field, text in inherited.items() if field not in found}
    return found


@functools.cache
def _in_module(module: str) -> dict[str, dict[str, str]]:
    """Return class → field → the string below it."""
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    return {node.name: dict(_documented(node)) for node in tree.body if isinstance(node, ast.ClassDef)}


def _documented(class_: ast.ClassDef) -> Iterator[tuple[str, str]]:
    for field, below in zip(class_.body, class_.body[1:], strict=False):
        match field, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                yield name, inspect.cleandoc(text)


def discriminator(declaration: type[Declaration]) -> tuple[str, str] | None:
    """Return the key and the word by which a declaration is chosen among its kind: ("shape", "ring")."""
    for key in ("shape", "rule", "kind"):
        if key in declaration.model_fields:
            return key, str(get_args(declaration.model_fields[key].annotation)[0])
    return None


def declared_in(section: str) -> list[type[Declaration]]:
    """Return what may be declared by name in a section; nothing for a section without names."""
    annotation = Scene.model_fields[section].annotation
    return _options(get_args(annotation)[1], None) if get_origin(annotation) is dict else []


def words_in(section: str) -> dict[str, list[str]]:
    """Return the words that choose a declaration in a section (shapes, rules or kinds), each with its keys."""
    chosen_by = {discriminator(declaration): list(descriptions(declaration)) for declaration in declared_in(section)}
    return {chosen[1]: keys for chosen, keys in chosen_by.items() if chosen is not None}


def is_mapping(declaration: type[Declaration], key: str) -> bool:
    """Tell whether further keys or names stand below a key of a declaration, and nothing else may."""
    options = _options(declaration.model_fields[key].annotation, [])
    return any(get_origin(option) is dict or _is_declaration(option) for option in options)


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
    if declaration is not None and part in declaration.model_fields:
        return declaration.model_fields[str(part)].annotation
    for option in _options(annotation, data):
        if get_origin(option) is dict:
            return get_args(option)[1]
        if get_origin(option) is tuple and isinstance(part, int):
            return get_args(option)[0]
    return None


def _chosen(annotation: Any, data: Any) -> type[Declaration] | None:
    """Return the declaration among the options that the data name, or the only one."""
    options = _options(annotation, data)
    classes = [option for option in options if _is_declaration(option)]
    if len(classes) == 1:
        return classes[0]
    for declaration in classes:
        key, word = discriminator(declaration) or ("", "")
        if _item(data, key) == word:
            return declaration
    return None


def _is_declaration(option: Any) -> TypeGuard[type[Declaration]]:
    return isinstance(option, type) and issubclass(option, Declaration)


def _options(annotation: Any, data: Any) -> list[Any]:
    """Return the alternatives of an annotation, without `Annotated` and unions; one item may stand for a list."""
    is_lone = get_origin(annotation) is tuple and not isinstance(data, list)
    if get_origin(annotation) is Annotated or is_lone:
        return _options(get_args(annotation)[0], data)
    if get_origin(annotation) in (dict, tuple) or isinstance(annotation, type):
        return [annotation]
    return [option for inner in get_args(annotation) for option in _options(inner, data)]


def _item(data: Any, part: str | int) -> Any:
    if isinstance(data, dict):
        return data.get(part)
    if isinstance(data, list) and isinstance(part, int) and part < len(data):
        return data[part]
    return None
