"""The JSON Schema of the value under a key, and the same in words; both are made of the annotation alone."""

from __future__ import annotations

import copy
import functools
import typing
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeAlias, Union, get_args, get_origin

from pydantic import WithJsonSchema
from pydantic.fields import FieldInfo

from atomsim.scene.declarations import declarations, is_declaration
from atomsim.scene.language import Declaration
from atomsim.scene.language.base import OneOrList
from atomsim.scene.mistakes.wording import either

Schema: TypeAlias = dict[str, Any]

_SCALARS = {bool: "boolean", float: "number", int: "integer", str: "string"}

_BOUNDS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}
"""The bounds of numbers as pydantic and as JSON Schema call them."""

_SHORTEST = {"array": "minItems", "object": "minProperties", "string": "minLength"}
_LONGEST = {"array": "maxItems", "object": "maxProperties", "string": "maxLength"}

REFERENCE = "#/$defs/"


def value_schema(declaration: type[Declaration], key: str) -> Schema:
    """Return the schema of the value under a key of a declaration; a declaration inside it is a reference."""
    return _schema(_hints(declaration)[key])


def in_words(schema: Schema) -> str:
    """Return the type that the schema of a value describes: `whole number ≥ 1`, `[x, y, z]`."""
    if "title" in schema:
        return str(schema["title"])
    if "$ref" in schema:
        keys = declarations()[schema["$ref"].removeprefix(REFERENCE)].fields_by_key()
        return f"{{{', '.join(keys)}}}"
    if "const" in schema or "enum" in schema:
        return either(str(choice) for choice in schema.get("enum") or [schema["const"]])
    if "anyOf" in schema:
        return either(in_words(option) for option in schema["anyOf"] if option != {"type": "null"})
    if "prefixItems" in schema:
        return f"[{', '.join(in_words(item) for item in schema['prefixItems'])}]"
    if schema["type"] == "array":
        return f"[{in_words(schema['items'])}, …]"
    return "mapping by name" if schema["type"] == "object" else _scalar_in_words(schema)


def _scalar_in_words(schema: Schema) -> str:
    word = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}[schema["type"]]
    bounds = (("exclusiveMinimum", ">"), ("minimum", "≥"))
    lower = "".join(f" {sign} {schema[key]:g}" for key, sign in bounds if key in schema)
    upper = f" and ≤ {schema['maximum']:g}" if schema["type"] == "number" and "maximum" in schema else ""
    return word + lower + upper


@functools.cache
def _hints(declaration: type[Declaration]) -> dict[str, Any]:
    """Return the annotations by key."""
    hints, fields = typing.get_type_hints(declaration, include_extras=True), declaration.model_fields
    return {field.alias or name: hints[name] for name, field in fields.items()}


def _schema(annotation: Any) -> Schema:
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _annotated(arguments[0], arguments[1:])
    if origin in (Union, UnionType):
        return {"anyOf": [_schema(option) for option in arguments]}
    if origin is Literal:
        return {"const": arguments[0]} if len(arguments) == 1 else {"enum": list(arguments)}
    if origin is tuple and arguments[-1] is Ellipsis:
        return {"type": "array", "items": _schema(arguments[0])}
    if origin is tuple:
        n_items = len(arguments)
        items = [_schema(item) for item in arguments]
        return {"type": "array", "prefixItems": items, "minItems": n_items, "maxItems": n_items}
    if origin is dict:
        return _mapping_schema(*arguments)
    if is_declaration(annotation):
        return {"$ref": REFERENCE + annotation.__name__}
    if annotation is NoneType:
        return {"type": "null"}
    return {"type": _SCALARS[annotation]}


def _mapping_schema(key: Any, value: Any) -> Schema:
    pattern = _schema(key).get("pattern")
    if pattern is None:
        return {"type": "object", "additionalProperties": _schema(value)}
    return {"type": "object", "patternProperties": {pattern: _schema(value)}, "additionalProperties": False}


def _annotated(inner: Any, metadata: tuple[Any, ...]) -> Schema:
    """Return the schema of a type with what is said about it, in the order in which it is said."""
    schema = _schema(inner)
    for said in metadata:
        if isinstance(said, FieldInfo):
            _say(schema, said)
        elif isinstance(said, WithJsonSchema):
            title = {"title": schema["title"]} if "title" in schema else {}
            schema = title | copy.deepcopy(said.json_schema or {})
        elif isinstance(said, OneOrList):
            schema = {"anyOf": [copy.deepcopy(schema["items"]), schema]}
    return schema


def _say(schema: Schema, field: FieldInfo) -> None:
    """Add what a field says of its value."""
    if field.title is not None:
        schema["title"] = field.title
    if field.discriminator is not None:
        schema["oneOf"] = schema.pop("anyOf")
    for constraint in field.metadata:
        for bound, keyword in _BOUNDS.items():
            if hasattr(constraint, bound):
                schema[keyword] = getattr(constraint, bound)
        for length, keywords in (("min_length", _SHORTEST), ("max_length", _LONGEST)):
            if hasattr(constraint, length):
                schema[keywords[schema["type"]]] = getattr(constraint, length)
