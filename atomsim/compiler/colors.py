"""Which colour every atom is drawn in, from a scene; knows no positions and no pictures."""

from __future__ import annotations

import numpy as np

from atomsim.compiler.selections import Selections, lay_out
from atomsim.core.model import Floats
from atomsim.scene.css_colors import CSS_COLORS
from atomsim.scene.language import Scene

PALETTE = ("#4682b4", "#b22222", "#2e8b57", "#daa520", "#8a5ba5", "#d2691e", "#5f9ea0", "#c0538c")
"""Colours of groups that do not choose one, in order of declaration."""


def atom_color(scene: Scene) -> Floats:
    """Return the colour of every atom: its group's, then what `render.colors` says, the later before the earlier.

    Args:
        scene: a scene that compiles.

    Returns:
        Red, green and blue from 0 to 1, (n_atoms, 3) float64.
    """
    layouts = lay_out(scene)
    n_atoms = sum(layout.stop - layout.start for layout in layouts.values())
    color = np.empty((n_atoms, 3))
    for number, (name, group) in enumerate(scene.groups.items()):
        color[layouts[name].start : layouts[name].stop] = _rgb(group.color or PALETTE[number % len(PALETTE)])
    selections = Selections(layouts, n_atoms)
    for selection, chosen in scene.render.colors.items():
        color[selections.atoms((selection,))] = _rgb(chosen)
    return color


def hex_color(color: str) -> str:
    """Return a colour as #rrggbb.

    >>> hex_color("SteelBlue"), hex_color("#f80")
    ('#4682b4', '#ff8800')
    """
    color = CSS_COLORS.get(color.lower(), color).lower()
    return color if len(color) == 7 else "#" + "".join(2 * digit for digit in color[1:])


def _rgb(color: str) -> tuple[float, float, float]:
    red, green, blue = (int(hex_color(color)[place : place + 2], 16) / 255 for place in (1, 3, 5))
    return red, green, blue
