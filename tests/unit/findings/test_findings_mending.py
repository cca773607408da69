"""Remedies joined to one scene: what goes together, what wins, and what is never done without asking."""

from __future__ import annotations

from pathlib import Path

import pytest

from atomsim.errors import InputError, SceneError
from atomsim.findings.finding import Finding
from atomsim.findings.mending import Mending
from atomsim.scene.loader import load
from atomsim.tasks.mend import mend

SCENE = """\
atomsim: 1
time_step: 0.05
rounds: 800
groups:
  shelf: {shape: plane, counts: [8, 8], step_x: [1.5, 0, 0], step_y: [0, 1.5, 0]}
  vase: {shape: ball, radius: 2, spacing: 1.2, centre: [0, 0, 6]}
  sign: {shape: atoms, positions: [[0, 20, 0]]}
bonds: {vase: {within: vase, rule: all-pairs}}
forces:
  weight: {kind: gravity, acts_on: vase, impulse: [0, 0, -0.002]}
  wall: {kind: hold, acts_on: shelf}
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "shop.yaml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def found(code: str, remedy: str, *names: str) -> Finding:
    return Finding(code, "warning", "before", names, "shop.yaml", 3, (), "why", remedy)


def test_a_scene_is_mended_by_one_that_extends_it(scene: Path) -> None:
    target = scene.with_name("mended.yaml")
    mended = mend(scene, target)
    assert mended.path == target
    assert [each.code for each in mended.gone] == ["ghost-contact", "over-stiff"]
    assert [each.code for each in mended.left] == ["idle"]
    assert mended.new == ()
    lines = target.read_text(encoding="utf-8").splitlines()
    assert lines[:4] == [
        "# Written by atomsim check --fix; docs/findings.md explains the codes.",
        "atomsim: 1",
        "extends: shop.yaml",
        "collisions:",
    ]
    assert lines[4].startswith(f"  # ghost-contact ({scene}:6): shelf and vase come nearer than 1.5 in round ")
    assert lines[5] == "  shelf_vase: {between: [shelf, vase]}"
    assert lines[6].startswith(f"# over-stiff ({scene}:8): ")
    assert lines[7] == "time_step: 0.02"
    assert load(target).scene.time_step == 0.02
    assert scene.read_text(encoding="utf-8") == SCENE


def test_nothing_is_written_where_nothing_can_be_mended_without_asking(scene: Path) -> None:
    scene.write_text(SCENE.replace("rule: all-pairs", "rule: all-pairs}}\ncollisions: {land: {between: [shelf, vase]")
                     .replace("time_step: 0.05", "time_step: 0.02"), encoding="utf-8")  # fmt: skip
    mended = mend(scene, scene.with_name("mended.yaml"))
    assert (mended.path, [each.code for each in mended.left]) == (None, ["idle"])
    assert not scene.with_name("mended.yaml").exists()


def test_what_mending_brings_to_light_is_mended_too(scene: Path) -> None:
    """The threshold that reaches the next rows makes no stiff block yet."""
    text = """\
atomsim: 1
time_step: 0.01
rounds: 90
groups: {brick: {shape: block, counts: [3, 3, 3], spacing: 1.9, velocity: [1, 0, 0]},
         tile: {shape: block, counts: [3, 3, 3], spacing: 1, centre: [0, 9, 0], velocity: [1, 0, 0]}}
bonds: {all: {within: [brick, tile], rule: distance-threshold, threshold: 1.8}}
"""
    scene.write_text(text.replace("{all:", "{stiff:"), encoding="utf-8")
    target = scene.with_name("mended.yaml")
    mended = mend(scene, target)
    assert [each.code for each in mended.gone] == ["rule-misses-group"]
    comments = [line.split()[1] for line in target.read_text(encoding="utf-8").splitlines() if line.startswith("  # ")]
    assert comments[:2] == ["rule-misses-group", "floppy"]
    assert "floppy" not in [each.code for each in (*mended.left, *mended.new)]


def test_a_scene_is_mended_from_the_folder_above(scene: Path) -> None:
    target = scene.parent / "mended.yaml"
    inner = scene.parent / "inner" / "shop.yaml"
    inner.parent.mkdir()
    inner.write_text(SCENE, encoding="utf-8")
    mend(inner, target)
    assert "extends: inner/shop.yaml" in target.read_text(encoding="utf-8")
    with pytest.raises(InputError, match="a scene extends only what is in its own folder; write it beside"):
        mend(scene, inner.parent / "mended.yaml")


def test_no_file_of_others_is_written_over(scene: Path) -> None:
    with pytest.raises(InputError, match="this is the scene itself, which stays as it is"):
        mend(scene, scene, replace=True)
    other = scene.with_name("other.yaml")
    other.write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match=r"other\.yaml exists already"):
        mend(scene, other)
    assert other.read_text(encoding="utf-8") == "mine"
    mend(scene, other, replace=True)
    written = other.read_text(encoding="utf-8")
    mend(scene, other)
    assert other.read_text(encoding="utf-8") == written
    with pytest.raises(InputError, match="this is a folder"):
        mend(scene, scene.parent)
    with pytest.raises(InputError, match="does not exist"):
        mend(scene, scene.parent / "nowhere" / "m.yaml")


def test_a_scene_with_mistakes_is_not_mended(scene: Path) -> None:
    scene.write_text(SCENE.replace("shape: ball", "shape: bal"), encoding="utf-8")
    with pytest.raises(SceneError):
        mend(scene, scene.with_name("mended.yaml"))
    assert not scene.with_name("mended.yaml").exists()


def test_remedies_of_one_place_go_together() -> None:
    mending = Mending({"bonds": {"a"}, "collisions": set(), "forces": set(), "groups": set()})
    assert mending.add(
        [
            found("over-stiff", "time_step: 0.02"),
            found("tunnelling", "time_step: 0.005"),
            found("too-late", "rounds: 900"),
            found("in-pieces", "bonds:\n  a: {threshold: 2.5}", "bonds.a"),
            found("floppy", "bonds:\n  a: {threshold: 2.2, reach: 3}", "bonds.a"),
            found("idle", "groups:\n  b: null", "groups.b"),
        ]
    )
    assert mending.settings() == ["time_step=0.005", "rounds=900", "bonds.a.threshold=2.5", "bonds.a.reach=3"]
    assert not mending.add([found("floppy", "bonds:\n  a: {threshold: 2.2, reach: 3}", "bonds.a")])


def test_new_declarations_have_names_of_their_own() -> None:
    mending = Mending({"bonds": set(), "collisions": set(), "forces": {"ground"}, "groups": set()})
    mending.add(
        [
            found("floating-support", "forces:\n  stay: {kind: hold, acts_on: raft}", "groups.raft"),
            found("floating-support", "forces:\n  stay: {kind: hold, acts_on: quay}", "groups.quay"),
        ]
    )
    assert mending.settings() == [
        "forces.stay={kind: hold, acts_on: raft}",
        "forces.stay_2={kind: hold, acts_on: quay}",
    ]


def test_comments_are_single_lines_whatever_a_file_is_called() -> None:
    mending = Mending({"bonds": set(), "collisions": set(), "forces": set(), "groups": set()})
    mending.add([Finding("over-stiff", "warning", "before", (), "a\nb.yaml", 3, (), "why", "time_step: 0.02")])
    assert mending.text("a\nb.yaml").splitlines()[1:] == [
        'extends: "a\\nb.yaml"',
        "# over-stiff (a\\nb.yaml:3): why",
        "time_step: 0.02",
    ]
    assert mending.text("a b: c.yaml").splitlines()[1] == "extends: 'a b: c.yaml'"
