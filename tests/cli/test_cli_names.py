"""Names in the scripts of the world: through scenes, settings, selections, trajectories, pictures and measures."""

from __future__ import annotations

import json
import unicodedata
from pathlib import Path

import jsonschema
import pytest

from atomsim.compiler import compile_scene
from atomsim.errors import SceneError
from atomsim.scene.language.measures import parse_measure
from atomsim.scene.language.selection import parse_selection
from atomsim.scene.loader import loads
from atomsim.scene.schema import schema
from atomsim.trajectory import Trajectory

SCENE = """\
atomsim: 1
title: Räder 轮 колесо
time_step: 0.01
rounds: 10
groups:
  Räder: {shape: ring, count: 8, radius: 4}
  地面: {shape: plane, counts: [3, 3], step_x: [2, 0, 0], step_y: [0, 2, 0], centre: [0, 0, 9]}
  шар-1: {shape: atoms, positions: [[20, 0, 0]]}
  حلقة: {shape: atoms, positions: [[30, 0, 0]]}
bonds: {hält: {within: Räder, rule: neighbour}}
collisions: {удар: {between: [шар-1, "地面[0:2, :]"]}}
forces: {schwer: {kind: gravity, acts_on: [Räder, "地面[0]"], impulse: [0, 0, -0.01]}}
render: {colors: {"Räder[0:2]": gold}}
silence: {ghost-contact: {because: it is meant, names: groups.Räder}}
"""
FORMS = ("NFC", "NFD")


@pytest.mark.parametrize(("form", "other"), [FORMS, FORMS[::-1]])
def test_a_name_is_the_same_however_it_is_composed(form: str, other: str) -> None:
    within = "within: Räder"
    text = unicodedata.normalize(form, SCENE)
    text = text.replace(unicodedata.normalize(form, within), unicodedata.normalize(other, within))
    loaded = loads(text, overrides=[unicodedata.normalize(other, "groups.Räder.count=9")])
    model, _ = compile_scene(loaded)
    assert [(span.name, span.stop - span.start) for span in model.groups] == [
        ("Räder", 9),
        ("地面", 9),
        ("шар-1", 1),
        ("حلقة", 1),
    ]
    assert loaded.scene.bonds["hält"].within == ("Räder",)
    assert list(loaded.scene.render.colors) == ["Räder[0:2]"]
    assert loaded.scene.silence["ghost-contact"][0].names == ("groups.Räder",)
    assert parse_selection(unicodedata.normalize(other, "Räder[3]")).group == "Räder"
    assert str(parse_measure(unicodedata.normalize(other, "max strain of bonds.hält"))) == "max strain of bonds.hält"
    assert loads(loaded.source.text).scene == loaded.scene


def test_two_compositions_of_one_name_are_a_name_declared_twice() -> None:
    twice = unicodedata.normalize("NFD", "  Räder: {shape: ring, count: 8, radius: 2}\n")
    with pytest.raises(SceneError, match="duplicate key `Räder`, first on line 6"):
        loads(SCENE.replace("  地面:", f"{twice}  地面:"))


def test_the_schema_allows_what_the_loader_allows() -> None:
    validator = jsonschema.Draft202012Validator(schema())
    validator.validate(loads(SCENE).scene.model_dump(mode="json", exclude_none=True))
    good = json.loads('{"atomsim": 1, "time_step": 1, "rounds": 1, "groups": {}}')
    group = {"shape": "ring", "count": 3, "radius": 3}
    for name, is_valid in {
        "环": True,
        "é-1": True,
        "1é": False,
        "a b": False,
        "a" * 100: True,
        "a" * 101: False,
    }.items():
        assert validator.is_valid(good | {"groups": {name: group}}) == is_valid, name


def test_names_go_through_every_command(cli) -> None:
    Path("ü.yaml").write_text(SCENE, encoding="utf-8")
    assert "Räder 8, 地面 9, шар-1 1, حلقة 1" in cli("check", "ü.yaml").out
    assert cli("run", "ü.yaml", "-o", "ö.h5", "-q", "--set", "groups.шар-1.velocity=[0, 0, 1]").code == 0
    with Trajectory("ö.h5") as trajectory:
        assert [span.name for span in trajectory.header.groups] == ["Räder", "地面", "шар-1", "حلقة"]
    assert cli("render", "ö.h5", "--size", "64x48").code == 0
    assert cli("verify", "ö.h5").code == 0
    assert "height of шар-1" in cli("measure", "ö.h5", "height of шар-1", "max strain of bonds.hält").out
    wrong = cli("run", "ü.yaml", "--set", "groups.Rader.count=3")
    assert (wrong.code, wrong.err) == (
        2,
        "--set groups.Rader.count=3: groups.Rader: there is no `Rader`; did you mean `Räder`?\n",
    )
