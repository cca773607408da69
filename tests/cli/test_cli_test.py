"""Scenes tried against what they expect: what is printed, drawn and written, and the exit codes."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

SCENE = """\
atomsim: 1
time_step: 0.05
rounds: 100
groups:
  ball: {shape: atoms, positions: [[0, 0, 0]], velocity: [0, 0, 1]}
  other: {shape: atoms, positions: [[9, 0, 0]]}
expect:
"""

RISES = "  rises: {measure: height of ball, above: 4.5, at: 100}\n"
FALLS = "  falls: {measure: height of ball, below: 0, eventually: [10, 90]}\n"
BLOWS_UP = "forces: {push: {kind: push, acts_on: other, impulse: [1e200, 0, 0], from_round: 50}}\n"


def write(name, text):
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text(text)


def times(text):
    """Leave out how long scenes took."""
    return [line.split(" (")[0] for line in text.splitlines()]


def test_what_is_met(cli):
    write("s.yaml", SCENE + RISES)
    said = cli("test", "s.yaml")
    assert (said.code, said.err) == (0, "")
    assert times(said.out) == ["s.yaml: 1 met, 0 not", "1 scene, 1 expectation: 1 met, 0 not"]
    assert not Path("failures").exists()


def test_what_is_not_met_is_told_with_margin_round_line_and_picture(cli):
    write("s.yaml", SCENE + RISES + FALLS)
    said = cli("test", "s.yaml", "--pictures", "pictures")
    assert said.code == 1
    assert times(said.out) == [
        "s.yaml: 1 met, 1 not",
        "  s.yaml:9: falls: fails by 0.5 length; height of ball is 0.5 in round 10, not below 0",
        "    pictures/s.falls.png",
        "1 scene, 2 expectations: 1 met, 1 not",
    ]
    assert Path("pictures/s.falls.png").read_bytes().startswith(b"\x89PNG")


def test_only_what_has_the_word_is_asked_about(cli):
    write("s.yaml", SCENE + RISES + FALLS)
    assert cli("test", "s.yaml", "-k", "s.ri").code == 0
    said = cli("test", "s.yaml", "-k", "nothing")
    assert (said.code, said.err) == (0, "nothing that was asked about is expected of these scenes\n")
    assert times(said.out)[0] == "s.yaml: nothing expected"


def test_folders_and_several_processes(cli):
    write("folder/a.yaml", SCENE + RISES)
    write("folder/b.yaml", SCENE + FALLS)
    write("folder/notes.txt", "no scene")
    said = cli("test", "folder", "-j", "2", "--backend", "numpy")
    assert said.code == 1
    assert [line for line in times(said.out) if ".yaml: " in line] == [
        "folder/a.yaml: 1 met, 0 not",
        "folder/b.yaml: 0 met, 1 not",
    ]


def test_a_run_that_blows_up_is_judged_as_far_as_it_went(cli):
    write("s.yaml", SCENE + RISES + "  early: {measure: height of ball, above: 1, eventually: true}\n" + BLOWS_UP)
    said = cli("test", "s.yaml")
    assert said.code == 1
    lines = times(said.out)
    assert lines[0] == "s.yaml: error"
    assert any("rises: not told before the run ended; last, height of ball is " in line for line in lines)
    assert lines[-1] == "1 scene, 2 expectations: 1 met, 1 not; 1 scene did not run to the end"


def test_a_scene_with_mistakes_fails_and_the_others_go_on(cli):
    write("bad.yaml", "atomsim: 1\n")
    write("s.yaml", SCENE + RISES)
    said = cli("test", "bad.yaml", "s.yaml", "no.yaml")
    assert said.code == 1
    assert times(said.out)[0] == "bad.yaml: error"
    assert "s.yaml: 1 met, 0 not" in times(said.out)
    assert "  no.yaml: there is no such file" in said.out


def test_junit(cli):
    write("s.yaml", SCENE + RISES + FALLS)
    write("bad.yaml", "atomsim: 1\n")
    assert cli("test", "s.yaml", "bad.yaml", "-o", "r.xml").code == 1
    first, second = ElementTree.parse("r.xml").getroot()
    assert (first.get("tests"), first.get("failures"), first.get("errors")) == ("2", "1", "0")
    (failure,) = first.iter("failure")
    assert failure.get("message").startswith("falls: fails by 0.5")
    assert [case.get("line") for case in first.iter("testcase")] == ["8", "9"]
    assert (second.get("tests"), second.get("errors")) == ("1", "1")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["empty"], "empty: there are no scenes in this folder\n"),
        (["s.yaml", "-o", "r.txt"], "r.txt: a report for JUnit is written as .xml\n"),
        (["s.yaml", "-o", "no/r.xml"], "no/r.xml: the folder no does not exist\n"),
        (["s.yaml", "-j", "0"], "-j needs a whole number of 1 or more (got 0)\n"),
    ],
)
def test_bad_usage(cli, arguments, message):
    write("s.yaml", SCENE + RISES)
    Path("empty").mkdir()
    said = cli("test", *arguments)
    assert (said.code, said.out, said.err) == (2, "", message)


@pytest.mark.parametrize(
    ("expectation", "message"),
    [
        ("{measure: height of bal, above: 1, at: 9}", "9: expect.e.measure: there is no group `bal`; did you mean"),
        ("{measure: hight of ball, above: 1, at: 9}", "there is no measure `hight`; did you mean `height`?"),
        ("{measure: height of ball, above: 1}", "say when: `at: ROUND`, `always: true` or `eventually: true`"),
        ("{measure: height of ball, at: 9}", "say exactly one of `above`, `below` or `between` (got none)"),
        ("{measure: height of ball, above: 1, below: 2, at: 9}", "say exactly one of `above`, `below` or `between`"),
        ("{above: 1, at: 9}", "say exactly one of `measure`, `all`, `any`, `not` or `that` (got none)"),
        ("{measure: velocity of ball, above: 1, at: 9}", "`velocity of ball` is a vector; say which component"),
        ("{measure: height of ball, above: 1, at: 9, always: true}", "say one of `at`, `always`, `eventually`"),
        ("{measure: height of ball, between: [2, 1], at: 9}", "needs [low, high] with low below high"),
        ("{measure: height of ball, above: 1, always: [9, 2]}", "needs [first round, last round]"),
        ("{any: [], at: 9}", "expect.e.any"),
        ("{all: [{measure: height of ball, abov: 1}], at: 9}", "unknown key `abov`; did you mean `above`?"),
    ],
)
def test_mistakes_in_expectations(cli, expectation, message):
    write("s.yaml", f"{SCENE}  e: {expectation}\n")
    said = cli("check", "s.yaml")
    assert said.code == 2
    assert said.err.startswith("s.yaml:8:")
    assert message.removeprefix("9: ") in said.err, said.err
