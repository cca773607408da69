"""The syntax errors of a YAML parser in plain words and where they are best looked at, with the usual remedy."""

from __future__ import annotations

import re
from typing import NamedTuple

import yaml

from atomsim.scene.mistakes.wording import shown
from atomsim.scene.yaml.causes import LINE_BREAK, MISSING_SPACE, likely_cause

LONGEST_KEY = 1024
"""What YAML allows a key in one line."""

HALF = "an escape such as `\\ud83e` is only half of a character; write the character itself"
"""What is wrong with one of the two halves in which JSON may escape a character."""

_STRUCTURE = (
    (
        r"mapping values are not allowed",
        "a `: ` cannot stand here; check indentation and the spaces after colons, and put text with a colon in quotes",
    ),
    (r"',' or '\]'", "the list `[` of {context} is not closed, or a comma is missing"),
    (r"',' or '}'", "the mapping `{{` of {context} is not closed, or a comma is missing"),
    (r"entries are not allowed", "a list item `- ` begins on a line of its own"),
    (r"node content", "a value or a closing bracket is missing"),
    (r"'-' indicator", "the list of {context} goes on only with `- ` in the column of the first"),
    (r"<document start>", "nothing can follow the end of the document"),
    (r"expected key|<block end>", "this does not fit the lines above it; check indentation and quotes"),
)
"""A pattern of the parser's words (those of libyaml and of PyYAML) and ours; `{context}` is where it began."""

_VALUES = (
    (r"unknown escape|escape code|hexdecimal", "`\\` in double quotes begins an escape; use single quotes"),
    (r"alphabetic or numeric", "a value that begins with `*` or `&` needs quotes"),
    (r"unexpected ':'", "a space is missing after this colon"),
    (
        r"comment or (?:a )?line break|indentation indicator|chomping",
        "a value that begins with `|` or `>` needs quotes",
    ),
    (r"mapping keys are not allowed", "a value that begins with `? ` needs quotes"),
    (r"directive|version number|incompatible YAML", "`%` begins a directive; leave it out, or put the value in quotes"),
    (r"tag|URI", "tags are not allowed; leave out what begins with `!`"),
)
"""The same for single values, which nothing around them explains."""

_WHERE_IT_BEGAN = (
    (r"could not find expected ':'", "there is no `: `, a colon and a space, after this key"),
    (r"unexpected end of stream|unexpected document separator", "this quote is not closed"),
)
"""The same for what a parser notices only later: what is to be mended is where it began."""


class SyntaxMistake(NamedTuple):
    """Where a text is to be mended, and what is wrong there."""

    mark: yaml.Mark | None
    message: str


def explain(error: yaml.MarkedYAMLError, text: str) -> SyntaxMistake:
    """Say what is wrong with a text that is no YAML.

    Args:
        error: what the parser raised.
        text: the whole text that it read.
    """
    problem = str(error.problem or error.context)
    mark, context = error.problem_mark or error.context_mark, error.context_mark
    by_character = _by_character(problem, text, mark) if mark is not None else None
    if by_character is not None:
        return SyntaxMistake(mark, by_character)
    cause = likely_cause(text, mark, context)
    for pattern, explanation in _WHERE_IT_BEGAN:
        if re.search(pattern, problem):
            return SyntaxMistake(context or mark, explanation + ("" if cause.startswith(MISSING_SPACE) else cause))
    for pattern, explanation in _STRUCTURE:
        if re.search(pattern, problem):
            where = f"line {context.line + 1}" if context is not None else "the line before"
            return SyntaxMistake(mark, explanation.format(context=where) + cause)
    of_value = (explanation for pattern, explanation in _VALUES if re.search(pattern, problem))
    return SyntaxMistake(mark, next(of_value, f"this is not YAML: {problem}"))


def _by_character(problem: str, text: str, mark: yaml.Mark) -> str | None:
    """Say what is wrong with the very character at the mark, if that is it."""
    character = [*LINE_BREAK.split(text), ""][mark.line][mark.column : mark.column + 1]
    if re.match(r"\\u[dD][89a-fA-F]", text[max(0, mark.index - 2) :]):
        return HALF
    if character == ":" and _ends_long_key(text[: mark.index]):
        return f"the name or key that ends here is too long: more than {LONGEST_KEY:,} characters"
    if "violates indentation" in problem or character == "\t":
        return "a tab is not allowed here; indent with spaces"
    if "cannot start any token" in problem:
        return f"a value cannot begin with {shown(character)}; put it in quotes"
    if "alphabetic or numeric" in problem and character.isalpha():
        return "the name behind `&` or `*` may have only ASCII letters, digits, _ and -"
    if character == "[":
        return 'a `[` cannot stand here; text with brackets needs quotes inside brackets: "ring[0:10]"'
    if character and character in "]}" and "']'" not in problem:
        return f"this `{character}` closes nothing that is open here"
    return None


def _ends_long_key(before: str) -> bool:
    """Tell whether a text ends in a key that is too long for a parser to see that it is one."""
    return len(before) >= LONGEST_KEY and not re.search("[\r\n{,]", before[-LONGEST_KEY:])
