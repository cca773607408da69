"""Whatever stands under whichever key, the message is in the words of the language and not in those of pydantic."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from atomsim.errors import SceneError
from atomsim.scene.declarations import discriminator, inner_declarations, sections
from atomsim.scene.field_docs import examples
from atomsim.scene.language import Declaration, Scene
from atomsim.scene.loader import loads
from atomsim.scene.yaml.written import to_yaml

VALUES: list[Any] = [
    True, 0, 1, -1, 7, 10**20, 10**300, 1.5, -0.5, 1e-320, 1e300, float("nan"), float("inf"), "x", "", "all", "1",
    "rope", "z", "é", "\u2028", [], [1], [1, 2], [1, 2, 3], [1, 2, 3, 4], ["x", "y"], [[1, 2, 3]], [[1]], [["x"]],
    [None], [[]], {}, {"a": 1}, {"a": {}}, {"axis": "z"}, [{}], [{"a": 1}], {"count": 2}, ["rope"], [["rope"], "rope"],
]  # fmt: skip
OF_PYDANTIC = ("Input", "should be", "Value error", "Field required", "valid ", "Extra inputs", "instance of")


def smallest(declaration: type[Declaration]) -> dict[str, Any]:
    """Return a declaration with what it must have."""
    chosen = discriminator(declaration)
    must = [key for key, field in declaration.fields_by_key().items() if field.is_required()]
    begin = {key: value for key in must for value in examples(declaration, key)}
    return begin | ({chosen[0]: chosen[1]} if chosen is not None else {})


def places() -> Iterator[tuple[str, list[str], type[Declaration]]]:
    """Yield every declaration, once, with the keys that lead to it."""
    outer = [([name, "rope"], kind) for name, section in sections().items() for kind in section.declarations]
    seen = set()
    for path, declaration in [([], Scene), *outer]:
        for deeper, inner in [((), declaration), *inner_declarations(declaration)]:
            if inner not in seen:
                seen.add(inner)
                yield inner.__name__, [*path, *map(str, deeper)], inner


def written(path: list[str], value: Any) -> dict[str, Any]:
    """Return a scene with a value at a path, and what must be on the way to it."""
    scene: dict[str, Any] = smallest(Scene)
    at = scene
    for key in path[:-1]:
        at[key] = dict(at.get(key) or {})
        at = at[key]
    at[path[-1]] = value
    return scene


@pytest.mark.parametrize(("path", "declaration"), [pytest.param(path, kind, id=name) for name, path, kind in places()])
def test_no_message_is_that_of_pydantic(path: list[str], declaration: type[Declaration]) -> None:
    for key in [*declaration.fields_by_key(), "nonsense"]:
        for value in VALUES:
            whole = {**smallest(declaration), key: value}
            scene = written(path, whole) if path else {**smallest(Scene), key: value}
            try:
                loads(to_yaml(scene), "s")
            except SceneError as error:
                text = str(error)
                assert not any(words in text for words in OF_PYDANTIC), (key, value, text)
                assert all(line.isprintable() for line in text.split("\n")), (key, value, text)
