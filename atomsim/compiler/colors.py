"""Which colour every atom is drawn in, from a scene; knows no positions and no pictures."""

from __future__ import annotations

import numpy as np

from atomsim.compiler.selections import Selections, lay_out
from atomsim.core.model import Floats
from atomsim.scene.language import Scene
from atomsim.scene.language.css_colors import CSS_COLORS
from atomsim.scene.language.selection import parse_selection

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
    for name, own in _own_colors(scene).items():
        color[layouts[name].start : layouts[name].stop] = rgb(own)
    selections = Selections(layouts, n_atoms)
    for selection, chosen in scene.render.colors.items():
        color[selections.atoms((selection,))] = rgb(chosen)
    return color


def group_colors(scene: Scene) -> dict[str, str]:
    """Return the colour of every group as #rrggbb: that of its atoms, unless `render.colors` singles some of them out.

    Args:
        scene: a scene that compiles.
    """
    colors = _own_colors(scene)
    for selection, chosen in scene.render.colors.items():
        part = parse_selection(selection)
        if not part.axes:
            colors |= dict.fromkeys(colors if part.group == "all" else (part.group,), chosen)
    return {name: hex_color(color) for name, color in colors.items()}


def _own_colors(scene: Scene) -> dict[str, str]:
    """Return the colour that every group chooses, or else one of the palette."""
    return {
        name: group.color or PALETTE[number % len(PALETTE)] for number, (name, group) in enumerate(scene.groups.items())
    }


def hex_color(color: str) -> str:
    """Return a colour as #rrggbb.

    >>> hex_color("SteelBlue"), hex_color("#f80")
    ('#4682b4', '#ff8800')
    """
    color = CSS_COLORS.get(color.lower(), color).lower()
    return color if len(color) == 7 else "#" + "".join(2 * digit for digit in color[1:])


def rgb(color: str) -> tuple[float, float, float]:
    """Return red, green and blue of a colour from 0 to 1."""
    red, green, blue = (int(hex_color(color)[place : place + 2], 16) / 255 for place in (1, 3, 5))
    return red, green, blue
