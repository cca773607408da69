"""The strict YAML reader: values, places, limits."""

from __future__ import annotations

import json
import math
import time

import pytest
import yaml

from atomsim.errors import Mark, SceneError
from atomsim.scene.source import KeyPath
from atomsim.scene.yaml import strict_yaml
from atomsim.scene.yaml.strict_yaml import MAX_CHARACTERS, MAX_DEPTH, MAX_VALUES, read_yaml
from atomsim.scene.yaml.tree import Node, Places


def read(text: str) -> Node:
    """Read a text called `t`."""
    return read_yaml(text, lambda line, column: Mark("t", line, column))


def refusal(text: str) -> str:
    """Return the message a text gets."""
    with pytest.raises(SceneError) as caught:
        read(text)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-1", -1),
        ("+7", 7),
        ("0", 0),
        ("1.5", 1.5),
        ("1.", 1.0),
        (".5", 0.5),
        ("-.5", -0.5),
        ("1e-3", 1e-3),
        ("1E5", 1e5),
        ("1.5e+3", 1500.0),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("true", True),
        ("false", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("yes", "yes"),
        ("no", "no"),
        ("on", "on"),
        ("off", "off"),
        ("True", "True"),
        ("NULL", "NULL"),
        ("010", "010"),
        ("00.5", "00.5"),
        ("0x1F", "0x1F"),
        ("0o17", "0o17"),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("2024-01-31", "2024-01-31"),
        ("1e", "1e"),
        (".", "."),
        ("-", None),
        ("=", "="),
        ("inf", "inf"),
        ("'1'", "1"),
        ('"true"', "true"),
        ("''", ""),
        ("١", "١"),  # a digit, but not one of ours
    ],
)
def test_plain_word(text: str, value: object) -> None:
    read_value = read(f"key: {text}").plain()["key"] if text != "-" else read("key:\n- ").plain()["key"][0]
    assert read_value == value
    assert type(read_value) is type(value)


def test_not_a_number_and_minus_zero() -> None:
    value, zero = read("[.nan, -0.0]").plain()
    assert math.isnan(value)
    assert math.copysign(1, zero) == -1


def test_a_number_of_too_many_digits_is_text() -> None:
    assert read("[" + "9" * 5000 + "]").plain() == ["9" * 5000]


TEXT = """\
# a comment
groups:
  ring: {count: 3, centre: [1, 2.5, 3]}
  "floor":
    - a
    - b: 1
ünï: x
"""
PLACES: dict[KeyPath, tuple[int, int]] = {
    (): (1, 1),
    ("groups",): (2, 1),
    ("groups", "ring"): (3, 3),
    ("groups", "ring", "count"): (3, 10),
    ("groups", "ring", "centre"): (3, 20),
    ("groups", "ring", "centre", 0): (3, 29),
    ("groups", "ring", "centre", 1): (3, 32),
    ("groups", "ring", "centre", 2): (3, 37),
    ("groups", "floor"): (4, 3),
    ("groups", "floor", 0): (5, 7),
    ("groups", "floor", 1): (6, 7),
    ("groups", "floor", 1, "b"): (6, 7),
    ("ünï",): (7, 1),
}


@pytest.mark.parametrize("parser", [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)])
def test_every_value_has_its_place(parser: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strict_yaml, "_PARSER", parser)
    places = Places(read(TEXT))
    assert {path: (mark.line, mark.column) for path, mark in places.items()} == PLACES
    assert len(places) == len(PLACES)
    assert ("groups", "ring", "radius") not in places
    assert ("groups", "ring", "centre", 3) not in places


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: [1, 2\n", "t:2:1: the list `[` of line 1 is not closed, or a comma is missing"),
        ("a: {b: 1\nc: 2\n", "t:2:2: the mapping `{` of line 1 is not closed, or a comma is missing"),
        (
            "a: b: c",
            "t:1:5: a `: ` cannot stand here; check indentation and the spaces after colons, "
            "and put text with a colon in quotes",
        ),
        ("a: 'x\nb: 2", "t:1:4: this quote is not closed"),
        ("a: @x", 't:1:4: a value cannot begin with "@"; put it in quotes'),
        ("a: - 1", "t:1:4: a list item `- ` begins on a line of its own"),
        ("a:\n  b: 1\n c: 2\n", "t:3:2: this does not fit the lines above it; check indentation and quotes"),
        ("a: *", "t:1:5: a value that begins with `*` or `&` needs quotes"),
        ("a: 1\n...\nb: 2\n", "t:3:1: nothing can follow the end of the document"),
        ("a:\n\tb: 1", "t:2:1: a tab is not allowed here; indent with spaces"),
    ],
)
@pytest.mark.parametrize("parser", [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)])
def test_syntax_errors_read_the_same_from_both_parsers(
    text: str, message: str, parser: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(strict_yaml, "_PARSER", parser)
    assert refusal(text) == message


def test_aliases_repeat_their_anchor_at_their_own_place() -> None:
    root = read("a: &x {b: 1}\nc: *x\nd: [*x]\n")
    assert root.plain() == {"a": {"b": 1}, "c": {"b": 1}, "d": [{"b": 1}]}
    assert Places(root)["c",] == Mark("t", 2, 1)
    assert Places(root)["d", 0] == Mark("t", 3, 5)
    assert Places(root)["c", "b"] == Mark("t", 1, 8)


def test_an_anchor_may_be_set_again() -> None:
    assert read("[&a 1, *a, &a 2, *a]").plain() == [1, 1, 2, 2]


@pytest.fixture(params=[yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)], ids=["python", "c"])
def any_parser(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Read with PyYAML's parser in Python, and with libyaml."""
    monkeypatch.setattr(strict_yaml, "_PARSER", request.param)


VALUES = {
    "title": 'a robot \U0001f916 / \\ " \t \n \u2028 \u2029 \x85 \ufeff \xa0 é',
    "two": ["\U0001f916\U0001f916", "\\ud83e\\udd16", 1e-300, -0.5, 12, True, None],
    "three": {"": {}, "\U0001f916": []},
}


@pytest.mark.parametrize("is_ascii", [True, False])
@pytest.mark.parametrize("indent", [None, 2, "\t"])
@pytest.mark.parametrize("separators", [(",", ":"), (", ", ": ")])
def test_json_means_what_it_says(
    is_ascii: bool, indent: int | str | None, separators: tuple[str, str], any_parser: None
) -> None:
    text = json.dumps(VALUES, ensure_ascii=is_ascii, indent=indent, separators=separators)
    assert read(text).plain() == VALUES
    assert read(text.replace("\n", "\r\n")).plain() == VALUES


def test_places_in_json_are_those_of_its_text(any_parser: None) -> None:
    text = '{"a": "\\ud83e\\udd16",\t"b": "\\\\ud83e", "c": "\u2028", "d": 1}'
    places = Places(read(text))
    assert [places[(key,)].column - 1 for key in "abcd"] == [text.index(f'"{key}"') for key in "abcd"]


@pytest.mark.parametrize("sign", ["\x85", "\u2028", "\u2029"])
@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a: 1 # x@y\nb: 2", {"a": 1, "b": 2}),
        ("# x@y: [\na: 1", {"a": 1}),
        ("a: x@y", {"a": "x@y"}),
        ("a: 'x@y'", {"a": "x@y"}),
        ('a: "x@y"', {"a": "x@y"}),
        ("a: |\n  x@y\n  z\n", {"a": "x@y\nz\n"}),
        ("x@y: 1", {"x@y": 1}),
        ("[a@, '@']", ["a@", "@"]),
    ],
)
def test_what_ended_a_line_long_ago_is_a_character(sign: str, text: str, value: object, any_parser: None) -> None:
    expected = json.loads(json.dumps(value).replace("@", json.dumps(sign)[1:-1]))
    assert read(text.replace("@", sign)).plain() == expected
    assert read("\ue000: 1\n\ue001: " + sign).plain() == {"\ue000": 1, "\ue001": sign}
    assert refusal(f"a: {sign}\nb: @x") == 't:2:4: a value cannot begin with "@"; put it in quotes'


def test_byte_order_marks_in_front_are_left_out(any_parser: None) -> None:
    assert read("\ufeffa: 1").plain() == {"a": 1}
    assert read("\ufeff\ufeff{a: 1}").plain() == {"a": 1}
    assert read("a: \ufeff").plain() == {"a": "\ufeff"}


@pytest.mark.parametrize(
    "text", ['a: "x\\ud83e\\udd16"', 'a: "\\ud83e"', '{"a": "\\ud83e"}', '{"a": "\\udd16\\ud83e"}']
)
def test_half_a_character_is_refused_in_words(text: str, any_parser: None) -> None:
    assert "is only half of a character; write the character itself" in refusal(text)


@pytest.mark.parametrize("begin", ["{b: 1, ", "- 1\n- ", "a: 1\n", "a:\n  b: 1\n  "])
@pytest.mark.parametrize("quote", ["", "'", '"'])
def test_a_key_that_is_too_long_is_called_so(begin: str, quote: str, any_parser: None) -> None:
    assert refusal(f"{begin}{quote}{'a' * 100_000}{quote}: 1\n").endswith(
        "the name or key that ends here is too long: more than 1,024 characters"
    )


def test_an_unprintable_character_is_refused_at_its_place() -> None:
    assert refusal("a: 1\r\nb: \x00\n") == "t:2:4: the character U+0000 cannot stand in YAML"
    assert refusal("a: \ud800") == "t:1:4: the character U+D800 cannot stand in YAML"


def bomb(*, width: int, height: int) -> str:
    """Return a text that stands for width ** height values."""
    levels = [f"- &a0 [{', '.join('x' * width)}]"]
    levels += [f"- &a{i} [{', '.join([f'*a{i - 1}'] * width)}]" for i in range(1, height)]
    return "\n".join(levels)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (bomb(width=10, height=9), f"stands for more than {MAX_VALUES:,} values"),
        (bomb(width=1, height=200), f"nested more than {MAX_DEPTH} deep"),
        ("[" * 100_000, f"nested more than {MAX_DEPTH} deep"),
        ("{a: " * 100_000, f"nested more than {MAX_DEPTH} deep"),
        ("- " * 100_000, f"nested more than {MAX_DEPTH} deep"),
        ("? " * 100_000, "a key must be a plain word"),
        ("x" * (MAX_CHARACTERS + 1), "longer than 16 MiB"),
        ("a: &a [*a]", "the alias `*a` stands inside what it repeats"),
        ("a: &a {b: &b [*a]}", "the alias `*a` stands inside what it repeats"),
    ],
    ids=["wide bomb", "deep bomb", "lists", "mappings", "items", "keys", "long", "circle", "wider circle"],
)
def test_what_would_fill_the_memory_ends_at_once(text: str, message: str) -> None:
    begin = time.process_time()
    assert message in refusal(text)
    assert time.process_time() - begin < 10  # it takes about one


class ShortSightedLoader(yaml.SafeLoader):
    """A parser with a limit of its own, which it meets while it looks ahead: before it has handed over anything."""

    def __init__(self, stream: str) -> None:
        super().__init__(stream)
        far = stream.find("[" * 41)
        if far >= 0:
            mark = yaml.Mark("", far + 40, 0, far + 40, None, 0)
            raise yaml.scanner.ScannerError("while looking ahead", mark, "enough is enough", mark)


@pytest.mark.parametrize("before", ["", "a: 1\na: 2\nb: *c\nd: "])
def test_our_limit_of_nesting_speaks_before_that_of_any_parser(before: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strict_yaml, "_PARSER", ShortSightedLoader)
    assert refusal(before + "[" * 100_000).endswith(f"values are nested more than {MAX_DEPTH} deep")


def test_what_is_no_limit_is_told_where_the_parser_stopped() -> None:
    assert refusal("a: 1\na: 2\nb: @x").split("\n") == [
        "t:2:1: a: duplicate key `a`, first on line 1",
        't:3:4: a value cannot begin with "@"; put it in quotes',
    ]


def test_all_surprises_are_told_at_once() -> None:
    assert refusal("a: !!int 1\na: 2\n<<: {b: 1}\nc: *d\n[e]: 1").split("\n") == [
        "t:1:4: a: tags are not allowed; leave out `!!int`",
        "t:2:1: a: duplicate key `a`, first on line 1",
        "t:3:1: merge keys `<<` are not part of the scene language; write the keys out",
        "t:4:4: c: there is no anchor `&d` before this alias",
        "t:5:1: a key must be a plain word",
    ]
