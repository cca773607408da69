"""What is known of the keys of declarations: the strings below them, their types in words and their defaults."""

from __future__ import annotations

import ast
import functools
import inspect
import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from atomsim.scene.declarations import declarations
from atomsim.scene.language import Declaration
from atomsim.scene.language.base import Begin
from atomsim.scene.source import KeyPath
from atomsim.scene.value_schema import Schema, in_words, value_schema


@dataclass(frozen=True, slots=True)
class FieldDoc:
    """What is known of a field: the type in words, the default as YAML (None: it is required), the string below it."""

    type: str
    default: str | None
    description: str


def field_docs() -> dict[str, dict[str, FieldDoc]]:
    """Return declaration (class name) → field → what is known of it, in the order of the language."""
    return {
        name: {key: field_doc(declaration, key) for key in descriptions(declaration)}
        for name, declaration in declarations().items()
    }


def field_doc(declaration: type[Declaration], key: str) -> FieldDoc:
    """Return what is known of the value under one key of a declaration."""
    return FieldDoc(form(declaration, key), _default_in_words(declaration, key), descriptions(declaration)[key])


def form(declaration: type[Declaration], key: str, inside: KeyPath = ()) -> str:
    """Return how the value under a key is written, `[x, y, z]`, or what is inside it at a path of indices."""
    schema = value_schema(declaration, key)
    for index in inside:
        schema = _item(schema, index)
    return in_words(schema)


def _item(schema: Schema, index: str | int) -> Schema:
    """Return the schema of an item of a list."""
    if "prefixItems" in schema:
        return dict(schema["prefixItems"][index])
    lists = [option for option in (schema, *schema.get("anyOf", ())) if "items" in option]
    return dict(lists[0]["items"])


def default(declaration: type[Declaration], key: str) -> Schema:
    """Return what a schema says of the default of a key: nothing if there is none, or none that can be written."""
    field = declaration.fields_by_key()[key]
    if field.is_required() or field.default_factory is not None or field.default is None:
        return {}
    return {"default": json.loads(json.dumps(field.default))}


def examples(declaration: type[Declaration], key: str) -> list[Any]:
    """Return the values to begin with under a key: one, or none."""
    return [said.value for said in declaration.fields_by_key()[key].metadata if isinstance(said, Begin)]


def _default_in_words(declaration: type[Declaration], key: str) -> str | None:
    """Return a default as the user would write it, empty if nothing stands for it."""
    if declaration.fields_by_key()[key].is_required():
        return None
    value = default(declaration, key).get("default", "")
    if value in ([], ""):
        return ""
    return value if isinstance(value, str) else json.dumps(value)


@functools.cache
def descriptions(declaration: type[Declaration]) -> dict[str, str]:
    """Return the string below each field of a declaration: its own fields first, then those it inherits.

    They are read from the source when somebody asks: pydantic would read them at every start.
    """
    found: dict[str, str] = {}
    for ancestor in declaration.__mro__:
        if issubclass(ancestor, Declaration):
            inherited = dict(_documented(_in_module(ancestor.__module__)[ancestor.__name__]))
            found |= {field: text for field, text in inherited.items() if field not in found}
    fields = declaration.model_fields
    return {fields[name].alias or name: text for name, text in found.items()}


def about(declaration: type[Declaration]) -> str:
    """Return what a declaration says of itself: its docstring, which `python -OO` takes from the class."""
    return ast.get_docstring(_in_module(declaration.__module__)[declaration.__name__]) or ""


@functools.cache
def _in_module(module: str) -> dict[str, ast.ClassDef]:
    """Return the classes of a module by name."""
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}


def _documented(class_: ast.ClassDef) -> Iterator[tuple[str, str]]:
    for field, below in zip(class_.body, class_.body[1:], strict=False):
        match field, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                yield name, inspect.cleandoc(text)
