"""Texts that were meant as numbers: with commas, blanks or zeros, or in the signs and digits of another script."""

from __future__ import annotations

import re
import unicodedata

from atomsim.scene.mistakes.lookalikes import plain
from atomsim.scene.yaml.scalars import is_number, resolve

NEEDS_BRACKETS = "a list needs brackets, such as [3, 0, 0]"
"""What helps when `{step: 3, 0, 0}` was taken for keys without values."""

NO_COMMAS = "a number has no commas inside"
"""What helps when `{count: 1,000}` was."""

_GROUPED = re.compile(r"[-+]?[0-9]{1,3}([,_' ])(?:[0-9]{2,3}\1)*[0-9]{3}(?:\.[0-9]+)?")
_GROUPED_BY_POINTS = re.compile(r"[-+]?[0-9]{1,3}(?:\.[0-9]{3})+(?:,[0-9]+)?")
_DECIMAL_COMMA = re.compile(r"[-+]?[0-9]+,[0-9]+(?:[eE][-+]?[0-9]+)?")
_FRACTION = re.compile(r"([-+]?[0-9]{1,15}) ?/ ?([1-9][0-9]{0,14})")
_ZEROS_IN_FRONT = re.compile(r"^([-+]?)0+(?=[0-9])")


def numbers_meant(text: str, *, is_whole: bool) -> list[str]:
    """Return how the numbers that a text may stand for are written, most likely first.

    Args:
        text: what stands where a number belongs.
        is_whole: whether only a whole number will do.

    >>> numbers_meant("1,000", is_whole=True), numbers_meant("1,000", is_whole=False)
    (['1000'], ['1000', '1.000'])
    >>> numbers_meant("1.234,5", is_whole=False), numbers_meant("\u22125", is_whole=True)
    (['1234.5'], ['-5'])
    >>> numbers_meant("100,", is_whole=True), numbers_meant("1/60", is_whole=False)
    (['100'], ['0.0166667'])
    """
    text = "".join(str(unicodedata.decimal(sign, sign)) for sign in plain(text)).rstrip(",; ")
    found = [text.replace("_", "")]
    if _GROUPED.fullmatch(text):
        found.append(re.sub(r"[,_' ]", "", text))
    if _GROUPED_BY_POINTS.fullmatch(text):
        found.append(text.replace(".", "").replace(",", "."))
    if _DECIMAL_COMMA.fullmatch(text):
        found.append(text.replace(",", "."))
    if fraction := _FRACTION.fullmatch(text):
        found.append(f"{int(fraction[1]) / int(fraction[2]):.6g}")
    without_zeros = (_ZEROS_IN_FRONT.sub(r"\1", number) for number in found)
    return [number for number in dict.fromkeys(without_zeros) if _is_meant(number, is_whole)]


def around(key: str, *, in_list: bool = False) -> str | None:
    """Return what helps with a key without a value that is only a part of a number or of a list, None if it is none.

    Args:
        key: what was taken for a key.
        in_list: whether a list is known to belong there.
    """
    if re.fullmatch("[0-9]{3}", key) and not in_list:
        return NO_COMMAS
    return NEEDS_BRACKETS if is_number(key) else None


def _is_meant(number: str, is_whole: bool) -> bool:
    value = resolve(number)
    if type(value) is float and is_whole:
        return value.is_integer() and "." not in number
    return type(value) in (int, float)
