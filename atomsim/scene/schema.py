"""The scene language as JSON Schema and as a table of its fields; both come from the data model and its docstrings."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from pydantic.json_schema import GenerateJsonSchema

from atomsim.scene import language
from atomsim.scene.field_docs import descriptions
from atomsim.scene.language import Declaration, Scene
from atomsim.scene.mistakes.wording import either

Schema: TypeAlias = dict[str, Any]

_EXTENDS = "The scene file to lay this one over: mappings merge by key, everything else replaces, null deletes."


@dataclass(frozen=True, slots=True)
class FieldDoc:
    """What is known of a field: the type in words, the default as YAML (None: it is required), the string below it."""

    type: str
    default: str | None
    description: str


def schema() -> Schema:
    """Return the JSON Schema (draft 2020-12) of scene files.

    A scene that `extends` another is checked against a second set of definitions, `…Change`, in which every key may be
    left out; null is allowed wherever it means that a key is not there.
    """
    complete = _definitions()
    for name, definition in complete.items():
        _describe(definition, getattr(language, name))
        _allow_nulls(definition)
    changes = {f"{name}Change": _as_change(definition) for name, definition in complete.items()}
    complete["Scene"]["properties"]["extends"] = {"type": "null", "description": _EXTENDS}
    changes["SceneChange"]["properties"]["extends"] = {"type": "string", "description": _EXTENDS}
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


def field_docs() -> dict[str, dict[str, FieldDoc]]:
    """Return declaration (class name) → field → what is known of it, in the order of the language."""
    definitions = _definitions()
    return {name: _fields(getattr(language, name), definitions) for name in definitions}


def _fields(declaration: type[Declaration], definitions: dict[str, Schema]) -> dict[str, FieldDoc]:
    definition = definitions[declaration.__name__]
    return {
        key: FieldDoc(
            type=_in_words(definition["properties"][key], definitions),
            default=None if key in definition.get("required", ()) else _default(definition["properties"][key]),
            description=description,
        )
        for key, description in descriptions(declaration).items()
    }


class _Generator(GenerateJsonSchema):
    """Pydantic's generator without the titles that repeat the name of each key."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def _definitions() -> dict[str, Schema]:
    """Return the schema of each declaration by class name, the scene itself last."""
    scene = Scene.model_json_schema(schema_generator=_Generator)
    definitions: dict[str, Schema] = scene.pop("$defs")
    definitions["Scene"] = scene
    for definition in definitions.values():
        del definition["title"]
        _everywhere(definition, _tidy)
    return definitions


def _tidy(value: Schema) -> None:
    """Leave out what says nothing to a validator, and refuse names that are none."""
    value.pop("discriminator", None)
    if "default" in value and value["default"] is None:
        del value["default"]
    if "patternProperties" in value:
        value["additionalProperties"] = False


def _describe(definition: Schema, declaration: type[Declaration]) -> None:
    for key, description in descriptions(declaration).items():
        definition["properties"][key]["description"] = description


def _allow_nulls(definition: Schema) -> None:
    """Allow null for every key that may be left out, and for every name."""
    for key, value in definition["properties"].items():
        if key not in definition.get("required", ()):
            definition["properties"][key] = _nullable(value)
        for pattern, named in value.get("patternProperties", {}).items():
            value["patternProperties"][pattern] = _nullable(named)


def _nullable(value: Schema) -> Schema:
    alternatives = value.get("anyOf") or value.get("oneOf")
    if alternatives is not None:
        if {"type": "null"} not in alternatives:
            alternatives.append({"type": "null"})
        return value
    outside: Schema = {key: value.pop(key) for key in ("description", "default", "title") if key in value}
    return {"anyOf": [value, {"type": "null"}], **outside}


def _as_change(definition: Schema) -> Schema:
    """Return the definition of the same thing where every key may be left out."""
    change = copy.deepcopy(definition)
    change.pop("required", None)
    _allow_nulls(change)
    change["additionalProperties"] = {"type": "null"}  # what is deleted may be a key of another shape

    def loosen(value: Schema) -> None:
        if "$ref" in value:
            value["$ref"] += "Change"
        if "oneOf" in value:
            value["anyOf"] = value.pop("oneOf")

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


def _default(value: Schema) -> str:
    """Return a default as the user would write it, empty if nothing stands for it."""
    default = value.get("default")
    if default is None or default in ([], ""):
        return ""
    return default if isinstance(default, str) else json.dumps(default)


def _in_words(value: Schema, definitions: dict[str, Schema]) -> str:
    """Return the type that a schema describes."""
    if "title" in value:
        return str(value["title"])
    if "$ref" in value:
        keys = definitions[value["$ref"].rpartition("/")[2]]["properties"]
        return f"{{{', '.join(keys)}}}"
    if "const" in value or "enum" in value:
        return either(str(choice) for choice in value.get("enum") or [value["const"]])
    if "anyOf" in value:
        return either(_in_words(option, definitions) for option in value["anyOf"] if option != {"type": "null"})
    if "prefixItems" in value:
        return f"[{', '.join(_in_words(item, definitions) for item in value['prefixItems'])}]"
    if value["type"] == "array":
        return f"[{_in_words(value['items'], definitions)}, …]"
    if value["type"] == "object":
        return "mapping by name"
    return _scalar_in_words(value)


def _scalar_in_words(value: Schema) -> str:
    word = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}[value["type"]]
    bounds = (("exclusiveMinimum", ">"), ("minimum", "≥"))
    lower = "".join(f" {sign} {value[key]:g}" for key, sign in bounds if key in value)
    upper = f" and ≤ {value['maximum']:g}" if value["type"] == "number" and "maximum" in value else ""
    return word + lower + upper
