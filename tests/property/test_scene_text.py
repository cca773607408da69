"""Whatever stands in a scene file, loading ends in a scene or in its mistakes, and text stands for its scene."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from functools import partial
from typing import Any

from hypothesis import example, given
from hypothesis import strategies as st

from atomsim.errors import Mark, Problem, SceneError
from atomsim.scene.loader import LoadedScene, load, loads
from atomsim.scene.yaml.strict_yaml import read_yaml
from atomsim.scene.yaml.tree import Node, merge, without_nulls
from atomsim.scene.yaml.written import to_yaml

GOOD = """\
atomsim: 1
time_step: 0.01
rounds: 100
groups:
  ring: {shape: ring, count: 20, radius: 4}
  floor: {shape: plane, counts: [3, 4], step_x: [2, 0, 0], step_y: [0, 0, 2], rotate: {axis: x, degrees: 3}}
bonds: {hoop: {within: "ring[0:10]", rule: neighbour}}
collisions: {contact: {between: [ring, floor]}}
forces: {weight: {kind: gravity, impulse: [0, -0.01, 0]}}
render: {rounds: [0, 100], camera: {up: y}, colors: {ring: red}}
"""

PRINTABLE = st.characters(codec="utf-8", exclude_categories=["C"]) | st.sampled_from("\x85\u2028\u2029\ufeff\ue000\n")
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False),
    st.text(PRINTABLE),
    st.sampled_from(
        ["1e5", "1e-3", "+.5", "010", "0x1F", "yes", "true", "~", "<<", "=", "1_0", "- a", "a: b", "a #b", "…"]
    ),
    st.text("0123456789.eE+-_xo:~ \n'\"#", max_size=8),
)


def mappings(values: st.SearchStrategy[Any]) -> st.SearchStrategy[dict[str, Any]]:
    """Make mappings with any text for keys, but often the same; keys are read as they are composed in Unicode (NFC)."""
    texts = st.text(PRINTABLE, max_size=5).map(partial(unicodedata.normalize, "NFC"))
    return st.dictionaries(st.sampled_from("abc") | texts, values, max_size=4)


DATA = st.recursive(SCALARS, lambda inner: st.lists(inner, max_size=4) | mappings(inner), max_leaves=20)


WORDS = st.sampled_from(
    [
        "shape",
        "ring",
        "rule",
        "kind",
        "gravity",
        "within",
        "axis",
        "centre",
        "rest",
        "colors",
        "render",
        "null",
        "rounds",
    ]
)
SCENE_LIKE = st.recursive(
    SCALARS | WORDS,
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(WORDS | st.text(PRINTABLE, max_size=3), inner, max_size=4)
    ),
    max_leaves=12,
)


def problems_of(load_scene: Callable[[], LoadedScene]) -> tuple[Problem, ...]:
    """Load a scene; anything but a scene or its mistakes is an error of ours."""
    try:
        load_scene()
    except SceneError as error:
        return error.problems or (Problem(Mark("", 0, 0), "", "\n"),)
    return ()


def ends_well(text: str, overrides: tuple[str, ...] = ()) -> None:
    """Check that each mistake of a scene is one printable line."""
    assert all(str(problem).isprintable() for problem in problems_of(lambda: loads(text, "s", overrides)))


def read(text: str) -> Any:
    """Return the plain data of a text."""
    return read_yaml(text, lambda line, column: Mark("t", line, column)).plain()


def node(data: Any) -> Node:
    """Return plain data as a tree, by way of their text."""
    return read_yaml(to_yaml(data), lambda line, column: Mark("t", line, column))


@given(st.text())
@example("a: &a [*a]")
@example("? ? ? a")
@example("'\\ud800'")
def test_any_text(text: str) -> None:
    ends_well(text)


@given(st.text("abc:-[]{}&*!|>'\"%@`?,#\n\t ~1.<", max_size=40))
def test_any_punctuation(text: str) -> None:
    ends_well(text)


@given(st.binary())
def test_any_bytes(tmp_path_factory: Any, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_bytes(data)
    assert all(str(problem).isprintable() for problem in problems_of(lambda: load(path)))


@given(st.integers(0, len(GOOD)), st.integers(0, 12), st.text("ab1:-[]{},&*!'\"# \n\t.", max_size=4))
def test_any_edit_of_a_good_scene(start: int, length: int, inserted: str) -> None:
    ends_well(GOOD[:start] + inserted + GOOD[start + length :])


@given(st.dictionaries(st.sampled_from(list(read(GOOD))), SCENE_LIKE, max_size=3))
def test_any_value_in_a_good_scene(changes: dict[str, Any]) -> None:
    ends_well(to_yaml({**read(GOOD), **changes}))


@given(
    st.sampled_from(
        ["groups.ring", "groups.floor.rotate", "bonds.hoop", "collisions.contact", "forces.weight", "render"]
    ),
    st.sampled_from(
        ["", ".shape", ".axis", ".rule", ".within", ".between", ".acts_on", ".impulse.1", ".colors", ".x.y"]
    ),
    SCENE_LIKE.map(lambda data: to_yaml(data)) | st.text(max_size=8),
)
def test_any_setting(parent: str, key: str, value: str) -> None:
    ends_well(GOOD, (f"{parent}{key}={value}",))


@given(st.text())
@example("0.\ud7fc=1")
def test_any_text_as_a_setting(setting: str) -> None:
    ends_well(GOOD, (setting,))


@given(DATA)
def test_data_survive_writing_and_reading(data: Any) -> None:
    again = read(to_yaml(data))
    assert again == data
    assert repr(again) == repr(data)  # types, order of keys, the sign of zero


@given(mappings(DATA), mappings(DATA))
@example({"a": [], "b": 1, "c": None}, {"a": None, "c": None})
def test_merging_laws(base: dict[str, Any], top: dict[str, Any]) -> None:
    assert merge(node(base), node({})).plain() == base
    assert merge(node({}), node(top)).plain() == top
    merged = merge(node(base), node(top)).plain()
    again = merge(node(merged), node(top)).plain()
    assert without_nulls(again) == without_nulls(merged)  # a null that deleted finds nothing to delete the next time
    deleted = {key for key, value in base.items() if value is not None and top.get(key, value) is None}
    assert set(merged) == {*base, *top} - deleted
    assert [key for key in merged if key not in top] == [key for key in base if key not in top]
