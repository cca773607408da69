"""Which colour every atom is drawn in."""

from __future__ import annotations

import pytest
from support.running import atoms_at, scene_of

from atomsim.compiler import compile_scene
from atomsim.compiler.colors import PALETTE, atom_color, group_colors
from atomsim.errors import SceneError
from atomsim.scene import LoadedScene
from atomsim.scene.language.css_colors import CSS_COLORS

GROUPS = {
    "left": atoms_at((0, 0, 0), (1, 0, 0), (2, 0, 0), color="#F00"),
    "right": atoms_at((9, 0, 0)),
}


def test_groups_have_their_color_or_one_of_the_palette():
    color = atom_color(scene_of(GROUPS))
    assert color[:3].tolist() == [[1.0, 0.0, 0.0]] * 3
    assert color[3].tolist() == [int(PALETTE[1][place : place + 2], 16) / 255 for place in (1, 3, 5)]


def test_colors_of_selections_cover_groups_and_each_other():
    color = atom_color(scene_of(GROUPS, render={"colors": {"all": "black", "left[0:2]": "White", "left[1]": "lime"}}))
    assert color.tolist() == [[1, 1, 1], [0, 1, 0], [0, 0, 0], [0, 0, 0]]


def test_a_camera_that_follows_atoms_that_do_not_exist_is_a_mistake():
    scene = scene_of(GROUPS, render={"camera": {"follow": ["right", "left[3]"]}})
    with pytest.raises(SceneError, match=r"render\.camera\.follow: `left\[3\]` is out of range"):
        compile_scene(LoadedScene(scene))


@pytest.mark.parametrize(
    ("colors", "expected"),
    [
        ({}, ["#ff0000", PALETTE[1]]),
        ({"left[0]": "white", "right[:]": "white"}, ["#ff0000", PALETTE[1]]),
        ({"all": "black"}, ["#000000", "#000000"]),
        ({"all": "black", " left": "White"}, ["#ffffff", "#000000"]),
        ({"left": "white", "all": "black"}, ["#000000", "#000000"]),
    ],
)
def test_a_group_is_written_down_in_the_color_of_its_atoms(colors, expected):
    assert list(group_colors(scene_of(GROUPS, render={"colors": colors})).values()) == expected


def test_colors_come_from_the_picture_then_the_group_then_the_palette():
    groups = {
        "a": atoms_at((0, 0, 0), color="SteelBlue"),
        "b": atoms_at((0, 0, 0), color="#F0a"),
        "c": atoms_at((0, 0, 0)),
    }
    scene = scene_of(groups, render={"colors": {"a": "red"}})
    assert group_colors(scene) == {"a": "#ff0000", "b": "#ff00aa", "c": PALETTE[2]}


def test_a_color_for_atoms_that_do_not_exist_is_a_mistake():
    scene = scene_of(GROUPS, render={"colors": {"left[3]": "red"}})
    with pytest.raises(SceneError, match=r"render\.colors\.left\[3\]: `left\[3\]` is out of range"):
        compile_scene(LoadedScene(scene))


def test_the_names_are_those_of_matplotlib():
    from matplotlib.colors import CSS4_COLORS

    assert {name: color.lower() for name, color in CSS4_COLORS.items()} == CSS_COLORS
