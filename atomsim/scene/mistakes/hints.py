"""How to write what was probably meant by a value of the wrong type."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from atomsim.scene.declarations import selecting_keys
from atomsim.scene.field_docs import examples
from atomsim.scene.language import Declaration
from atomsim.scene.language.css_colors import CSS_COLORS
from atomsim.scene.mistakes.lookalikes import first_odd, plain
from atomsim.scene.mistakes.numbers import NO_COMMAS, numbers_meant
from atomsim.scene.mistakes.wording import either, listed, shown, suggestion
from atomsim.scene.source import KeyPath
from atomsim.scene.yaml.scalars import is_number

_BOOLEANS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false", "n": "false"}


def hint(kind: str, path: KeyPath, value: Any, choices: Sequence[str] = ()) -> str:
    """Return what completes a message about a value, `; write 1000`, or nothing.

    Args:
        kind: pydantic's name of what is wrong.
        path: where the value stands.
        value: what was written.
        choices: the words of which one may stand there.
    """
    if kind == "string_type" and len(path) == 1 and not isinstance(value, (dict, list)):
        return f'; write "{shown(value)}"'
    if kind == "version" and str(value) in ("1", "1.0"):
        return "; remove the quotes" if value == "1" else "; write 1"
    if kind in ("float_type", "int_type") and isinstance(value, str):
        return _hint_of_number(value, path, is_whole=kind == "int_type")
    if kind == "bool_type" and isinstance(value, str):
        word = plain(value).lower()
        word = _BOOLEANS.get(word, word)
        return f"; write {word}" if word in ("true", "false") else ""
    if choices and isinstance(value, str):
        return _hint_of_word(value, choices, has_direction=kind == "axis")
    if kind == "color" and isinstance(value, str):
        close = suggestion(value, CSS_COLORS)
        return f"; did you mean {close}?" if close is not None else ""
    return ""


def begin_with(declaration: type[Declaration], key: str, data: dict[str, Any]) -> str:
    """Return what completes a message about a key that is missing, `; begin with `radius: 4``, or nothing.

    Args:
        declaration: where it is missing.
        key: the key.
        data: the plain data of the scene.
    """
    groups = data.get("groups")
    for value in examples(declaration, key):
        return f"; begin with `{key}: {value if isinstance(value, str) else shown(value)}`"
    if key in selecting_keys(declaration) and isinstance(groups, dict) and groups:
        return f"; the groups are {listed(list(groups))}"
    return ""


def hint_of_list(value: Any) -> str:
    """Return what completes a message about a list that does not have the entries it needs."""
    if isinstance(value, str):
        return hint_of_text(value)
    texts = value[1:] if isinstance(value, list) else ()
    return f"; {NO_COMMAS}" if any(map(_ends_number, texts)) else ""


def hint_of_text(value: Any) -> str:
    """Return what completes a message about a text where a list or a mapping is needed."""
    if not isinstance(value, str):
        return ""
    if re.match(r"\s*[\[{]", value):
        return "; remove the quotes"
    parts = re.split(r"[,\s]+", value.strip("() "))
    if len(parts) > 1 and all(map(is_number, parts)):
        return f"; write [{', '.join(parts)}]"
    if value.startswith("-"):
        return "; an item of a list begins with `- `, a dash and a space"
    odd = first_odd(value)
    return f"; {odd} is not what it looks like" if odd is not None else ""


def _ends_number(value: Any) -> bool:
    """Tell whether a text can only be the end of a number with a comma: the `000` of 1,000."""
    return isinstance(value, str) and re.fullmatch("0[0-9][0-9]", value) is not None


def _hint_of_word(text: str, choices: Sequence[str], *, has_direction: bool) -> str:
    word = plain(text).lower()
    if has_direction and word in ("-x", "-y", "-z"):
        return f"; write {shown([-1 if letter == word[1] else 0 for letter in 'xyz'])}"
    close = word if word in choices else suggestion(word, choices)
    return f"; write {close}" if close is not None else ""


def _hint_of_number(text: str, path: KeyPath, *, is_whole: bool) -> str:
    if is_number(text):
        return "; remove the quotes"
    if isinstance(path[-1], int) and path[-1] > 0 and _ends_number(text):
        return f"; {NO_COMMAS}"
    before_comment = text.partition("#")[0]
    if before_comment != text and is_number(before_comment):
        return "; a comment needs a space before its `#`"
    if re.fullmatch(r"[^,]+,\s*[\w.-]+=.*", text):
        return "; each setting stands alone"
    if re.match(r"\$\{?\w", text):
        return "; a scene has no variables"
    meant = numbers_meant(text, is_whole=is_whole)
    return f"; write {either(meant)}" if meant else ""
