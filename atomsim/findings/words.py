"""Words of findings: numbers and names as sentences have them."""

from __future__ import annotations

import math
from collections.abc import Sequence


def counted(number: int, noun: str) -> str:
    """Write how many there are of something.

    >>> counted(1, "pair"), counted(1200, "pair")
    ('1 pair', '1,200 pairs')
    """
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def listed(names: list[str]) -> str:
    """Write names as a sentence does.

    >>> listed(["left"]), listed(["left", "right", "palm"])
    ('left', 'left, right and palm')
    """
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def verb(names: list[str], one: str, several: str) -> str:
    """Return the form of a verb that goes with some names.

    >>> verb(["left"], "moves", "move"), verb(["left", "right"], "moves", "move")
    ('moves', 'move')
    """
    return one if len(names) == 1 else several


def round_down(number: float) -> float:
    """Return the number of one digit that is not above a positive number: what a person would try.

    >>> round_down(0.0286), round_down(35.0)
    (0.02, 30.0)
    """
    power = 10.0 ** math.floor(math.log10(number))
    return float(f"{math.floor(number / power) * power:g}")


def round_up(number: float) -> float:
    """Return the number of two digits that is above a positive number.

    >>> round_up(1.6), round_up(2.83), round_up(10.0)
    (1.7, 2.9, 11.0)
    """
    power = 10.0 ** (math.floor(math.log10(number)) - 1)
    return float(f"{(math.floor(number / power * (1 + 1e-9)) + 1) * power:g}")


def direction_in_words(direction: Sequence[float]) -> str:
    """Write a direction: an axis where it is along one, else its parts.

    >>> direction_in_words([0, 0, -0.003]), direction_in_words([1.0, 0, 1.0])
    ('−z', '[0.71, 0, 0.71]')
    """
    length = math.sqrt(sum(part * part for part in direction))
    for axis, part in zip("xyz", direction, strict=True):
        if abs(part) > 0.999 * length:
            return f"{'+' if part > 0 else '−'}{axis}"
    return f"[{', '.join(f'{part / length:.2g}' for part in direction)}]"
