"""The JSON Schema and the table of fields: complete, up to date, in agreement with the loader."""

from __future__ import annotations

import copy
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal, get_type_hints

import jsonschema
import pytest
from pydantic import Field, create_model
from pydantic.fields import FieldInfo
from support.process import finish

from atomsim.errors import Mark, SceneError
from atomsim.scene.declarations import declaration_at, declarations, discriminator, sections, selecting_keys
from atomsim.scene.field_docs import descriptions, examples, field_docs
from atomsim.scene.language import (
    Camera,
    Collisions,
    Declaration,
    Jitter,
    Render,
    RingGroup,
    Rotation,
    Scene,
    Spin,
)
from atomsim.scene.language.base import Named, Selection, Vector
from atomsim.scene.language.forces import Force
from atomsim.scene.loader import loads
from atomsim.scene.schema import schema, schema_text
from atomsim.scene.yaml.strict_yaml import read_yaml

REPOSITORY = Path(__file__).parents[2]
COMMITTED = REPOSITORY / "atomsim" / "scene" / "scene.schema.json"
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
    assert COMMITTED.read_text(encoding="utf-8") == schema_text(), "atomsim schema > atomsim/scene/scene.schema.json"


def test_every_reference_leads_to_a_definition() -> None:
    references = set(re.findall(r'"#/\$defs/(\w+)"', schema_text()))
    assert references == set(schema()["$defs"])


def test_no_names_are_too_few_but_a_change_may_have_none(validator: jsonschema.Draft202012Validator) -> None:
    assert not validator.is_valid(with_value("groups", {}))
    validator.validate({"extends": "rods.yaml", "groups": {}})


@pytest.mark.parametrize("flag", ["-O", "-OO"])
def test_the_schema_does_not_depend_on_optimisation(flag: str) -> None:
    """Docstrings, which tell what declarations are, are gone from the classes then."""
    code = "import sys; from atomsim.scene.schema import schema_text; sys.stdout.buffer.write(schema_text().encode())"
    assert finish(program=(sys.executable, flag, "-c", code)).stdout == schema_text()


def test_pydantic_has_no_say_in_the_schema(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its own schemas differ from version to version."""
    for hook in ("model_json_schema", "__get_pydantic_json_schema__"):
        monkeypatch.setattr(Declaration, hook, classmethod(pytest.fail))
    assert schema_text() == COMMITTED.read_text(encoding="utf-8")


def test_no_two_fields_are_merged() -> None:
    """Pydantic before 2.11.5 then takes the default of another key: an impulse left out would be no error."""
    for name, declaration in declarations().items():
        for key, hint in get_type_hints(declaration, include_extras=True).items():
            said = getattr(hint, "__metadata__", ())
            assert sum(isinstance(part, FieldInfo) for part in said) < 2, (name, key)
            assert declaration.model_fields[key].examples is None, (name, key, "write Begin(…)")


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_scene_agrees_with_the_schema(path: Path, validator: jsonschema.Draft202012Validator) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# yaml-language-server: $schema=../atomsim/scene/scene.schema.json\n")
    validator.validate(read_yaml(text, lambda line, column: Mark(path.name, line, column)).plain())


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("groups.ring.radius", 4.5),
        ("groups.ring.count", 20.0),
        ("rounds", 1e3),
        ("$schema", "scene.schema.json"),
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
    for key in ("extends", "$schema"):
        scene.pop(key, None)
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


def _subclasses(declaration: type[Declaration]) -> Iterator[type[Declaration]]:
    """Yield what the package derives from a declaration."""
    for derived in declaration.__subclasses__():
        if derived.__module__.startswith("atomsim."):
            yield derived
            yield from _subclasses(derived)


def test_every_field_of_every_declaration_is_described() -> None:
    written = {found.__name__: found for found in _subclasses(Declaration) if not found.__subclasses__()}
    table = field_docs()
    assert set(table) == set(written)
    for name, declaration in written.items():
        assert set(table[name]) == set(declaration.fields_by_key())
        assert all(doc.description.endswith(".") and doc.type for doc in table[name].values()), name


def test_what_must_be_written_says_a_value_to_begin_with() -> None:
    """All but the words that choose a declaration, selections, for which the groups are named, and reasons."""
    begin = {}
    for name, declaration in declarations().items():
        chosen_by = discriminator(declaration)
        word = {} if chosen_by is None else dict([chosen_by])
        required = [key for key, field in declaration.fields_by_key().items() if field.is_required()]
        left = [key for key in required if key not in {*word, *selecting_keys(declaration), "because"}]
        found = {key: examples(declaration, key) for key in left}
        assert all(found.values()), (name, found)
        begin[name] = word | {key: value for key, (value,) in found.items()}
    assert Scene.model_validate(begin["Scene"]).rounds == 2000
    for section in ("groups", "bonds", "forces"):
        for declaration in sections()[section].declarations:
            chosen = {key: "rope" for key in selecting_keys(declaration) if key == "within"}
            written = {key: value for key in declaration.fields_by_key() for value in examples(declaration, key)}
            entry = {**begin[declaration.__name__], **written, **chosen}
            Scene.model_validate({**begin["Scene"], section: {"rope": entry}})


def test_types_and_defaults_in_words() -> None:
    table = field_docs()
    shown = {key: (doc.type, doc.default) for key, doc in table["RingGroup"].items()}
    copies = "{count, step, axis, through, degrees}"
    assert shown == {
        "shape": ("ring", None),
        "count": ("whole number ≥ 1", None),
        "radius": ("number > 0", None),
        "axis": ("x, y or z", "z"),
        "centre": ("[x, y, z]", "[0.0, 0.0, 0.0]"),
        "rotate": ("{axis, degrees} or [{axis, degrees}, …]", ""),
        "velocity": ("[x, y, z]", "[0.0, 0.0, 0.0]"),
        "spin": ("{axis, rate}", ""),
        "copies": (f"{copies} or [{copies}, …]", ""),
        "color": ("color", ""),
    }
    assert table["Damping"]["coefficient"].type == "number ≥ 0 and ≤ 1"
    assert table["ListedBonds"]["pairs"].type == "[[i, k], …]"
    assert table["Spin"]["axis"].type == "x, y, z or [x, y, z]"
    assert table["StringGroup"]["from"].type == "[x, y, z]"
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


class Toy(Declaration):
    """A kind of force that the package does not export."""

    kind: Literal["toy"]
    """Does nothing."""
    wants: Vector
    """Three numbers."""
    acts_on: Selection = ("all",)
    """The atoms that feel it."""


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A language with one more kind of force, which is a member of the union and named nowhere else."""
    forces = Named[Annotated[Force | Toy, Field(discriminator="kind")]]
    scene = create_model(
        "Scene", __base__=Scene, __module__=Scene.__module__, forces=(forces, Field(default_factory=dict))
    )
    for module in ("declarations", "loader"):
        monkeypatch.setattr(f"atomsim.scene.{module}.Scene", scene)
    sections.cache_clear()
    declarations.cache_clear()
    yield
    sections.cache_clear()
    declarations.cache_clear()


def test_a_kind_is_known_everywhere_by_being_in_the_union(toy: None) -> None:
    assert "Toy" in schema()["$defs"]
    assert field_docs()["Toy"]["wants"].type == "[x, y, z]"
    text = "atomsim: 1\ntime_step: 1\nrounds: 1\ngroups: {a: {shape: ring, count: 3, radius: 3}}\nforces:\n  f: {%s}\n"
    for written, message in (
        ("kind: toy, acts_on: b", "6:18: forces.f.acts_on: there is no group `b`; the groups are a"),
        ("kind: toy, wnats: 1", "6:18: forces.f.wnats: unknown key `wnats`; did you mean `wants`?"),
        ("kind: toy, wants: 1", "6:18: forces.f.wants: needs [x, y, z] (got 1)"),
        ("kind: toyy", '6:7: forces.f.kind: unknown kind "toyy"; did you mean `toy`?'),
        ("kind: toy", "6:3: forces.f.wants: missing: Three numbers"),
    ):
        with pytest.raises(SceneError) as caught:
            loads(text % written, "s")
        assert f"s:{message}" in str(caught.value).split("\n")


def test_words_of_a_section() -> None:
    assert list(sections()["groups"].words) == ["string", "ring", "polygon", "plane", "block", "ball", "atoms"]
    assert sections()["collisions"].words == {}
