"""The syntax errors of a YAML parser in plain words, with the usual remedy; knows no tree and no scene."""

from __future__ import annotations

import re

import yaml

from atomsim.scene.mistakes.lookalikes import first_odd
from atomsim.scene.mistakes.wording import shown

_LINE_BREAK = re.compile("\r\n|[\r\n]")

LONGEST_KEY = 1024
"""What YAML allows a key in one line."""

HALF = "an escape such as `\\ud83e` is only half of a character; write the character itself"
"""What is wrong with one of the two halves in which JSON may escape a character."""

_EXPLANATIONS = (
    (
        r"mapping values are not allowed",
        "a `: ` cannot stand here; check indentation and the spaces after colons, and put text with a colon in quotes",
    ),
    (r"could not find expected ':'", "the key on {context} has no `: `, a colon and a space, after it"),
    (r"',' or '\]'", "the list `[` of {context} is not closed, or a comma is missing"),
    (r"',' or '}'", "the mapping `{{` of {context} is not closed, or a comma is missing"),
    (r"unexpected end of stream|unexpected document separator", "the quote of {context} is not closed"),
    (r"entries are not allowed", "a list item `- ` begins on a line of its own"),
    (r"node content", "a value or a closing bracket is missing"),
    (r"'-' indicator", "the list of {context} goes on only with `- `"),
    (r"<document start>", "nothing can follow the end of the document"),
    (r"unknown escape|escape code|hexdecimal", "`\\` in double quotes begins an escape; use single quotes"),
    (r"alphabetic or numeric", "a value that begins with `*` or `&` needs quotes"),
    (r"expected key|<block end>", "this does not fit the lines above it; check indentation and quotes"),
)
"""A pattern of the parser's words (those of libyaml and of PyYAML) and ours; `{context}` is where it began."""


def explain(error: yaml.MarkedYAMLError, text: str) -> str:
    """Return what is wrong at the place of a syntax error.

    Args:
        error: what the parser raised.
        text: the whole text that it read.
    """
    problem = str(error.problem or error.context)
    mark, context = error.problem_mark, error.context_mark
    character = _lines(text)[mark.line][mark.column : mark.column + 1] if mark is not None else ""
    if mark is not None and re.match(r"\\u[dD][89a-fA-F]", text[max(0, mark.index - 2) :]):
        return HALF
    if mark is not None and _ends_long_key(text, mark):
        return f"the name or key that ends here is too long: more than {LONGEST_KEY:,} characters"
    if "violates indentation" in problem or character == "\t":
        return "a tab is not allowed here; indent with spaces"
    if "cannot start any token" in problem:
        return f"a value cannot begin with {shown(character)}; put it in quotes"
    if character == "[":
        return 'a `[` cannot stand here; text with brackets needs quotes inside brackets: "ring[0:10]"'
    if character and character in "]}" and "']'" not in problem:
        return f"this `{character}` closes nothing that is open here"
    for pattern, explanation in _EXPLANATIONS:
        if re.search(pattern, problem):
            where = f"line {context.line + 1}" if context is not None else "the line before"
            return explanation.format(context=where) + _cause(text, mark, context)
    return f"this is not YAML: {problem}"


def _ends_long_key(text: str, mark: yaml.Mark) -> bool:
    """Tell whether a mark is at the colon of a key that is too long for a parser to see that it is one."""
    before = text[max(0, mark.index - LONGEST_KEY) : mark.index]
    return text[mark.index : mark.index + 1] == ":" and len(before) == LONGEST_KEY and not re.search("[\r\n{,]", before)


def _cause(text: str, mark: yaml.Mark | None, context: yaml.Mark | None) -> str:
    """Say what else is odd about the line of a mistake, that where it began, and the one above: the likely cause."""
    lines = _lines(text)
    if context is not None and " #" in lines[context.line]:
        return "; ` #` begins a comment"
    near = [context.line] if context is not None else []
    near += [mark.line, mark.line - 1] if mark is not None else []
    for number in near:
        line = lines[number] if 0 <= number < len(lines) else ""
        odd = first_odd(line)
        if odd is not None:
            return f"; {odd} on line {number + 1} is not what it looks like"
        if re.search(r"(?:^|[\s{\[,])(?://|/\*)", line):
            return "; a comment begins with `#`"
    return ""


def _lines(text: str) -> list[str]:
    """Return the lines as YAML counts them; the end of the text may be marked on the line after the last."""
    return [*_LINE_BREAK.split(text), ""]
