"""Keys with nothing behind them, where a value is meant: a default would take its place unseen; knows no values."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial
from typing import Any

from atomsim.scene.mistakes.mistake import Mistake
from atomsim.scene.mistakes.wording import readable, shown
from atomsim.scene.source import KeyPath
from atomsim.scene.yaml.tree import Node


def check_blanks(root: Node, data: dict[str, Any]) -> list[Mistake]:
    """Find keys that may be left out, and are written without a value.

    A key that must have a value is left to validation. A section or a name with nothing below it is one whose contents
    were taken out, and `null` says that a key is meant to be left out.

    Args:
        root: the merged tree of a scene.
        data: its plain data.
    """
    return [
        Mistake(node.mark, path, partial(_message, str(path[-1]), node.blank or ""))
        for path, node in _blanks(root, ())
        if _is_single(path, data)
    ]


def _blanks(node: Node, path: KeyPath) -> Iterator[tuple[KeyPath, Node]]:
    """Yield every key without a value, in the order of the tree."""
    if isinstance(node.value, dict):
        for key, inner in node.value.items():
            yield from _blanks(inner, (*path, key))
    elif node.blank is not None:
        yield path, node


def _is_single(path: KeyPath, data: dict[str, Any]) -> bool:
    """Tell whether a key may be left out and takes a value, not further keys or names."""
    from atomsim.scene.declarations import declaration_at, is_mapping  # only a mistake needs it

    key, declaration = str(path[-1]), declaration_at(path[:-1], data)
    if declaration is None:
        return path[:-1] == ("render", "colors")
    field = declaration.fields_by_key().get(key)
    return field is not None and not field.is_required() and not is_mapping(declaration, key)


def _message(key: str, comment: str) -> str:
    """Say what is missing, and how to write a value that became a comment, or that none is meant."""
    value = re.match(r"#[^ #](?:.*?\S)??(?=\s+#|\s*$)", comment)
    if value is None:
        return "needs a value; write `null` to leave it out"
    return f"needs a value; `#` begins a comment, so put it in quotes: {readable(key)}: {shown(value[0])}"
