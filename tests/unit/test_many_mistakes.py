"""Very many mistakes of one kind: only the first are put into words, and the cost grows no faster than their number."""

from __future__ import annotations

import difflib

import pytest

from atomsim.errors import SceneError
from atomsim.scene.loader import loads
from atomsim.scene.mistakes.mistake import MOST_TOLD
from atomsim.scene.yaml.tree import Places

N = 4000
HEAD = "atomsim: 1\ntime_step: 0.1\nrounds: 10\n"
RING = "shape: ring, count: 3, radius: 3"
GROUP = f"groups:\n  a: {{{RING}}}\n"


def each(line: str, between: str = "") -> str:
    """Return a line for each of many numbers."""
    return between.join(line.replace("#", str(number)) for number in range(N))


MANY = {
    "unknown keys": HEAD + GROUP + each("k#: 1\n"),
    "misspelt keys": HEAD + GROUP + each("round#: 1\n"),
    "unknown keys of a group": HEAD + f"groups: {{a: {{{RING}, {each('k#: 1', ', ')}}}}}",
    "unknown keys of a group without a shape": HEAD + f"groups: {{a: {{shap: ring, {each('k#: 1', ', ')}}}}}",
    "misspelt shapes": HEAD + "groups:\n" + each("  g#: {shape: rong}\n"),
    "shapes left out": HEAD + "groups:\n" + each("  g#: {count: 3}\n"),
    "misspelt keys that are missing": HEAD + "groups:\n" + each("  g#: {shape: ring, cuont: 3}\n"),
    "no names": HEAD + "groups:\n" + each(f"  g.#: {{{RING}}}\n"),
    "groups that are not there": HEAD + GROUP + "forces:\n" + each("  f#: {kind: hold, acts_on: b#}\n"),
    "groups that are not there, of many": HEAD
    + "groups:\n"
    + each(f"  g#: {{{RING}}}\n")
    + "forces:\n"
    + each("  f#: {kind: hold, acts_on: h#}\n"),
    "no selections": HEAD + GROUP + f"forces: {{f: {{kind: hold, acts_on: [{each('b#!', ', ')}]}}}}",
    "values left out": HEAD + "groups:\n" + each(f"  g#: {{{RING}, color: }}\n"),
    "duplicates": HEAD + GROUP + each("title: x\n"),
    "tags": HEAD + GROUP + each("k#: !!str x\n"),
    "texts for points": HEAD + f"groups: {{a: {{shape: atoms, positions: [{each('x', ', ')}]}}}}",
    "no colors": HEAD + GROUP + f"render: {{colors: {{{each('b#: rde', ', ')}}}}}",
    "collisions of nothing": HEAD + GROUP + "collisions:\n" + each("  c#: {}\n"),
}


@pytest.mark.parametrize("kind", MANY)
def test_very_many_mistakes(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = {"comparisons": 0, "places": 0}
    compare, look_up = difflib.get_close_matches, Places.__getitem__

    def counted_compare(*arguments: object, **options: object) -> object:
        calls["comparisons"] += 1
        return compare(*arguments, **options)  # type: ignore[arg-type]

    def counted_look_up(places: Places, path: tuple[str | int, ...]) -> object:
        calls["places"] += 1
        return look_up(places, path)

    monkeypatch.setattr(difflib, "get_close_matches", counted_compare)
    monkeypatch.setattr(Places, "__getitem__", counted_look_up)
    with pytest.raises(SceneError) as caught:
        loads(MANY[kind], "s.yaml")
    assert len(caught.value.problems) == MOST_TOLD + 1
    assert str(caught.value.problems[-1]).startswith("s.yaml:1:1: and ")
    assert calls["comparisons"] < 0.7 * N
    assert calls["places"] < 2 * MOST_TOLD * N
