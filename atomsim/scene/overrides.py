"""Settings of the command line, `PATH=VALUE`, laid over a scene; knows the tree and no language."""

from __future__ import annotations

from collections.abc import Iterable

from atomsim.errors import Mark, Problem, SceneError
from atomsim.scene.source import Path, dotted
from atomsim.scene.strict_yaml import read_yaml
from atomsim.scene.tree import Node
from atomsim.scene.wording import meant, readable, shown

_FILE = "--set "


def is_setting(mark: Mark) -> bool:
    """Tell whether a setting wrote the value, and not a file."""
    return mark.line == 0 and mark.file.startswith(_FILE)


def override(root: Node, settings: Iterable[str]) -> Node:
    """Apply settings in order.

    Args:
        root: the tree of a scene.
        settings: each `PATH=VALUE`, PATH dotted (`forces.weight.impulse.2`), VALUE strict YAML. The value replaces
            what stands there; a new key may be made in a mapping that exists; null deletes a key that exists.

    Returns:
        A new tree, in which the values are marked with their setting.

    Raises:
        SceneError: settings that are none or lead nowhere, all of them.
    """
    problems: list[Problem] = []
    for setting in settings:
        mark = Mark(_FILE + readable(setting), 0, 0)
        try:
            root = _apply(root, setting, mark)
        except SceneError as error:
            problems.extend(error.problems)
    if problems:
        raise SceneError(problems)
    return root


def _apply(root: Node, setting: str, mark: Mark) -> Node:
    path, equals, value = setting.partition("=")
    if not equals:
        raise _refused(mark, (), "a setting is PATH=VALUE; the `=` is missing")
    parts = tuple(path.strip().split("."))
    if not all(parts):
        raise _refused(mark, (), "a path is keys and indices with a dot between two, like `forces.weight.impulse.2`")
    if parts[0] == "extends":
        raise _refused(mark, parts, "only a scene file can extend another")
    node = read_yaml(value, lambda line, column: mark, parts)
    return _set(root, (), parts, node)


def _set(at: Node, done: Path, rest: tuple[str, ...], node: Node) -> Node:
    """Return a copy of the value at the path `done` in which `rest` leads to the node."""
    key, *deeper = rest
    if isinstance(at.value, dict):
        return Node(_set_key(at.value, (*done, key), tuple(deeper), node), at.mark)
    if isinstance(at.value, list):
        index = _index(key, len(at.value), done, node.mark)
        item = _set(at.value[index], (*done, index), tuple(deeper), node) if deeper else node
        return Node([*at.value[:index], item, *at.value[index + 1 :]], at.mark)
    raise _refused(node.mark, (*done, key), f"`{dotted(done)}` is {shown(at.value)}; there is nothing inside")


def _set_key(entries: dict[str, Node], path: Path, deeper: tuple[str, ...], node: Node) -> dict[str, Node]:
    key = str(path[-1])
    known = entries.get(key)
    exists = known is not None and known.value is not None
    if exists and known is not None and deeper:
        return {**entries, key: _set(known, path, deeper, node)}
    if not exists and (deeper or node.value is None):
        raise _refused(node.mark, path, _nothing_there(entries, path, deeper, node))
    kept = {name: entry for name, entry in entries.items() if exists or name != key}
    return {**kept, key: node if node.value is not None else node.deleting()}


def _nothing_there(entries: dict[str, Node], path: Path, deeper: tuple[str, ...], node: Node) -> str:
    present = [name for name, entry in entries.items() if entry.value is not None]
    remedy = meant(str(path[-1]), present, "there are") if present else "nothing is declared here"
    if deeper and node.value is not None and not remedy.endswith("?"):
        whole = "".join(f"{{{readable(part)}: " for part in deeper) + shown(node.plain()) + "}" * len(deeper)
        remedy = f"make it whole with `{dotted(path)}={whole}`"
    return f"there is no `{readable(str(path[-1]))}`; {remedy}"


def _index(key: str, n_items: int, done: Path, mark: Mark) -> int:
    if key.isascii() and key.isdecimal() and len(key) < 10 and int(key) < n_items:
        return int(key)
    indices = f"0 to {n_items - 1}" if n_items else "none, for it is empty"
    raise _refused(mark, (*done, key), f"`{dotted(done)}` is a list; its indices are {indices}")


def _refused(mark: Mark, path: Path, message: str) -> SceneError:
    return SceneError([Problem(mark, dotted(path), message)])
