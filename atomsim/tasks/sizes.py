"""How large pictures are: in pixels, or in centimetres on paper."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, TypeAlias

from atomsim.arguments import whole, whole_pair
from atomsim.errors import InputError

AskedSize: TypeAlias = tuple[int, int] | str
"""Width and height [pixels], or a text such as on the command line, `640x480` or `8x6cm`."""

DPI, LEAST_DPI, MOST_DPI = 300, 20, 2400
"""Pixels per inch of what is measured in centimetres, where nobody says, and between which numbers one may say."""

_CENTIMETRES = 2.54
"""In an inch."""

_SIZE = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*x\s*([0-9]+(?:\.[0-9]+)?)\s*(cm)?\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Size:
    """A size as asked for; None is as usual.

    Attributes:
        pixels: width and height of a frame.
        dpi: pixels per inch of paper.
    """

    pixels: tuple[int, int] | None
    dpi: int | None

    @classmethod
    def of(cls, size: Any, dpi: Any) -> Size:
        """Check the arguments `size` and `dpi`.

        Raises:
            InputError: one of them will not do.
        """
        density = None if dpi is None else whole("dpi", dpi, least=LEAST_DPI, most=MOST_DPI)
        if not isinstance(size, str):
            needs = "width and height in pixels, such as (640, 480)"
            return cls(None if size is None else whole_pair("size", size, needs), density)
        match = _SIZE.fullmatch(size)
        if match is None or (match[3] is None and "." in size):
            raise InputError(f"size is written 640x480, in pixels, or 8x6cm; got {size}")
        if match[3] is None:
            return cls((int(match[1]), int(match[2])), density)
        density = density or DPI
        width, height = (round(float(side) / _CENTIMETRES * density) for side in (match[1], match[2]))
        return cls((width, height), density)
