"""What is odd in the lines around a syntax error, and so its likely cause."""

from __future__ import annotations

import re

import yaml

from atomsim.scene.mistakes.lookalikes import first_odd

LINE_BREAK = re.compile("\r\n|[\r\n]")

MISSING_SPACE = "; a space is missing after the colon"

_NO_SPACE = re.compile(r"""(?:^|[\s{\[,])["']?[A-Za-z_][\w-]*["']?:(?=[^\s:/,}\]])""")
_NO_COLON = re.compile(r"\s*[A-Za-z_][\w-]*\s*[{\[]")
_OTHER_COMMENT = re.compile(r"(?:^|[\s{\[,])(?://|/\*)")
_BLOCK_TEXT = re.compile(r": *[|>][+-]? *$")


def likely_cause(text: str, mark: yaml.Mark | None, context: yaml.Mark | None) -> str:
    """Return what completes a message about a syntax error, `; …`, or nothing.

    Args:
        text: the whole text.
        mark: where the parser gave up.
        context: where what it was reading began.
    """
    lines = [*LINE_BREAK.split(text), ""]  # the end of the text may be marked on the line after the last
    if context is not None and " #" in lines[context.line]:
        return "; ` #` begins a comment"
    numbers = [place.line - above for place in (context, mark) if place is not None for above in (0, 1)]
    near = {number: lines[number] for number in numbers if 0 <= number < len(lines)}
    for number, line in near.items():
        odd = first_odd(line)
        if odd is not None:
            return f"; {odd} on line {number + 1} is not what it looks like"
        if _OTHER_COMMENT.search(line):
            return "; a comment begins with `#`"
    if mark is not None and re.match("""['"]\\w""", text[max(0, mark.index - 1) :]):
        return "; a quote ends just before this: in '…', '' is an apostrophe"
    for number, line in near.items():
        if _NO_SPACE.search(line):
            return f"{MISSING_SPACE} on line {number + 1}"
        if _NO_COLON.match(line):
            return f"; a colon is missing in front of the bracket on line {number + 1}"
    if any(_BLOCK_TEXT.search(line) for line in near.values()):
        return "; the text below `|` or `>` is indented"
    return ""
