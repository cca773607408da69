"""Characters that look like the plain ones of a scene, or like nothing at all, and what they stand for."""

from __future__ import annotations

import unicodedata

_DASHES = "\u2010\u2011\u2012\u2013\u2014\u2212"
_QUOTES = "\u2018\u2019\u201a\u201b\u201c\u201d\u201e\u201f\u00ab\u00bb\u2039\u203a"
_PLAIN = dict.fromkeys(map(ord, _DASHES), "-") | dict.fromkeys(map(ord, _QUOTES), "")


def plain(text: str) -> str:
    r"""Return a text as it was probably meant: dashes, spaces and wide letters plain, curly quotes and the unseen gone.

    >>> plain("\u00a0shape\ufeff"), plain("\u22125"), plain("\uff43ount")
    ('shape', '-5', 'count')
    """
    wide = unicodedata.normalize("NFKC", text.translate(_PLAIN))
    return "".join(sign for sign in wide if unicodedata.category(sign) != "Cf").strip()


def first_odd(text: str, plainly: str = "") -> str | None:
    """Return the first character that is not what it looks like, named as the Unicode standard does, or None.

    Args:
        text: what was written.
        plainly: what was meant, if that is known: then letters of another alphabet that are not in it are odd, too.

    >>> first_odd("count\\uff1a 3"), first_odd("\\u0441ount", "count"), first_odd("réng")
    ('U+FF1A FULLWIDTH COLON', 'U+0441 CYRILLIC SMALL LETTER ES', None)
    """
    for sign in text:
        name = unicodedata.name(sign, "")
        is_foreign = plainly and sign not in plainly and not name.startswith("LATIN")
        if not sign.isascii() and (is_foreign or _is_odd(sign)):
            return f"U+{ord(sign):04X} {name}".rstrip()
    return None


def _is_odd(sign: str) -> bool:
    """Tell whether a character stands for a sign of ASCII or a space, or cannot be seen."""
    return unicodedata.category(sign) in ("Zs", "Cf") or (plain(sign).isascii() and not plain(sign).isalnum())
