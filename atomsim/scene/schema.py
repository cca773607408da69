"""The scene language as JSON Schema: all declarations, and the changes to them that a scene which extends may make."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from typing import Any

from atomsim.scene.declarations import declarations
from atomsim.scene.field_docs import about, default, descriptions, examples
from atomsim.scene.language import Declaration
from atomsim.scene.value_schema import Schema, value_schema

_SCHEMA = "Where an editor finds this schema, in a scene that is written as JSON; atomsim does not read it."
_ABOUT = ("description", "default", "examples", "title")
"""What a schema says about a value, whatever the value may be."""

_EXTENDS = "The scene file to lay this one over: mappings merge by key, everything else replaces, null deletes."


def schema() -> Schema:
    """Return the JSON Schema (draft 2020-12) of scene files.

    A scene that `extends` another is checked against a second set of definitions, `…Change`, in which every key may be
    left out; null is allowed wherever it means that a key is not there.
    """
    complete = {name: _definition(declaration) for name, declaration in declarations().items()}
    for definition in complete.values():
        _allow_nulls(definition)
    changes = {f"{name}Change": _as_change(definition) for name, definition in complete.items()}
    for scene, extends in ((complete["Scene"], "null"), (changes["SceneChange"], "string")):
        scene["properties"]["extends"] = {"type": extends, "description": _EXTENDS}
        scene["properties"]["$schema"] = {"type": "string", "description": _SCHEMA}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "atomsim scene, version 1",
        "if": {"properties": {"extends": {"type": "string"}}, "required": ["extends"]},
        "then": {"$ref": "#/$defs/SceneChange"},
        "else": {"$ref": "#/$defs/Scene"},
        "$defs": complete | changes,
    }


def schema_text() -> str:
    """Return the JSON Schema as the text of `scene.schema.json`."""
    return _laid_out(schema(), "") + "\n"


def _definition(declaration: type[Declaration]) -> Schema:
    """Return the schema of a declaration."""
    fields, described = declaration.fields_by_key(), descriptions(declaration)
    return {
        "description": about(declaration),
        "type": "object",
        "properties": {
            key: value_schema(declaration, key)
            | default(declaration, key)
            | ({"examples": found} if (found := examples(declaration, key)) else {})
            | {"description": described[key]}
            for key in fields
        },
        "required": [key for key, field in fields.items() if field.is_required()],
        "additionalProperties": False,
    }


def _allow_nulls(definition: Schema) -> None:
    """Allow null for every key that may be left out, and for every name."""
    for key, value in definition["properties"].items():
        if key not in definition["required"]:
            definition["properties"][key] = _nullable(value)
        for pattern, named in value.get("patternProperties", {}).items():
            value["patternProperties"][pattern] = _nullable(named)


def _nullable(value: Schema) -> Schema:
    alternatives = value.get("anyOf") or value.get("oneOf")
    if alternatives is not None:
        if {"type": "null"} not in alternatives:
            alternatives.append({"type": "null"})
        return value
    outside: Schema = {key: value.pop(key) for key in _ABOUT if key in value}
    return {"anyOf": [value, {"type": "null"}], **outside}


def _as_change(definition: Schema) -> Schema:
    """Return the definition of the same thing where every key may be left out."""
    change = copy.deepcopy(definition)
    change["required"] = []
    _allow_nulls(change)
    change["additionalProperties"] = {"type": "null"}  # what is deleted may be a key of another shape

    def loosen(value: Schema) -> None:
        if "$ref" in value:
            value["$ref"] += "Change"
        if "oneOf" in value:
            value["anyOf"] = value.pop("oneOf")
        value.pop("minProperties", None)  # the names may be in what is extended

    _everywhere(change, loosen)
    return change


def _everywhere(value: Any, change: Callable[[Schema], object]) -> None:
    """Apply a change to every mapping inside a schema."""
    if isinstance(value, dict):
        change(value)
    if isinstance(value, (dict, list)):
        for inner in list(value.values()) if isinstance(value, dict) else value:
            _everywhere(inner, change)


def _laid_out(value: Any, indent: str) -> str:
    """Write JSON with everything on one line that fits there."""
    line = json.dumps(value, ensure_ascii=False)
    if len(indent) + len(line) <= 110 or not isinstance(value, (dict, list)):
        return line
    deeper = indent + "  "
    if isinstance(value, list):
        items = [_laid_out(item, deeper) for item in value]
        return "[\n" + ",\n".join(deeper + item for item in items) + f"\n{indent}]"
    items = [f"{json.dumps(key)}: {_laid_out(item, deeper)}" for key, item in value.items()]
    return "{\n" + ",\n".join(deeper + item for item in items) + f"\n{indent}}}"
