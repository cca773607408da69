"""Settings of the command line, `PATH=VALUE`, laid over a scene; knows the tree, of the language only its mappings."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable

from atomsim.errors import Mark, Problem, SceneError
from atomsim.scene.language.names import normalised
from atomsim.scene.mistakes.wording import meant, readable, shown, suggestion
from atomsim.scene.source import KeyPath, dotted
from atomsim.scene.yaml.strict_yaml import read_yaml
from atomsim.scene.yaml.tree import Node

_FILE = "--set "


def is_setting(mark: Mark) -> bool:
    """Tell whether a setting wrote the value, and not a file."""
    return mark.line == 0 and mark.file.startswith(_FILE)


def override(root: Node, settings: Iterable[str]) -> Node:
    """Apply settings in order.

    Args:
        root: the tree of a scene.
        settings: each `PATH=VALUE`, PATH dotted (`forces.weight.impulse.2`), VALUE strict YAML. The value replaces
            what stands there; a new key may be made in a mapping that exists, or that the language has and the scene
            does not write (`render`, `render.camera`, `jitter`); null deletes a key that exists.

    Returns:
        A new tree, in which the values are marked with their setting.

    Raises:
        SceneError: settings that are none or lead nowhere, all of them.
    """
    problems: list[Problem] = []
    for setting in settings:
        try:
            root = _Setting(root, setting).applied()
        except SceneError as error:
            problems.extend(error.problems)
    if problems:
        raise SceneError(problems)
    return root


class _Setting:
    """One setting on its way into a tree."""

    def __init__(self, root: Node, setting: str) -> None:
        self._root = root
        self._mark = Mark(_FILE + readable(setting), 0, 0)
        path, equals, value = setting.partition("=")
        if not equals:
            raise self._refused((), "a setting is PATH=VALUE; the `=` is missing")
        self._parts = tuple(normalised(path).strip().split("."))
        if not path.isprintable():
            raise self._refused((), "a path is made of names; there is a character in it that cannot be seen")
        in_brackets = re.search(r"\[(-?[0-9]+)\]", path) if self._parts[:2] != ("render", "colors") else None
        if in_brackets is not None or "/" in path or not all(self._parts):
            raise self._refused((), "a path is keys and indices with a dot between two, like `forces.weight.impulse.2`")
        if self._parts[0] == "extends":
            raise self._refused(self._parts, "only a scene file can extend another")
        if value.lstrip().startswith("#"):
            quoted = shlex.quote(f"{path.strip()}={shown(value.strip())}")
            raise self._refused(self._parts, f"`#` begins a comment; put the value in quotes: --set {readable(quoted)}")
        self._node = self._read(value)

    def _read(self, value: str) -> Node:
        try:
            return read_yaml(value, lambda line, column: self._mark, self._parts)
        except SceneError as error:
            if re.search(r",\s*[\w.-]+=", value):
                raise self._refused(self._parts, f"{error.problems[0].message}; each setting stands alone") from None
            raise

    def applied(self) -> Node:
        """Return a tree in which the path leads to the value."""
        return self._set(self._root, (), self._parts)

    def _set(self, at: Node, done: KeyPath, rest: tuple[str, ...]) -> Node:
        """Return a copy of the value at the path `done` in which `rest` leads to the new value."""
        key, *deeper = rest
        if isinstance(at.value, dict):
            return Node(self._set_key(at.value, (*done, key), tuple(deeper)), at.mark)
        if isinstance(at.value, list):
            index = self._index(key, len(at.value), done)
            item = self._set(at.value[index], (*done, index), tuple(deeper)) if deeper else self._node
            return Node([*at.value[:index], item, *at.value[index + 1 :]], at.mark)
        raise self._refused((*done, key), f"`{dotted(done)}` is {shown(at.value)}; there is nothing inside")

    def _set_key(self, entries: dict[str, Node], path: KeyPath, deeper: tuple[str, ...]) -> dict[str, Node]:
        key = str(path[-1])
        known = entries.get(key)
        if known is not None and known.value is not None:
            if deeper:
                return {**entries, key: self._set(known, path, deeper)}
            return {**entries, key: self._node if self._node.value is not None else self._node.deleting()}
        if self._node.value is None:
            present = [name for name, entry in entries.items() if entry.value is not None]
            raise self._not_there(path, meant(key, present, "there are") if present else "nothing is declared here")
        kept = {name: entry for name, entry in entries.items() if name != key}
        if not deeper:
            return {**kept, key: self._node}
        self._require_mapping(entries, path)
        return {**kept, key: self._set(Node({}, self._mark), path, deeper)}

    def _require_mapping(self, entries: dict[str, Node], path: KeyPath) -> None:
        """Refuse to go on into what is not written, unless the language has a mapping there."""
        from atomsim.scene.declarations import declaration_at, is_mapping  # only a few settings
        from atomsim.scene.field_docs import descriptions, form  # need them

        key = str(path[-1])
        declaration = declaration_at(path[:-1], self._root.plain())
        if declaration is None:
            close = suggestion(key, entries)
            whole = f"make it whole with `{dotted(path)}={{…}}`"
            raise self._not_there(path, whole if close is None else f"did you mean `{readable(close)}`?")
        if key not in declaration.fields_by_key():
            raise self._not_there(path, meant(key, descriptions(declaration), "the keys here are"))
        if not is_mapping(declaration, key):
            whole = f"{dotted(path)}={form(declaration, key)}"
            raise self._refused(path, f"`{key}` is not written; set it whole, as `{whole}`")

    def _index(self, key: str, n_items: int, done: KeyPath) -> int:
        if key.isascii() and key.isdecimal() and len(key) < 10 and int(key) < n_items:
            return int(key)
        indices = f"0 to {n_items - 1}" if n_items else "none, for it is empty"
        raise self._refused((*done, key), f"`{dotted(done)}` is a list; its indices are {indices}")

    def _not_there(self, path: KeyPath, remedy: str) -> SceneError:
        return self._refused(path, f"there is no `{readable(str(path[-1]))}`; {remedy}")

    def _refused(self, path: KeyPath, message: str) -> SceneError:
        return SceneError([Problem(self._mark, dotted(path), message)])
