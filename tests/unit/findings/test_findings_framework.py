"""Findings as words and as data, their order, what follows from others, and what a scene silences."""

from __future__ import annotations

import pytest
from support.examined import examined, found, warnings
from support.running import PAPER_SCENES, SCENES

from atomsim.findings.before.diagnose import DIAGNOSES
from atomsim.findings.finding import Finding, finding, without_consequences
from atomsim.findings.finding import Symptom as Saw
from atomsim.findings.kinds import KINDS
from atomsim.scene.language.silence import CODES
from atomsim.scene.loader import load, loads
from atomsim.scene.source import Source

PROPS = """\
atomsim: 1
time_step: 0.05
rounds: 100
groups:
  ball: {shape: atoms, positions: [[0, 0, 0]], velocity: [1, 0, 0]}
  post: {shape: atoms, positions: [[0, 9, 0]]}
  sign: {shape: atoms, positions: [[0, 0, 9]]}
"""

IDLE_POST = Finding(
    code="idle",
    level="warning",
    when="before",
    names=("groups.post",),
    file="scene.yaml",
    line=6,
    rounds=(),
    message="no bond, no collision and no force names post, and it does not move",
    remedy="groups:\n  post: null",
)


def test_kinds_are_the_codes_that_a_scene_can_silence() -> None:
    assert set(KINDS) == {*CODES, "needless-silence"}
    assert set(DIAGNOSES) <= set(CODES)
    assert all(cause in KINDS for kind in KINDS.values() for cause in kind.follows_from)


@pytest.mark.parametrize("name", PAPER_SCENES)
def test_the_scenes_of_the_paper_are_well(name: str) -> None:
    assert warnings(load(SCENES / f"{name}.yaml")) == []


def test_a_finding_is_data() -> None:
    assert found(PROPS)[0] == IDLE_POST
    assert IDLE_POST.as_data() == {
        "code": "idle",
        "level": "warning",
        "when": "before",
        "names": ("groups.post",),
        "file": "scene.yaml",
        "line": 6,
        "rounds": (),
        "message": "no bond, no collision and no force names post, and it does not move",
        "remedy": "groups:\n  post: null",
    }
    assert str(IDLE_POST) == f"scene.yaml:6: warning: {IDLE_POST.message} [idle]"


def test_findings_come_in_the_order_of_the_file() -> None:
    text = PROPS.replace("velocity: [1, 0, 0]", "velocity: [100, 0, 0]") + "collisions: {c: {between: [ball, post]}}\n"
    assert [(each.code, each.line) for each in found(text)] == [("tunnelling", 5), ("idle", 7)]


def test_a_remedy_laid_over_the_scene_takes_the_finding_away() -> None:
    loaded = loads(PROPS, "scene.yaml", ["groups.post=null", "groups.sign=null"])
    assert found(loaded) == []


def test_a_silence_with_a_name_silences_what_mentions_it() -> None:
    silent = PROPS + "silence: {idle: {names: groups.post, because: it marks the start}}\n"
    assert [each.names for each in found(silent)] == [("groups.sign",)]
    assert found(PROPS + "silence: {idle: {because: they are signs}}\n") == []
    two = "silence: {idle: [{names: [groups.post], because: a}, {names: [groups.sign], because: b}]}\n"
    assert found(PROPS + two) == []


def test_a_silence_names_all_that_a_finding_has_to_mention() -> None:
    both = PROPS + "silence: {idle: {names: [groups.post, groups.sign], because: they are signs}}\n"
    assert [(each.code, each.line) for each in found(both)] == [("idle", 6), ("idle", 7), ("needless-silence", 8)]


def test_a_silence_that_silences_nothing_is_noted() -> None:
    needless = PROPS + "silence:\n  idle: {because: they are signs}\n  weld: {names: groups.ball, because: glue}\n"
    (note,) = found(needless)
    assert str(note) == (
        "scene.yaml:10: note: there is no weld to silence that mentions groups.ball [needless-silence]"
    )
    assert note.names == ("silence.weld.0",)


def test_a_silence_of_what_only_a_run_shows_is_not_called_needless() -> None:
    assert len(found(PROPS + "silence: {self-pass: {because: it may}, tunnelling: {because: it may}}\n")) == 2


def at(code: str, *names: str) -> Finding:
    return finding(code, "before", Saw(at=(), names=tuple(("groups", name) for name in names), message=""), Source())


def test_what_follows_from_another_finding_of_the_same_part_is_not_told() -> None:
    pieces, floppy, other = at("in-pieces", "cloth"), at("floppy", "cloth"), at("floppy", "net")
    assert without_consequences([floppy, pieces, other]) == [pieces, other]


def test_examining_an_absurd_scene_is_quiet() -> None:
    """Infinite is a fair answer to absurd numbers, and warnings of NumPy are errors here."""
    absurd = """\
atomsim: 1
time_step: 1.0e+7
rounds: 9
groups: {a: {shape: atoms, positions: [[0, 0, 0], [1.0e-6, 0, 0]], velocity: [0.05, 0, 0]}}
bonds: {b: {within: a, rule: all-pairs, rest: 1.0e+7}}
collisions: {c: {within: a}}
"""
    assert {each.code for each in examined(absurd).findings} >= {"over-stiff", "prestressed"}
