"""Every kind of finding has a section with a scene that shows it and nothing else, and whose remedy is a cure."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import ROOT, Block, blocks

from atomsim.compiler import compile_scene
from atomsim.findings.before.diagnose import DIAGNOSES, examine
from atomsim.findings.finding import Finding
from atomsim.findings.kinds import KINDS
from atomsim.scene.loader import load

PAGE = ROOT / "docs" / "findings.md"
SCENES = {
    name[1]: block for block in blocks(PAGE) if (name := re.match(r"# ([\w-]+)\.yaml", block.text)) and name[1] in KINDS
}


def examined(path: Path) -> list[Finding]:
    loaded = load(path)
    return list(examine(loaded, *compile_scene(loaded)).findings)


@pytest.mark.parametrize("code", sorted(DIAGNOSES))
def test_every_kind_has_a_section_with_its_scene(code: str) -> None:
    assert f"\n### {code}\n" in PAGE.read_text(encoding="utf-8")
    assert code in SCENES


@pytest.mark.parametrize(("code", "block"), sorted(SCENES.items()), ids=sorted(SCENES))
def test_the_scene_shows_this_and_nothing_else_and_its_remedy_is_a_cure(
    code: str, block: Block, tmp_path: Path
) -> None:
    path = tmp_path / f"{code}.yaml"
    path.write_text(block.text, encoding="utf-8")
    (found,) = examined(path)
    assert found.code == code
    if found.remedy:
        mended = tmp_path / "mended.yaml"
        mended.write_text(f"atomsim: 1\nextends: {path.name}\n{found.remedy}\n", encoding="utf-8")
        assert code not in [each.code for each in examined(mended)]
    else:
        assert code == "loose-joint"
