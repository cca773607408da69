"""Scene files to validated scenes with the place of every value; knows no atoms (the compiler makes them)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, BinaryIO

from pydantic import ValidationError

from atomsim import arguments
from atomsim.errors import InputError, SceneError
from atomsim.scene.files import read_scene_file, read_scene_stream, read_scene_text
from atomsim.scene.language import Camera, Scene
from atomsim.scene.mistakes.blanks import check_blanks
from atomsim.scene.mistakes.mistake import Mistake, told
from atomsim.scene.mistakes.references import check_deletions, check_references, check_silences
from atomsim.scene.overrides import override
from atomsim.scene.source import Source
from atomsim.scene.yaml.tree import Node, Places, without_nulls
from atomsim.scene.yaml.written import to_yaml


@dataclass(frozen=True, slots=True)
class LoadedScene:
    """A valid scene and where it came from."""

    scene: Scene
    source: Source = field(default_factory=Source)

    def __post_init__(self) -> None:
        arguments.instance("scene", self.scene, Scene, "a Scene, as atomsim.load puts it here")
        arguments.instance("source", self.source, Source, "a Source, as atomsim.load puts it here")


def load(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> LoadedScene:
    """Load a scene file.

    Args:
        path: the file; what it `extends` is looked up beside it.
        overrides: settings `PATH=VALUE`, applied in order after `extends`.

    Returns:
        The scene, and its source with the resolved text.

    Raises:
        SceneError: everything that is wrong with the scene, in the order of the file.
        InputError: an argument that will not do.
    """
    name = os.fspath(path) if isinstance(path, str | os.PathLike) else None
    if not isinstance(name, str) or not name:
        raise arguments.refused("path", "the name of a file", path)
    return _loaded(read_scene_file(name), name, overrides)


def load_stream(stream: BinaryIO, name: str, overrides: Iterable[str] = ()) -> LoadedScene:
    """Load a scene from a stream such as standard input; what it `extends` is looked up in the current folder.

    Args:
        stream: the scene as bytes.
        name: what to call it in messages.
        overrides: settings `PATH=VALUE`, applied in order after `extends`.

    Returns:
        The scene, and its source with the resolved text.

    Raises:
        SceneError: everything that is wrong with the scene, in the order of the text.
    """
    return _loaded(read_scene_stream(stream, name), name, overrides)


def loads(text: str, name: str = "<scene>", overrides: Iterable[str] = ()) -> LoadedScene:
    """Load a scene from a text, such as the one inside a trajectory; it extends no file.

    Args:
        text: the scene as YAML.
        name: what to call it in messages.
        overrides: settings `PATH=VALUE`, applied in order.

    Returns:
        The scene, and its source with the resolved text.

    Raises:
        SceneError: everything that is wrong with the scene, in the order of the text.
        InputError: an argument that will not do.
    """
    arguments.instance("text", text, str, "a scene as text")
    arguments.instance("name", name, str, "a text")
    if text.strip().endswith((".yaml", ".yml", ".json")) and len(text.split()) == 1:
        raise arguments.refused("text", "a scene as text, while atomsim.load takes the name of a file", text)
    return _loaded(read_scene_text(text, name), name, overrides)


_DIRECTION, _MIDDLE = {"view", "azimuth", "elevation"}, {"look_at", "follow", "close_up"}
_INSTEAD = (({"view"}, _DIRECTION), ({"azimuth", "elevation"}, {"view"}), (_MIDDLE, _MIDDLE))
"""Keys of a camera and those in whose place they come."""


def camera_with(scene: Scene, changes: Mapping[str, Any]) -> Camera:
    """Return the camera of a scene with some of its keys changed, for those who look from elsewhere.

    Args:
        scene: the scene.
        changes: keys of a camera and their values, as a scene has them. A direction by name takes the place of the
            angles of the scene, and they of it; so do `look_at`, `follow` and `close_up` of each other.

    Raises:
        InputError: everything that is wrong with the changes.
    """
    said = scene.render.camera.model_dump(exclude_unset=True)
    replaced = set().union(*(others for keys, others in _INSTEAD if keys & set(changes)))
    said = {key: value for key, value in said.items() if key not in replaced}
    nothing = {"shape": "atoms", "positions": [[0, 0, 0]]}
    data = {
        "atomsim": 1,
        "time_step": 1,
        "rounds": 1,
        "groups": dict.fromkeys(scene.groups, nothing),
        "render": {"camera": {**said, **changes}},
    }
    source = Source()
    mistakes = check_references(data, source)
    changed = _validated(data, source, mistakes)
    if mistakes or changed is None:
        problems = told(mistakes, source)
        raise InputError(
            "\n".join(f"{problem.path.removeprefix('render.')}: {problem.message}" for problem in problems)
        )
    return changed.render.camera


def _loaded(root: Node, name: str, overrides: Iterable[str]) -> LoadedScene:
    """Validate a merged tree."""
    overrides = arguments.texts("overrides", overrides, 'texts such as ["rounds=5"]')
    root = override(root, overrides)
    data = root.plain()
    source = Source(name=name, overrides=overrides, marks=Places(root))
    present = without_nulls(data)
    mistakes = [*check_blanks(root, data), *check_deletions(root)]
    mistakes += [*check_references(present, source), *check_silences(present, source)]
    scene = _validated(data, source, mistakes)
    if mistakes or scene is None:
        raise SceneError(told(mistakes, source))
    return LoadedScene(scene, Source(name, to_yaml(present), overrides, source.marks))


def _validated(data: dict[str, Any], source: Source, mistakes: list[Mistake]) -> Scene | None:
    """Make a scene of plain data, or add to the mistakes what is wrong with them."""
    try:
        return Scene.model_validate(data)
    except ValidationError as error:
        from atomsim.scene.mistakes.complaints import complaints  # only a mistake needs it

        mistakes += complaints(error, data, source)
        return None
