"""The grammar of selections, text to plain parts; knows no groups and no atoms (the compiler resolves them)."""

from __future__ import annotations

import re
from dataclasses import dataclass

from atomsim.scene.language.names import is_name, normalised
from atomsim.scene.mistakes.wording import readable

_EXPRESSION = re.compile(r"\s*([^\s\[\].]+)(?:\.([0-9]{1,9}))?\s*(?:\[([^\[\]]*)\]\s*)?", re.ASCII)
_NUMBER = re.compile(r"\s*([+-]?[0-9]{1,18})\s*", re.ASCII)


class SelectionSyntaxError(ValueError):
    """A selection that cannot be read; the message says how it should look."""


@dataclass(frozen=True, slots=True)
class SelectionPart:
    """One parsed expression: a group name (or `all`) and an index or slice per axis; no axes means all atoms.

    `copy` is the number of one copy of the group; None means each of them.
    """

    group: str
    axes: tuple[int | slice, ...]
    copy: int | None = None


def parse_selection(text: str) -> SelectionPart:
    """Read one selection expression.

    Args:
        text: `ring`, `ring[3]`, `ring[-1]`, `ring[0:10]`, `ring[::2]`, `floor[0, :]`, `finger.2`, `finger.2[0]`, `all`.

    Returns:
        The group's name, its index or slice per axis, x first, and the copy.

    Raises:
        SelectionSyntaxError: the text is no selection.

    >>> parse_selection("floor[0, 2:]")
    SelectionPart(group='floor', axes=(0, slice(2, None, None)), copy=None)
    """
    match = _EXPRESSION.fullmatch(normalised(text))
    if match is None or not is_name(match[1]):
        raise SelectionSyntaxError(
            f"`{readable(text)}` is no selection; write `ring`, `ring[3]`, `ring[0:10]`, `ring.0` (a copy) or `all`"
        )
    group, copy, inside = match.groups()
    if group == "all" and (inside, copy) != (None, None):
        raise SelectionSyntaxError("`all` takes no index; name a group to select part of it")
    axes = tuple(_parse_axis(axis, text) for axis in inside.split(",")) if inside is not None else ()
    return SelectionPart(group, axes, int(copy) if copy is not None else None)


def _parse_axis(axis: str, text: str) -> int | slice:
    """Read one index or slice; only steps above zero make sense for a set of atoms."""
    bounds = [_parse_bound(bound, text) for bound in axis.split(":")]
    if len(bounds) > 3:
        raise SelectionSyntaxError(f"`{readable(text)}`: a slice is start:stop or start:stop:step")
    if len(bounds) == 1:
        if bounds[0] is None:
            raise SelectionSyntaxError(f"`{readable(text)}`: an index is missing; `:` selects everything along an axis")
        return bounds[0]
    if len(bounds) == 3 and bounds[2] is not None and bounds[2] < 1:
        raise SelectionSyntaxError(f"`{readable(text)}`: the step of a slice is 1 or more")
    return slice(*bounds)


def _parse_bound(bound: str, text: str) -> int | None:
    if not bound.strip():
        return None
    match = _NUMBER.fullmatch(bound)
    if match is None:
        raise SelectionSyntaxError(f"`{readable(text)}`: `{readable(bound.strip())}` is not a whole number")
    return int(match.group(1))
