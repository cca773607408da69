"""Strict YAML, text to tree: one document of plain values, each key once; knows nothing of scenes."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterator
from dataclasses import replace

import yaml

from atomsim.errors import Mark, Problem, SceneError
from atomsim.scene.mistakes.mistake import first_of
from atomsim.scene.mistakes.numbers import around
from atomsim.scene.mistakes.wording import readable
from atomsim.scene.source import KeyPath, dotted
from atomsim.scene.yaml.prepared import prepared
from atomsim.scene.yaml.scalars import resolve
from atomsim.scene.yaml.syntax_errors import HALF, explain
from atomsim.scene.yaml.tree import Node

MAX_CHARACTERS = 2**24
MAX_DEPTH = 32
MAX_VALUES = 1_000_000

_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_LINE_BREAK = re.compile("\r\n|\r|\n")
_COMMENT = re.compile("[ \t]+(#[^\r\n]{1,200})")
_PARSER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

Place = Callable[[int, int], Mark]
"""Makes a mark of a line and a column, both counted from 1."""


def read_yaml(text: str, place: Place, at: KeyPath = ()) -> Node:
    """Read a YAML document into a tree.

    Args:
        text: the document; at most 16 MiB, 32 levels deep, a million values with aliases written out.
        place: makes a mark of line and column.
        at: the path of the document in the scene.

    Returns:
        The tree; an empty text is null.

    Raises:
        SceneError: no YAML, or YAML that surprises: duplicate keys, tags, merge keys, keys that are no words,
            several documents.
    """
    if len(text) > MAX_CHARACTERS:
        raise SceneError([Problem(place(1, 1), "", "the text is longer than 16 MiB")])
    text = text.lstrip("\ufeff")
    unprintable = _UNPRINTABLE.search(text)
    if unprintable is not None:
        lines = _LINE_BREAK.split(text[: unprintable.start()])
        message = f"the character U+{ord(unprintable.group()):04X} cannot stand in YAML"
        raise SceneError([Problem(place(len(lines), len(lines[-1]) + 1), "", message)])
    text, back = prepared(text)
    reader = _Reader(text, place, back)
    try:
        return reader.document(at)
    except SceneError:
        if reader.refused_at is not None:
            _Reader(text[: reader.refused_at], place, back).check_limits(at)
        raise


class _TooMuchError(SceneError):
    """A text that crosses a limit."""


class _Reader:
    """Recursive descent over the events of a YAML parser; the depth is bounded before Python's is."""

    def __init__(self, text: str, place: Place, back: dict[int, str]) -> None:
        self._text = text
        self._back = back
        self._events = self._parse(text)
        self._place = place
        self._problems: list[Problem] = []
        self._anchors: dict[str, Node | None] = {}
        self._n_values = 0
        self.refused_at: int | None = None
        """The index of the character at which the parser gave up."""

    def document(self, at: KeyPath) -> Node:
        """Read the one document of the text."""
        next(self._events)
        start = next(self._events)
        if isinstance(start, yaml.StreamEndEvent):
            return Node(None, self._place(1, 1), blank="")
        root = self._node(next(self._events), at)
        next(self._events)
        after = next(self._events)
        if not isinstance(after, yaml.StreamEndEvent):
            self._refuse(after, (), "a second document begins here; a scene is one document")
        if self._problems:
            raise SceneError(self._told())
        return replace(root, mark=self._place(1, 1))

    def check_limits(self, at: KeyPath) -> None:
        """Refuse a text that crosses a limit, whatever else is wrong with it.

        A parser looks ahead: it may give up far beyond a limit of ours before it has handed over what crosses it. So
        the text in front of that place is read once more.
        """
        try:
            self.document(at)
        except _TooMuchError:
            raise
        except SceneError:
            pass

    def _parse(self, text: str) -> Iterator[yaml.Event]:
        try:
            yield from yaml.parse(text, Loader=_PARSER)
        except yaml.MarkedYAMLError as error:
            gave_up = error.problem_mark or error.context_mark
            self.refused_at = gave_up.index if gave_up is not None else None
            mark, message = explain(error, text.translate(self._back))
            place = self._place(mark.line + 1, mark.column + 1) if mark is not None else self._place(1, 1)
            self._problems.append(Problem(place, "", message))
            raise SceneError(self._told()) from None

    def _node(self, event: yaml.Event, path: KeyPath) -> Node:
        """Read the value that an event begins."""
        self._count(event, path, 1, len(path))
        mark = self._mark(event)
        if isinstance(event, yaml.AliasEvent):
            return self._aliased(event, path)
        assert isinstance(event, (yaml.ScalarEvent, yaml.CollectionStartEvent))  # nothing else begins a value
        if event.tag is not None:
            tag = readable(event.tag.replace("tag:yaml.org,2002:", "!!"))
            self._refuse(event, path, f"tags are not allowed; leave out `{tag}`")
        if event.anchor is not None:
            self._anchors[event.anchor] = None
        if isinstance(event, yaml.ScalarEvent):
            node = Node(self._scalar(event, path), mark, blank=self._blank(event))
        elif isinstance(event, yaml.SequenceStartEvent):
            node = Node(self._list(path), mark)
        else:
            node = Node(self._mapping(path), mark)
        if event.anchor is not None:
            self._anchors[event.anchor] = node
        return node

    def _scalar(self, event: yaml.ScalarEvent, path: KeyPath) -> str | int | float | bool | None:
        text = str(event.value).translate(self._back)
        if event.implicit[0]:
            return resolve(text)
        unprintable = _UNPRINTABLE.search(text)
        if unprintable is not None:
            code = ord(unprintable.group())
            is_half = 0xD800 <= code < 0xE000
            message = HALF if is_half else f"the character U+{code:04X} cannot stand in a text"
            self._refuse(event, path, message)
        return text

    def _blank(self, event: yaml.ScalarEvent) -> str | None:
        """Return the comment that stands where a value is missing, often an empty one; None where there is a value."""
        if event.value or not event.implicit[0] or event.start_mark is None:
            return None
        comment = _COMMENT.match(self._text, event.start_mark.index)
        return comment[1].translate(self._back) if comment is not None else ""

    def _list(self, path: KeyPath) -> list[Node]:
        items: list[Node] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            items.append(self._node(event, (*path, len(items))))
        return items

    def _mapping(self, path: KeyPath) -> dict[str, Node]:
        entries: dict[str, Node] = {}
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            key = self._key(event, path)
            node = self._node(next(self._events), (*path, key))
            if key in entries:
                first = entries[key].mark.line
                where = f", first on line {first}" if first else ""
                self._refuse(event, (*path, key), f"duplicate key `{readable(key)}`{where}{_remedy(key, node)}")
            else:
                entries[key] = replace(node, mark=self._mark(event))
        return entries

    def _key(self, event: yaml.Event, path: KeyPath) -> str:
        """Read a key; whatever it looks like, it is text, in its composed form (NFC): é is one letter."""
        if not isinstance(event, yaml.ScalarEvent):
            start = event.start_mark.index if event.start_mark is not None else 0
            is_template = self._text[max(0, start - 1) : start + 1] == "{{"
            why = "`{{` belongs to a template; write the value itself" if is_template else "a key must be a plain word"
            raise self._refused(event, path, why)
        self._node(event, path)
        if event.value == "<<" and event.implicit[0]:
            self._refuse(event, path, "merge keys `<<` are not part of the scene language; write the keys out")
        return unicodedata.normalize("NFC", str(event.value).translate(self._back))

    def _aliased(self, event: yaml.AliasEvent, path: KeyPath) -> Node:
        """Return what an alias repeats, marked at the alias."""
        name = str(event.anchor)
        if name not in self._anchors:
            self._refuse(event, path, f"there is no anchor `&{readable(name)}` before this alias")
            return Node(None, self._mark(event))
        node = self._anchors[name]
        if node is None:
            raise self._refused(event, path, f"the alias `*{readable(name)}` stands inside what it repeats")
        n_values, depth = _extent(node)
        self._count(event, path, n_values - 1, len(path) + depth)
        return Node(node.value, self._mark(event))

    def _count(self, event: yaml.Event, path: KeyPath, n_values: int, depth: int) -> None:
        """Stop before a text, however short, becomes more than memory holds."""
        self._n_values += n_values
        if self._n_values > MAX_VALUES:
            raise self._too_much(event, f"the text stands for more than {MAX_VALUES:,} values")
        if depth > MAX_DEPTH:
            raise self._too_much(event, f"values are nested more than {MAX_DEPTH} deep")

    def _mark(self, event: yaml.Event) -> Mark:
        start = event.start_mark
        return self._place(start.line + 1, start.column + 1) if start is not None else self._place(1, 1)

    def _refuse(self, event: yaml.Event, path: KeyPath, message: str) -> None:
        self._problems.append(Problem(self._mark(event), dotted(path), message))

    def _refused(self, event: yaml.Event, path: KeyPath, message: str) -> SceneError:
        self._refuse(event, path, message)
        return SceneError(self._told())

    def _too_much(self, event: yaml.Event, message: str) -> SceneError:
        self._refuse(event, (), message)
        return _TooMuchError(self._told())

    def _told(self) -> list[Problem]:
        return first_of(self._problems, self._place(1, 1))


def _remedy(key: str, node: Node) -> str:
    """Say what was probably meant by a key that stands in a number or a list."""
    remedy = around(key) if node.value is None else None
    return f"; {remedy}" if remedy is not None else ""


def _extent(node: Node) -> tuple[int, int]:
    """Return how many values a node stands for, and how deep it goes."""
    if not isinstance(node.value, (dict, list)):
        return 1, 0
    inner = [_extent(child) for child in (node.value.values() if isinstance(node.value, dict) else node.value)]
    return 1 + sum(n_values for n_values, _ in inner), 1 + max((depth for _, depth in inner), default=0)
