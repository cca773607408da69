"""The names that people give: letters of any script, digits, `_` and `-`; two that look alike in Unicode are one."""

from __future__ import annotations

import unicodedata

LONGEST_NAME = 100
"""More letters than any file, table or picture would show."""

NAME_PATTERN = r"^[^\x00-@\[-^`{-\x7f][^\x00-,./:-@\[-^`{-\x7f]{0,99}$"
"""The same for a JSON Schema, but beyond ASCII it lets everything pass: patterns there do not know what a letter is."""


def normalised(name: str) -> str:
    r"""Return a name in its composed form (NFC): é is one letter, however the keyboard or the file system spelt it.

    >>> normalised("re\u0301ng") == "r\u00e9ng"
    True
    """
    return unicodedata.normalize("NFC", name)


def is_name(text: str) -> bool:
    """Tell whether a text is a name; letters and digits are those of identifiers in Python.

    >>> [is_name(text) for text in ("ring", "Füße", "环-2", "_1", "2nd", "my ring", "a.b", "")]
    [True, True, True, True, False, False, False, False]
    """
    return text[:1].isidentifier() and f"_{text.replace('-', '_')}".isidentifier()
