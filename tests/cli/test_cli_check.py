"""`atomsim check`: its options that write files, whole messages."""

from __future__ import annotations

from pathlib import Path

import pytest

HOOP = """\
atomsim: 1
time_step: 0.05
rounds: 100
groups:
  hoop: {shape: ring, count: 20, radius: 4, velocity: [1, 0, 0]}
bonds: {hoop: {within: hoop, rule: neighbour, reach: 2}}
"""


@pytest.fixture
def hoop(cli):
    Path("hoop.yaml").write_text(HOOP)


@pytest.mark.usefixtures("hoop")
def test_fix_says_what_is_gone_and_where_it_is_written(cli):
    result = cli("check", "hoop.yaml", "--fix", "mended.yaml")
    assert (result.code, result.err) == (0, "")
    assert result.out.endswith("mended.yaml: extends hoop.yaml\n  gone       floppy (hoop.yaml:6)\n")
    assert cli("check", "mended.yaml").out.count("warning") == 0
    assert cli("check", "mended.yaml", "--fix", "again.yaml").out.endswith(
        "nothing that can be mended without asking was found, so again.yaml is not written\n"
    )
    assert not Path("again.yaml").exists()


@pytest.mark.usefixtures("hoop")
@pytest.mark.parametrize(
    "arguments", [("hoop.yaml", "hoop.yaml"), ("-",), ("hoop.yaml", "--set", "rounds=9"), ("hoop.yaml", "--json")]
)
def test_fix_goes_with_one_file_as_it_is(cli, arguments):
    result = cli("check", *arguments, "--fix", "mended.yaml")
    assert (result.code, result.out) == (2, "")
    assert result.err == "--fix goes with one scene file as it is, without --set and --json\n"


@pytest.mark.usefixtures("hoop")
def test_fix_keeps_what_others_wrote(cli):
    Path("mine.yaml").write_text("mine")
    result = cli("check", "hoop.yaml", "--fix", "mine.yaml")
    assert (result.code, result.err) == (
        2,
        "mine.yaml exists already; give another name; add --force to replace it\n",
    )
    assert Path("mine.yaml").read_text() == "mine"
    assert cli("check", "hoop.yaml", "--fix", "mine.yaml", "--force").code == 0


@pytest.mark.usefixtures("hoop")
def test_fix_of_a_scene_with_mistakes_writes_nothing(cli):
    Path("hoop.yaml").write_text(HOOP.replace("ring", "rong"))
    assert cli("check", "hoop.yaml", "--fix", "mended.yaml").code == 2
    assert not Path("mended.yaml").exists()


@pytest.mark.usefixtures("hoop")
def test_modes_are_drawn_into_a_folder(cli):
    result = cli("check", "hoop.yaml", "--modes", "modes")
    assert result.out.endswith("modes/floppy-hoop.png\n")
    drawn = Path("modes/floppy-hoop.png").read_bytes()
    assert drawn.startswith(b"\x89PNG")
    assert cli("check", "hoop.yaml", "--modes", "modes").code == 0
    assert Path("modes/floppy-hoop.png").read_bytes() == drawn
    stiff = cli("check", "hoop.yaml", "--set", "bonds.hoop.reach=3", "--modes", "modes")
    assert stiff.out.endswith("nothing here is floppy or loosely joined, so modes gets no picture\n")


@pytest.mark.usefixtures("hoop")
def test_modes_keep_what_others_wrote(cli):
    Path("modes").mkdir()
    Path("modes/floppy-hoop.png").write_text("a photograph")
    result = cli("check", "hoop.yaml", "--modes", "modes")
    assert (result.code, result.err) == (
        2,
        "modes/floppy-hoop.png exists and atomsim did not draw it; add --force to replace it\n",
    )
    assert cli("check", "hoop.yaml", "--modes", "modes", "--force").code == 0
    assert cli("check", "hoop.yaml", "hoop.yaml", "--modes", "modes").err == "--modes goes with one scene\n"
    result = cli("check", "hoop.yaml", "--modes", "hoop.yaml")
    assert (result.code, result.err) == (2, "hoop.yaml: this is a file; give the name of a folder\n")
