"""A motion of a body in one picture: displaced one way, as it is, and displaced the other way."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from atomsim.core.model import Floats
from atomsim.disk import write_whole
from atomsim.drawing.camera import View
from atomsim.drawing.files import check_picture
from atomsim.drawing.framing import fit
from atomsim.drawing.layout import Layout
from atomsim.drawing.page import FORMATS, Panel, encode
from atomsim.drawing.picture import draw

SIZE = (480, 360)
"""Of each of the three pictures [pixels]."""

SWING = 0.35
"""The largest displacement, as a part of the extent of the body: far enough to be seen, and only a sketch."""

CAPTIONS = ("one way", "as it is", "the other way")


def draw_mode(position: Floats, mode: Floats, color: Floats, view: View, title: str, out: Path) -> None:
    """Write a picture of a motion.

    Args:
        position: atom centres of the body [length], (n_atoms, 3).
        mode: how far each atom moves, the largest 1, (n_atoms, 3).
        color: of every atom from 0 to 1, (n_atoms, 3).
        view: from where it is seen.
        title: what stands above it.
        out: the file; its extension tells the format.

    Raises:
        InputError: a name that will not do.
        RunError: the file cannot be written.
    """
    check_picture(out, tuple(FORMATS))
    offset = position - position.mean(axis=0)
    swing = max(1.0, SWING * float(np.sqrt((offset * offset).sum(axis=1).max())))
    places = [position + side * swing * mode for side in (-1.0, 0.0, 1.0)]
    camera = fit(view, places, SIZE)
    panels = [
        Panel(0, draw(place, color, camera, SIZE), caption, "") for place, caption in zip(places, CAPTIONS, strict=True)
    ]
    layout = Layout(SIZE, (len(panels),), (bool(title),), has_notices=False)
    write_whole(out, encode([title], [panels], layout, out.suffix.lower()))
