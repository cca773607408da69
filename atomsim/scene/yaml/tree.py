"""Scene text as a tree of plain values that remember where they were written; knows neither YAML nor the language."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from atomsim.errors import Mark
from atomsim.scene.source import KeyPath

Scalar: TypeAlias = str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Node:
    """A value and its place; in a mapping, the place of its key. Nodes are never changed, so they may be shared.

    A node that `deletes` is the null that took the place of a value: it is no part of the scene any more, but a mistake
    that it makes can still be reported at its place. A node that `deletes_nothing` is the null that took no place.
    A `blank` is the null of a key without a value: the comment behind the key, often empty.
    """

    value: Scalar | dict[str, Node] | list[Node]
    mark: Mark
    deletes: bool = False
    deletes_nothing: bool = False
    blank: str | None = None

    def deleting(self) -> Node:
        """Return the null, laid over a value."""
        return replace(self, deletes=True)

    def deleting_nothing(self) -> Node:
        """Return the null, laid over nothing."""
        return replace(self, deletes_nothing=True)

    def child(self, part: str | int) -> Node | None:
        """Return the value under a key or an index, or None."""
        if isinstance(self.value, dict) and isinstance(part, str):
            return self.value.get(part)
        if isinstance(self.value, list) and isinstance(part, int) and 0 <= part < len(self.value):
            return self.value[part]
        return None

    def plain(self) -> Any:
        """Return the value without the marks: dicts, lists and scalars, all of them fresh."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items() if not node.deletes}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        return self.value


_NOTHING = Node(None, Mark("", 0, 0))


def merge(base: Node, top: Node) -> Node:
    """Lay one scene over another: mappings merge by key, everything else replaces.

    Keys of the base keep their order, new ones follow. A null deletes; what is declared again after it is new and comes
    last.
    """
    if not isinstance(top.value, dict):
        return top
    merged = dict(base.value) if isinstance(base.value, dict) else {}
    for key, node in top.value.items():
        known = merged.get(key)
        if known is None or known.value is None:
            merged.pop(key, None)
            merged[key] = merge(_NOTHING, node) if node.value is not None else node.deleting_nothing()
        else:
            merged[key] = merge(known, node) if node.value is not None else node.deleting()
    return Node(merged, top.mark)


def without_nulls(data: Any) -> Any:
    """Return plain data without the keys that are null."""
    if isinstance(data, dict):
        return {key: without_nulls(value) for key, value in data.items() if value is not None}
    if isinstance(data, list):
        return [without_nulls(value) for value in data]
    return data


class Places(Mapping[KeyPath, Mark]):
    """The place of every value of a tree by path, looked up in the tree itself."""

    def __init__(self, root: Node) -> None:
        self._root = root

    def __getitem__(self, path: KeyPath) -> Mark:
        node: Node | None = self._root
        for part in path:
            node = node.child(part) if node is not None else None
        if node is None:
            raise KeyError(path)
        return node.mark

    def __iter__(self) -> Iterator[KeyPath]:
        return _paths(self._root, ())

    def __len__(self) -> int:
        return sum(1 for _ in self)


def _paths(node: Node, path: KeyPath) -> Iterator[KeyPath]:
    yield path
    children = node.value.items() if isinstance(node.value, dict) else ()
    items = enumerate(node.value) if isinstance(node.value, list) else ()
    for part, child in (*children, *items):
        yield from _paths(child, (*path, part))
