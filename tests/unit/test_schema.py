"""The JSON Schema and the table of fields: complete, up to date, in agreement with the loader."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from atomsim.errors import Mark
from atomsim.scene import language
from atomsim.scene.field_docs import declaration_at, descriptions, words_in
from atomsim.scene.language import Camera, Collisions, Declaration, Jitter, Render, RingGroup, Rotation, Scene, Spin
from atomsim.scene.schema import field_docs, schema, schema_text
from atomsim.scene.yaml.strict_yaml import read_yaml

REPOSITORY = Path(__file__).parents[2]
SHIPPED = sorted(REPOSITORY.glob("scenes/*.yaml"))
GOOD: dict[str, Any] = {
    "atomsim": 1,
    "time_step": 0.01,
    "rounds": 100,
    "groups": {"ring": {"shape": "ring", "count": 20, "radius": 4, "rotate": {"axis": "x", "degrees": 3}}},
    "bonds": {"hoop": {"rule": "neighbour", "within": "ring"}},
    "collisions": {"own": {"within": ["ring", "ring[0]"]}},
    "forces": {"weight": {"kind": "gravity", "impulse": [0, 0, 1]}},
    "render": {"camera": {"up": "y"}, "colors": {"ring": "red"}},
}


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    """Return a validator of scenes, the schema itself being valid."""
    jsonschema.Draft202012Validator.check_schema(schema())
    return jsonschema.Draft202012Validator(schema())


def with_value(path: str, value: object) -> dict[str, Any]:
    """Return the good scene with another value at a path."""
    scene = copy.deepcopy(GOOD)
    *parents, key = path.split(".")
    at = scene
    for parent in parents:
        at = at[parent]
    at[key] = value
    return scene


def test_the_committed_schema_is_up_to_date() -> None:
    committed = REPOSITORY / "atomsim" / "scene" / "scene.schema.json"
    assert committed.read_text(encoding="utf-8") == schema_text(), "atomsim schema > atomsim/scene/scene.schema.json"


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_scene_agrees_with_the_schema(path: Path, validator: jsonschema.Draft202012Validator) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# yaml-language-server: $schema=../atomsim/scene/scene.schema.json\n")
    validator.validate(read_yaml(text, lambda line, column: Mark(path.name, line, column)).plain())


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("groups.ring.radius", 4.5),
        ("groups.ring.centre", [1, 2, 3]),
        ("groups.ring.rotate", [{"axis": [0, 0, 1], "degrees": 3}]),
        ("groups.ring.color", None),
        ("groups.rod", None),
        ("forces", None),
        ("bonds.hoop.rest", "initial"),
        ("bonds.hoop.rest", 0.5),
        ("render.camera", None),
        ("extends", None),
    ],
)
def test_good_values_agree(path: str, value: object, validator: jsonschema.Draft202012Validator) -> None:
    scene = with_value(path, value)
    validator.validate(scene)
    scene.pop("extends", None)
    Scene.model_validate(scene)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("atomsim", 2),
        ("rounds", 0),
        ("rounds", 1.5),
        ("rounds", None),
        ("round", 1),
        ("groups.1st", {"shape": "ring", "count": 20, "radius": 4}),
        ("groups.ring.shape", "rong"),
        ("groups.ring.radius", "4"),
        ("groups.ring.radius", 0),
        ("groups.ring.radus", 1),
        ("groups.ring.centre", [1, 2]),
        ("groups.ring.rotate", {"axis": "x"}),
        ("bonds.hoop.rest", "short"),
        ("bonds.hoop.rest", -1),
        ("forces.weight.impulse", [0, 0, 0, 0]),
        ("render.camera.up", "w"),
        ("render.colors.ring", 3),
    ],
)
def test_bad_values_are_refused_by_both(path: str, value: object, validator: jsonschema.Draft202012Validator) -> None:
    scene = with_value(path, value)
    assert not validator.is_valid(scene)
    with pytest.raises(ValueError, match="validation error"):
        Scene.model_validate(scene)


def test_a_scene_that_extends_need_not_be_complete(validator: jsonschema.Draft202012Validator) -> None:
    change = {"groups": {"ring": {"radius": 3}, "rod": None}, "bonds": {"hoop": {"rule": None}}, "rounds": None}
    validator.validate({"extends": "rods.yaml", **change})
    assert not validator.is_valid(change)
    assert not validator.is_valid({"extends": "rods.yaml", "groups": {"ring": {"radus": 3}}})


def test_every_field_of_every_declaration_is_described() -> None:
    declarations = {
        declaration.__name__: declaration
        for declaration in map(language.__dict__.get, language.__all__)
        if isinstance(declaration, type) and issubclass(declaration, Declaration) and declaration is not Declaration
    }
    table = field_docs()
    assert set(table) == set(declarations)
    for name, declaration in declarations.items():
        assert set(table[name]) == set(declaration.model_fields)
        assert all(doc.description.endswith(".") and doc.type for doc in table[name].values()), name


def test_types_and_defaults_in_words() -> None:
    table = field_docs()
    shown = {key: (doc.type, doc.default) for key, doc in table["RingGroup"].items()}
    assert shown == {
        "shape": ("ring", None),
        "count": ("whole number ≥ 1", None),
        "radius": ("number > 0", None),
        "axis": ("x, y or z", "z"),
        "centre": ("[x, y, z]", "[0.0, 0.0, 0.0]"),
        "rotate": ("{axis, degrees} or [{axis, degrees}, …]", ""),
        "velocity": ("[x, y, z]", "[0.0, 0.0, 0.0]"),
        "spin": ("{axis, rate}", ""),
        "color": ("color", ""),
    }
    assert table["Damping"]["coefficient"].type == "number ≥ 0 and ≤ 1"
    assert table["ListedBonds"]["pairs"].type == "[[whole number ≥ 0, whole number ≥ 0], …]"
    assert table["Spin"]["axis"].type == "x, y, z or [x, y, z]"
    assert table["Damping"]["acts_on"].default == '["all"]'


def test_own_fields_come_first() -> None:
    assert list(descriptions(RingGroup))[:3] == ["shape", "count", "radius"]
    assert descriptions(RingGroup)["count"] == "Number of atoms."


@pytest.mark.parametrize(
    ("path", "declaration"),
    [
        ((), Scene),
        (("jitter",), Jitter),
        (("render",), Render),
        (("render", "camera"), Camera),
        (("render", "colors"), None),
        (("groups",), None),
        (("groups", "ring"), RingGroup),
        (("groups", "ring", "spin"), Spin),
        (("groups", "ring", "rotate"), Rotation),
        (("groups", "ring", "rotate", "axis"), None),
        (("groups", "ring", "centre"), None),
        (("groups", "ring", "centre", 0), None),
        (("groups", "rod"), None),
        (("collisions", "own"), Collisions),
        (("nothing", "at", "all"), None),
    ],
)
def test_declaration_at(path: tuple[str | int, ...], declaration: type[Declaration] | None) -> None:
    assert declaration_at(path, GOOD) is declaration


def test_words_of_a_section() -> None:
    assert list(words_in("groups")) == ["string", "ring", "polygon", "plane", "block", "atoms"]
    assert words_in("forces")["hold"] == ["kind", "acts_on"]
