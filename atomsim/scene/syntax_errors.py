"""The syntax errors of a YAML parser in plain words, with the usual remedy; knows no tree and no scene."""

from __future__ import annotations

import re

import yaml

_EXPLANATIONS = (
    (
        r"mapping values are not allowed",
        "a `: ` is not allowed here; check the indentation and the space after the colon on the line before, "
        "and put text with a colon in quotes",
    ),
    (r"could not find expected ':'", "the key before this has no `: `; put a colon and a space after it"),
    (r"',' or '\]'", "the list `[` of {context} is not closed, or a comma is missing"),
    (r"',' or '}'", "the mapping `{{` of {context} is not closed, or a comma is missing"),
    (r"unexpected end of stream|unexpected document separator", "the quote of {context} is not closed"),
    (r"entries are not allowed", "a list item `- ` begins on a line of its own"),
    (r"node content", "a value is missing, or a bracket closes that was never opened"),
    (r"'-' indicator", "the list of {context} goes on only with `- `"),
    (r"<document start>", "nothing can follow the end of the document; is there a bracket too many?"),
    (r"unknown escape|escape code|hexdecimal", "`\\` in double quotes begins an escape; use single quotes"),
    (r"alphabetic or numeric", "a `*` or `&` at the beginning of a value needs quotes"),
    (r"expected key|<block end>", "the line does not fit the lines above it; check indentation, quotes and brackets"),
)
"""A pattern of the parser's words (those of libyaml and of PyYAML) and ours; `{context}` is where it began."""


def explain(error: yaml.MarkedYAMLError, text: str) -> str:
    """Return what is wrong at the place of a syntax error.

    Args:
        error: what the parser raised.
        text: the whole text that it read.
    """
    problem = str(error.problem or error.context)
    character = _character_at(error.problem_mark, text)
    if "violates indentation" in problem or character == "\t":
        return "a tab is not allowed here; indent with spaces"
    if "cannot start any token" in problem:
        return f"a value cannot begin with `{character}`; put it in quotes"
    context = f"line {error.context_mark.line + 1}" if error.context_mark is not None else "the line before"
    for pattern, explanation in _EXPLANATIONS:
        if re.search(pattern, problem):
            return explanation.format(context=context)
    return f"this is not YAML: {problem}"


def _character_at(mark: yaml.Mark | None, text: str) -> str:
    """Return the character at a mark; lines end as they do in YAML."""
    if mark is None:
        return ""
    lines = re.split("\r\n|[\r\n\x85\u2028\u2029]", text)
    return lines[mark.line][mark.column : mark.column + 1] if mark.line < len(lines) else ""
