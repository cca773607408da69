"""The version, written here and nowhere else, and the order of versions."""

import re

__version__ = "0.1.0"


def is_later(version: str) -> bool:
    """Tell whether another version is later than this one; a text that is no version is not.

    >>> is_later("99.0.0"), is_later("0.0.1"), is_later("?")
    (True, False, False)
    """
    return _release(version) > _release(__version__)


def _release(version: str) -> list[int]:
    found = re.match(r"[0-9]{1,9}(\.[0-9]{1,9})*", version)
    return [int(number) for number in found[0].split(".")] if found else []
