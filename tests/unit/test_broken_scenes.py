"""Broken scenes and the whole message that each gets; the tables are beside this file, one scene a paragraph.

A paragraph is an edit of the good scene: `-` lines are replaced by the `+` lines that follow, `>` lines are appended,
`$` lines are settings; `+` lines alone are a whole scene. `=` lines are the message, without the name of the file.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pytest

from atomsim.errors import SceneError
from atomsim.scene.loader import loads

GOOD = """\
atomsim: 1
time_step: 0.01
rounds: 100
groups:
  ring: {shape: ring, count: 20, radius: 4}
  floor: {shape: plane, counts: [3, 4], step_x: [2, 0, 0], step_y: [0, 0, 2]}
bonds:
  hoop: {within: ring, rule: neighbour}
collisions:
  contact: {between: [ring, floor]}
forces:
  weight: {kind: gravity, impulse: [0, -0.01, 0]}
"""


@dataclass
class BrokenScene:
    """A paragraph of a table."""

    title: str
    edits: list[tuple[list[str], list[str]]] = field(default_factory=list)
    appended: list[str] = field(default_factory=list)
    settings: list[str] = field(default_factory=list)
    expected: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The scene."""
        if self.edits and not self.edits[0][0]:
            return "\n".join(self.edits[0][1]) + "\n"
        if not (self.edits or self.appended or self.settings):
            return ""
        text = GOOD
        for old, new in self.edits:
            assert text.count("\n".join(old)) == 1, f"{self.title}: {old} is not there once"
            text = text.replace("\n".join(old), "\n".join(new))
        return text + "".join(line + "\n" for line in self.appended)


def read_paragraph(paragraph: str) -> BrokenScene:
    """Read a paragraph of a table."""
    lines = paragraph.splitlines()
    scene = BrokenScene(lines[0].removeprefix("# "))
    for line in lines[1:]:
        sign, rest = line[0], line[2:]
        if sign == "-":
            if not scene.edits or scene.edits[-1][1]:
                scene.edits.append(([], []))
            scene.edits[-1][0].append(rest)
        elif sign == "+":
            if not scene.edits:
                scene.edits.append(([], []))
            scene.edits[-1][1].append(rest)
        else:
            {">": scene.appended, "$": scene.settings, "=": scene.expected}[sign].append(rest)
    return scene


TABLES = sorted(Path(__file__).parent.joinpath("broken_scenes").glob("*.txt"))
SCENES = [
    pytest.param(scene, id=f"{table.stem}: {scene.title}")
    for table in TABLES
    for scene in map(read_paragraph, table.read_text(encoding="utf-8").strip("\n").split("\n\n"))
]


def complaint(scene: BrokenScene) -> list[str]:
    """Return the lines of the message without the name of the file."""
    with pytest.raises(SceneError) as caught:
        loads(scene.text, "s.yaml", scene.settings)
    return [line.removeprefix("s.yaml:") for line in str(caught.value).split("\n")]


def test_the_good_scene_is_good() -> None:
    assert loads(GOOD).scene.rounds == 100


def test_the_table_is_long_and_without_repetition() -> None:
    texts = [(param.values[0].text, *param.values[0].settings) for param in SCENES]
    assert len(set(texts)) == len(texts) >= 150


@pytest.mark.parametrize("scene", SCENES)
def test_message(scene: BrokenScene) -> None:
    assert complaint(scene) == scene.expected
