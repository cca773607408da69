"""Loading scenes: files, what they extend, settings, the resolved text."""

from __future__ import annotations

import bz2
import gzip
import json
import lzma
import os
from pathlib import Path

import jsonschema
import pytest
from support.process import finish, python

from atomsim.errors import Mark, SceneError
from atomsim.scene.loader import load, loads
from atomsim.scene.mistakes.mistake import MOST_TOLD
from atomsim.scene.schema import schema
from atomsim.scene.yaml.tree import Node, merge, without_nulls

REPOSITORY = Path(__file__).parents[2]
GOOD = """\
atomsim: 1
time_step: 0.01
rounds: 100
groups:
  ring: {shape: ring, count: 20, radius: 4}
  rod: {shape: string, count: 3, step: [1, 0, 0]}
forces:
  weight: {kind: gravity, impulse: [0, -0.01, 0]}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the current folder, empty but for a scene."""
    monkeypatch.chdir(tmp_path)
    write("base.yaml", GOOD)
    return tmp_path


def write(name: str, text: str | bytes) -> None:
    """Write a file below the current folder."""
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())


def refusal(name: str, *settings: str) -> str:
    """Return the message a file gets."""
    with pytest.raises(SceneError) as caught:
        load(name, settings)
    return str(caught.value)


@pytest.mark.parametrize("path", sorted(REPOSITORY.glob("scenes/*.yaml")), ids=lambda path: path.stem)
def test_shipped_scene_loads_and_its_text_stands_for_it(path: Path) -> None:
    loaded = load(path)
    assert loaded.scene.title
    assert loads(loaded.source.text).scene == loaded.scene
    assert "extends" not in loaded.source.text


def test_source_is_as_the_user_named_it(folder: Path) -> None:
    loaded = load("./base.yaml", ["rounds=7"])
    assert loaded.source.name == "./base.yaml"
    assert loaded.source.overrides == ("rounds=7",)
    assert loaded.source.mark(("groups", "ring", "count")) == Mark("./base.yaml", 5, 23)
    assert loaded.source.mark(("groups", "ring", "centre")) == Mark("./base.yaml", 5, 3)
    assert loaded.source.mark(("rounds",)) == Mark("--set rounds=7", 0, 0)
    assert load(folder / "base.yaml").source.name == str(folder / "base.yaml")


def test_text_is_resolved(folder: Path) -> None:
    write("new.yaml", "extends: base.yaml\ntitle: 'yes'\nforces: {weight: null, mud: {kind: hold}}\n")
    assert load("new.yaml", ["groups.ring.radius=1e-9", "groups.rod.centre=[-0.0, 1e300, .5]"]).source.text == (
        "atomsim: 1\n"
        "time_step: 0.01\n"
        "rounds: 100\n"
        "groups:\n"
        "  ring: {shape: ring, count: 20, radius: 1.0e-09}\n"
        "  rod:\n"
        "    shape: string\n"
        "    count: 3\n"
        "    step: [1, 0, 0]\n"
        "    centre: [-0.0, 1.0e+300, 0.5]\n"
        "forces:\n"
        "  mud: {kind: hold}\n"
        "title: 'yes'\n"
    )


def test_byte_order_mark_and_line_ends_of_windows(folder: Path) -> None:
    write("windows.yaml", b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load("windows.yaml").scene == load("base.yaml").scene


def test_a_null_is_not_there() -> None:
    assert loads(GOOD + "jitter:\nbonds: {a: null}\nrender: {camera: ~}\n").scene == loads(GOOD).scene


def test_a_whole_number_may_be_written_as_a_power() -> None:
    text = GOOD.replace("rounds: 100", "rounds: 1e3").replace("count: 20", "count: 2.0e1")
    loaded = loads(text, overrides=["record_every=1E2", "groups.rod.count=3.0"])
    assert (loaded.scene.rounds, loaded.scene.groups["ring"].count, loaded.scene.record_every) == (1000, 20, 100)
    assert all(type(number) is int for number in (loaded.scene.rounds, loaded.scene.groups["rod"].count))
    assert loads(loaded.source.text).scene == loaded.scene


def test_a_scene_can_be_piped() -> None:
    code = "from atomsim.scene.loader import load; print(load('/dev/stdin').scene.rounds)"
    assert finish(program=python(code), said=GOOD).stdout == "100\n"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "s.yaml:1:1: the scene is empty; it begins with `atomsim: 1`"),
        (b"atomsim: 1\ntitle: \xfcber\n", "s.yaml:2:8: the byte 0xfc is not UTF-8; save the file as UTF-8"),
        ("ä: ".encode() + b"\xff", "s.yaml:1:4: the byte 0xff is not UTF-8; save the file as UTF-8"),
        (b"\0" * 100, "s.yaml:1:1: the character U+0000 cannot stand in YAML"),
        (b"a" * (2**24 + 1), "s.yaml: the file is larger than 16 MiB"),
        (b"\x89HDF\r\n\x1a\n\0\0", "s.yaml: this is a trajectory, not a scene"),
    ],
    ids=["empty", "latin 1", "byte", "zeros", "large", "trajectory"],
)
def test_bad_content(content: bytes, message: str, folder: Path) -> None:
    write("s.yaml", content)
    assert refusal("s.yaml") == message


def test_bad_file(folder: Path) -> None:
    assert refusal("base.yml") == "base.yml: there is no such file; did you mean `base.yaml`?"
    assert refusal("nowhere/else.yaml") == "nowhere/else.yaml: there is no such file"
    assert refusal("a\0b") == "a\\x00b: there is no such file"
    assert refusal(".") == ".: this is a folder, not a scene file"
    assert refusal("base.yaml/x") == "base.yaml/x: the file cannot be read (Not a directory)"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_forbidden_file(folder: Path) -> None:
    Path("base.yaml").chmod(0)
    assert refusal("base.yaml") == "base.yaml: the file may not be read (permission denied)"


ENCODINGS = ["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"]


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (gzip.compress(GOOD.encode()), "a gzip archive"),
        (bz2.compress(GOOD.encode()), "a bzip2 archive"),
        (lzma.compress(GOOD.encode()), "an xz archive"),
        (b"PK\x03\x04\x14\0", "a ZIP archive"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "a picture"),
        (b"%PDF-1.7\n", "a PDF document"),
    ],
)
def test_another_file_is_called_what_it_is(content: bytes, what: str, folder: Path) -> None:
    write("s.yaml", content)
    assert refusal("s.yaml") == f"s.yaml: this is {what}, not a scene"


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_another_encoding_is_called_by_its_name(encoding: str, folder: Path) -> None:
    write("s.yaml", GOOD.encode(encoding))
    assert refusal("s.yaml") == f"s.yaml: the file is {encoding[:6].upper()}; save it as UTF-8"


def test_a_scene_may_be_json(folder: Path) -> None:
    text = json.dumps(
        {
            "$schema": "scene.schema.json",
            "atomsim": 1,
            "title": "\U0001f916",
            "time_step": 0.01,
            "rounds": 1e2,
            "groups": {"ring": {"shape": "ring", "count": 20, "radius": 4}},
        },
        indent="\t",
    )
    write("s.json", text)
    loaded = load("s.json", ["groups.ring.radius=3"])
    assert (loaded.scene.title, loaded.scene.rounds, loaded.scene.groups["ring"].radius) == ("\U0001f916", 100, 3)
    assert loads(loaded.source.text).scene == loaded.scene
    write("top.json", '{"extends": "s.json", "$schema": "../scene.schema.json", "rounds": 5}')
    assert load("top.json").scene.rounds == 5
    write("s.json", text.replace('"count": 20', '"cuont": 20'))
    assert refusal("top.json") == "s.json:10:4: groups.ring.cuont: unknown key `cuont`; did you mean `count`?"
    assert refusal("s.jsn") == "s.jsn: there is no such file; did you mean `s.json`?"


def test_the_schema_of_a_scene_in_json_is_a_text(folder: Path) -> None:
    write("s.yaml", GOOD + "$schema: 3\n")
    assert refusal("s.yaml").startswith("s.yaml:9:1: $schema: unknown key `$schema`; the keys here are")


def test_extends_merges_in_the_order_of_the_base(folder: Path) -> None:
    write(
        "top.yaml",
        "extends: base.yaml\ngroups: {new: {shape: string, count: 1, step: [1, 1, 1]}, ring: {count: 5}}\nrounds: 9\n",
    )
    scene = load("top.yaml").scene
    assert list(scene.groups) == ["ring", "rod", "new"]
    assert scene.groups["ring"].count == 5
    assert scene.groups["ring"].radius == 4
    assert scene.rounds == 9
    assert list(scene.forces) == ["weight"]


def test_extends_in_a_chain_and_into_a_folder(folder: Path) -> None:
    write("parts/a.yaml", "extends: b.yaml\nrounds: 2\n")
    write("parts/b.yaml", "extends: ../base.yaml\nrounds: 3\ntitle: b\n")
    write("top.yaml", "extends: parts/a.yaml\n")
    loaded = load("top.yaml")
    assert (loaded.scene.rounds, loaded.scene.title) == (2, "b")
    assert loaded.source.mark(("rounds",)) == Mark("parts/a.yaml", 2, 1)
    assert loaded.source.mark(("title",)) == Mark("parts/b.yaml", 3, 1)
    assert loaded.source.mark(("time_step",)) == Mark("base.yaml", 2, 1)


def test_mistakes_of_several_files_name_each(folder: Path) -> None:
    write("base.yaml", GOOD.replace("count: 20", "count: none"))
    write("top.yaml", "extends: base.yaml\ntime_step: none\ngroups:\n  rod: {shape: ring, radius: 3}\n")
    assert refusal("top.yaml", "rounds=none").split("\n") == [
        'top.yaml:2:1: time_step: needs a number (got "none")',
        '--set rounds=none: rounds: needs a whole number (got "none")',
        'base.yaml:5:23: groups.ring.count: needs a whole number (got "none")',
        "base.yaml:6:34: groups.rod.step: unknown key `step`; to drop what is extended, write `step: null` in top.yaml",
    ]


def test_a_group_becomes_another_shape_by_deleting_the_keys_of_the_old_one(folder: Path) -> None:
    write("top.yaml", "extends: base.yaml\ngroups:\n  rod: {shape: ring, radius: 3, step: null}\n")
    rod = load("top.yaml").scene.groups["rod"]
    assert (rod.shape, rod.count, rod.radius) == ("ring", 3, 3.0)
    assert (
        load("base.yaml", ["groups.rod.step=null", "groups.rod.shape=ring", "groups.rod.radius=3"]).scene.groups["rod"]
        == rod
    )
    jsonschema.validate(
        {"extends": "base.yaml", "groups": {"rod": {"shape": "ring", "radius": 3, "step": None}}}, schema()
    )


def test_a_misspelt_key_of_the_base_is_a_misspelt_key(folder: Path) -> None:
    write("base.yaml", GOOD.replace("atomsim: 1", "atomsim: 1\ntitel: x"))
    write("top.yaml", "extends: base.yaml")
    assert refusal("top.yaml") == "base.yaml:2:1: titel: unknown key `titel`; did you mean `title`?"


def test_a_key_of_the_shape_before_is_no_misspelling(folder: Path) -> None:
    write("base.yaml", GOOD.replace("string, count: 3, step: [1, 0, 0]", "block, counts: [1, 1, 1], spacing: 2"))
    write("top.yaml", "extends: base.yaml\ngroups: {rod: {shape: ring, count: 3, radius: 3, spacing: null}}")
    assert refusal("top.yaml") == (
        "base.yaml:6:23: groups.rod.counts: unknown key `counts`; "
        "to drop what is extended, write `counts: null` in top.yaml"
    )


def test_a_misspelt_name_in_a_scene_that_extends(folder: Path) -> None:
    write("base.yaml", GOOD + "collisions: {grip: {within: ring}}\n")
    write(
        "top.yaml",
        "extends: base.yaml\n"
        "groups: {rign: {color: red}, new: {color: red}}\n"
        "collisions: {gripp: {min_gap: 2}}\n"
        "forces: {wieght: {impulse: [0, 0, 0]}}\n",
    )
    assert refusal("top.yaml").split("\n") == [
        "top.yaml:2:10: groups.rign.shape: missing: string, ring, polygon, plane, block, ball or atoms; "
        "did you mean `ring`?",
        "top.yaml:2:30: groups.new.shape: missing: string, ring, polygon, plane, block, ball or atoms",
        "top.yaml:3:14: collisions.gripp: say exactly one of `within`, `between` or `among` (got none); "
        "did you mean `grip`?",
        "top.yaml:4:10: forces.wieght.kind: missing: "
        "damping, gravity, push, hold, oscillate, torque or tether; did you mean `weight`?",
    ]


def test_a_null_that_deletes_no_name(folder: Path) -> None:
    write(
        "top.yaml",
        "extends: base.yaml\ngroups: {rods: null, block: null}\nbonds:\n  glue:\nforces: {weight: null, wind: null}\n",
    )
    assert refusal("top.yaml").split("\n") == [
        "top.yaml:2:10: groups.rods: there is no `rods` to delete; did you mean `rod`?",
        "top.yaml:2:22: groups.block: there is no `block` to delete; the groups are ring, rod",
        "top.yaml:4:3: bonds.glue: there is no `glue` to delete; there are no bonds",
        "top.yaml:5:24: forces.wind: there is no `wind` to delete; there are no forces",
    ]


def test_a_null_may_say_that_a_key_keeps_its_default(folder: Path) -> None:
    write("top.yaml", "extends: base.yaml\njitter: null\nrender:\ngroups: {rod: {velocity: null}}\n")
    assert load("top.yaml").scene == load("base.yaml").scene


def test_a_key_without_a_value_deletes_nothing_unseen(folder: Path) -> None:
    write("base.yaml", GOOD.replace("count: 20", "count: 20, color: red"))
    write("top.yaml", "extends: base.yaml\ngroups:\n  ring:\n    color: #00f\n  rod:\n    velocity:\n")
    assert refusal("top.yaml").split("\n") == [
        'top.yaml:4:5: groups.ring.color: needs a value; `#` begins a comment, so put it in quotes: color: "#00f"',
        "top.yaml:6:5: groups.rod.velocity: needs a value; write `null` to leave it out",
    ]


def test_sections_and_names_without_contents_are_not_there() -> None:
    """As when all that stood in them was made a comment."""
    emptied = "jitter:\nbonds:\n  # a: {within: ring}\ncollisions:\n  a:\nrender:\n  camera:\n  colors:\n"
    assert loads(GOOD + emptied).scene == loads(GOOD).scene


def test_a_name_that_a_scene_between_deletes_in_vain_may_be_declared(folder: Path) -> None:
    write("mid.yaml", "extends: base.yaml\nforces: {wind: null}\n")
    write("top.yaml", "extends: mid.yaml\nforces: {wind: {kind: hold}}\n")
    assert list(load("top.yaml").scene.forces) == ["weight", "wind"]


@pytest.mark.parametrize(
    ("extends", "message"),
    [
        ("3", "needs the path of a scene file (got 3)"),
        ("#base.yaml", "needs the path of a scene file (got null)"),
        ("[base.yaml]", 'needs the path of a scene file (got ["base.yaml"])'),
        ("/etc/passwd", 'needs a path relative to this file (got "/etc/passwd")'),
        ('""', 'needs a path relative to this file (got "")'),
        ("../x.yaml", 'leads outside the folder of top.yaml (got "../x.yaml")'),
        ("link/x.yaml", 'leads outside the folder of top.yaml (got "link/x.yaml")'),
        ("bse.yaml", 'there is no such file (got "bse.yaml"); did you mean `base.yaml`?'),
        (
            "./parts/../bse.yaml",
            'there is no such file (got "./parts/../bse.yaml"); did you mean `parts/../base.yaml`?',
        ),
        ("nosuch.yaml", 'there is no such file (got "nosuch.yaml")'),
        ("top.yaml", "goes round in a circle: top.yaml → top.yaml"),
        ("./parts/../top.yaml", "goes round in a circle: top.yaml → top.yaml"),
    ],
)
def test_bad_extends(extends: str, message: str, folder: Path) -> None:
    Path("link").symlink_to("/")
    write("top.yaml", f"atomsim: 1\nextends: {extends}\n")
    assert refusal("top.yaml") == f"top.yaml:2:1: extends: {message}"


def test_extends_in_a_circle_shows_the_chain(folder: Path) -> None:
    write("a.yaml", "extends: b.yaml")
    write("b.yaml", "extends: sub/c.yaml")
    write("sub/c.yaml", "extends: ../a.yaml")
    assert refusal("a.yaml") == (
        "sub/c.yaml:1:1: extends: goes round in a circle: a.yaml → b.yaml → sub/c.yaml → a.yaml"
    )


def test_extends_through_too_many_files(folder: Path) -> None:
    for i in range(20):
        write(f"{i}.yaml", f"extends: {i + 1}.yaml")
    assert refusal("0.yaml") == "15.yaml:1:1: extends: goes through more than 16 files"


def test_bad_extended_file(folder: Path) -> None:
    write("top.yaml", "extends: base.yaml")
    write("base.yaml", "- a")
    assert refusal("top.yaml") == 'base.yaml:1:1: a scene is a mapping of keys such as `groups:` (got ["a"])'
    write("base.yaml", "a: [")
    assert refusal("top.yaml") == "base.yaml:2:1: a value or a closing bracket is missing"


def test_settings_replace_make_and_delete() -> None:
    loaded = loads(
        GOOD,
        overrides=[
            "forces.weight.impulse.2=-0.02",
            "forces.wind={kind: push, impulse: [1, 0, 0]}",
            "forces.wind.until_round=5",
            "groups.rod=null",
            " title = a = b",
        ],
    )
    assert loaded.scene.forces["weight"].impulse == (0, -0.01, -0.02)
    assert loaded.scene.forces["wind"].until_round == 5
    assert list(loaded.scene.groups) == ["ring"]
    assert loaded.scene.title == "a = b"


def test_settings_make_the_mappings_that_are_merely_not_written() -> None:
    settings = [
        "render.camera.azimuth=45",
        "render.rounds=[0, 10]",
        "render.colors.ring='#ff0000'",
        "jitter.amplitude=1e-9",
        "groups.rod.spin.axis=x",
        "groups.rod.spin.rate=1",
        "collisions.touch={within: ring}",
    ]
    scene = loads(GOOD, overrides=settings).scene
    assert (scene.render.camera.azimuth, scene.render.rounds, scene.render.colors) == (45, (0, 10), {"ring": "#ff0000"})
    assert scene.jitter is not None
    assert scene.jitter.amplitude == 1e-9
    assert scene.groups["rod"].spin is not None
    assert list(scene.collisions) == ["touch"]


def test_a_setting_replaces_a_mapping_whole() -> None:
    with pytest.raises(SceneError, match=r"forces\.weight\.impulse: missing"):
        loads(GOOD, overrides=["forces.weight={kind: gravity}"])


def test_a_shorter_run_need_not_change_what_is_shown() -> None:
    text = GOOD + "render: {rounds: [0, 100]}\n"
    assert loads(text, overrides=["rounds=50"]).scene.rounds == 50
    assert loads(loads(text, overrides=["rounds=50"]).source.text).scene.render.rounds == (0, 100)


@pytest.mark.parametrize(
    "setting", ["\x1b[31m=1", "\udc80.x=1", "\udc80=1", "render.colors.\udc80=red", "title=1\n2", "forces.a\nb=1"]
)
def test_what_a_terminal_would_obey_is_escaped(setting: str) -> None:
    with pytest.raises(SceneError) as caught:
        loads(GOOD, overrides=["rounds=many", setting])
    assert all(line.isprintable() for line in str(caught.value).split("\n"))


def test_too_many_mistakes_are_counted() -> None:
    positions = ", ".join(["x"] * 1000)
    with pytest.raises(SceneError) as caught:
        loads(
            f"atomsim: 1\ntime_step: 1\nrounds: 1\ngroups: {{a: {{shape: atoms, positions: [{positions}]}}}}", "s.yaml"
        )
    assert len(caught.value.problems) == MOST_TOLD + 1
    assert str(caught.value.problems[-1]) == "s.yaml:1:1: and 900 more mistakes"


def node(value: object) -> Node:
    """Return plain data as a tree."""
    mark = Mark("t", 1, 1)
    if isinstance(value, dict):
        return Node({key: node(inner) for key, inner in value.items()}, mark)
    if isinstance(value, list):
        return Node([node(inner) for inner in value], mark)
    assert value is None or isinstance(value, (str, int, float))
    return Node(value, mark)


@pytest.mark.parametrize(
    ("base", "top", "merged"),
    [
        ({"a": 1, "b": 2}, {"c": 3, "a": 4}, {"a": 4, "b": 2, "c": 3}),
        ({"a": {"b": 1, "c": 2}}, {"a": {"c": 3}}, {"a": {"b": 1, "c": 3}}),
        ({"a": [1, 2]}, {"a": [3]}, {"a": [3]}),
        ({"a": {"b": 1}}, {"a": 2}, {"a": 2}),
        ({"a": 2}, {"a": {"b": 1}}, {"a": {"b": 1}}),
        ({"a": 1, "b": 2}, {"a": None}, {"b": 2}),
        ({"a": {"b": 1}}, {"a": {"b": None}}, {"a": {}}),
        ({"a": 1}, {"b": {"c": None}}, {"a": 1, "b": {}}),
        ({"a": None, "b": 1}, {"a": 2}, {"b": 1, "a": 2}),
        ({"a": 1}, {"a": [None]}, {"a": [None]}),
    ],
)
def test_merge(base: object, top: object, merged: dict[str, object]) -> None:
    result = without_nulls(merge(node(base), node(top)).plain())
    assert result == merged
    assert list(result) == list(merged)
