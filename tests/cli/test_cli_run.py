"""`atomsim run`, `render`, `show`, `compare`, `verify`: whole messages and exit codes, as a user meets them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import h5py
import pytest


def text(message: str) -> str:
    """Hide what may differ between two machines: seconds and rounds per second."""
    return re.sub(r"in [\d.]+ s \([\d,.e+]+ rounds/s\)", "in # s (# rounds/s)", message)


def test_run_says_what_it_did_and_what_to_type_next(cli):
    result = cli("run", "scenes/rods.yaml", "--rounds", "20")
    assert result.code == 0
    assert result.err == ""
    lines = text(result.out).splitlines()
    assert re.fullmatch(r"out\.h5: 20 rounds in # s \(# rounds/s\), [\d.]+ kB", lines[0])
    assert lines[1] == "computed by numpy, 1 thread (the run is short)"
    assert re.fullmatch(r"digest of round 20: [0-9a-f]{64}", lines[2])
    assert lines[3:] == ["next: atomsim render out.h5"]


def test_quiet_prints_nothing(cli):
    result = cli("run", "scenes/rods.yaml", "--rounds", "20", "--quiet")
    assert (result.code, result.out, result.err) == (0, "", "")


def test_an_existing_file_stays_without_force(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "20").code == 0
    before = Path("out.h5").read_bytes()
    result = cli("run", "scenes/threads.yaml", "--rounds", "20")
    assert (result.code, result.out) == (2, "")
    assert result.err == "out.h5 exists; add --force to replace it; to go on: atomsim run --resume out.h5\n"
    assert Path("out.h5").read_bytes() == before
    assert cli("run", "scenes/threads.yaml", "--rounds", "20", "--force").code == 0
    assert Path("out.h5").read_bytes() != before


def test_settings_are_recorded_and_change_the_run(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "--set", "time_step=0.005").code == 0
    shown = cli("show", "out.h5").out
    assert "rods.yaml: --set time_step=0.005\n" in shown
    assert "τ = 0.005" in shown


def test_the_scene_inside_a_trajectory_gives_the_same_trajectory(cli):
    assert cli("run", "scenes/ring-soft.yaml", "--rounds", "60", "-o", "a.h5").code == 0
    Path("again.yaml").write_text(cli("show", "a.h5", "--scene").out)
    assert cli("run", "again.yaml", "-o", "b.h5").code == 0
    assert cli("compare", "a.h5", "b.h5").out == "identical: 7 frames up to round 60\n"
    assert cli("verify", "b.h5").out == "identical: 7 frames up to round 60 are what the scene gives\n"


def test_two_runs_write_the_same_bytes(cli):
    for name in ("a.h5", "b.h5"):
        assert cli("run", "scenes/ring.yaml", "--rounds", "30", "-o", name).code == 0
    assert Path("a.h5").read_bytes() == Path("b.h5").read_bytes()


def test_a_resumed_run_writes_the_bytes_of_an_uninterrupted_one(cli):
    assert cli("run", "scenes/ring.yaml", "--rounds", "75", "-o", "a.h5").code == 0
    assert cli("run", "scenes/ring.yaml", "--rounds", "33", "-o", "b.h5").code == 0
    result = cli("run", "--resume", "b.h5", "--rounds", "75")
    assert result.code == 0
    assert text(result.out).startswith("b.h5: 42 rounds in ")
    assert Path("a.h5").read_bytes() == Path("b.h5").read_bytes()


def test_compare_names_round_atom_and_size(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-o", "a.h5").code == 0
    assert (
        cli("run", "scenes/rods.yaml", "--rounds", "20", "-o", "b.h5", "--set", "groups.right.centre.1=0.5").code == 0
    )
    result = cli("compare", "a.h5", "b.h5")
    assert result.code == 1
    assert result.out == (
        "different: round 0: position of 70 of 140 atoms differs, "
        "first right[0] (atom 70), most right[0] (atom 70) by 0.5\n"
    )
    assert cli("compare", "a.h5", "b.h5", "--tolerance", "0.6").out == (
        "identical within 0.6: 3 frames up to round 20\n"
    )


def test_compare_of_different_atoms_and_rounds(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-o", "a.h5").code == 0
    assert cli("run", "scenes/rods.yaml", "--rounds", "30", "-o", "b.h5").code == 0
    assert cli("run", "scenes/ring.yaml", "--rounds", "10", "-o", "c.h5").code == 0
    assert cli("compare", "a.h5", "b.h5").out == "different: round 30 is only in the second\n"
    assert cli("compare", "a.h5", "c.h5").out == "different: a.h5 has 140 atoms, c.h5 309\n"


def test_a_blow_up_is_explained_and_keeps_the_frames_before(cli):
    result = cli("run", "scenes/rods.yaml", "--rounds", "400", "--set", "time_step=0.1")
    assert result.code == 3
    assert result.out == ""
    assert result.err == (
        "--set time_step=0.1: warning: time_step 0.1 is at or above 0.0286, the largest that the stiffness of this "
        "scene allows; expect it to blow up; what makes it stiff: bonds.left, bonds.right; try time_step 0.01 "
        "[over-stiff]\n"
        "the simulation blew up in round 15: left[69] (atom 69) is the fastest, and the energy is 1.61e+05, "
        "where the scene accounts for 70.1\n"
        "  pushed hardest by bonds.left (scenes/rods.yaml:23), against left[2] (atom 2), "
        "with an impulse of 0.911 in one round\n"
        "  time_step is 0.1; the stiffness of the scene allows less than 0.0286\n"
        "  remedy: a smaller time_step or fewer bonds per atom\n"
        "out.h5 keeps the frames up to round 10\n"
    )
    shown = cli("show", "out.h5")
    assert shown.code == 0
    assert "  frames     2, round 0 to 10 of 400\n  time step  τ = 0.1\n  ended      blew up: the sim" in shown.out
    assert cli("render", "out.h5", "--size", "64x48").code == 0


def test_a_setting_that_is_to_blame_has_no_line(cli):
    storm = "forces.storm={kind: gravity, impulse: [0, 0, 1e9]}"
    result = cli("run", "scenes/rods.yaml", "--set", storm)
    assert (result.code, result.out) == (3, "")
    assert f"  pushed hardest by forces.storm (--set {storm}), with an impulse of 1e+09" in result.err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("run",), "name a scene to run, as in: atomsim run scenes/rods.yaml"),
        (("run", "scenes"), "scenes: "),
        (("run", "scenes/rod.yaml"), "scenes/rod.yaml: there is no such file; did you mean `scenes/rods.yaml`?"),
        (("run", "scenes/rods.yaml", "-o", "no/out.h5"), "no/out.h5: there is no folder no"),
        (("run", "scenes/rods.yaml", "--resume", "a.h5"), "a.h5: no such file"),
        (("run", "--resume", "a.h5", "--compress"), "--resume goes on with the file that it names; -o and"),
        (("run", "--resume", "a.h5"), "a.h5: no such file"),
        (
            ("run", "--resume", "a.h5", "--set", "rounds=9"),
            "--resume goes on with the scene inside the trajectory, which --set cannot change",
        ),
        (("run", "--resume", "."), ".: this is a folder, not a trajectory"),
        (("show", "."), ".: this is a folder, not a trajectory"),
        (("render", ""), ".: this is a folder, not a trajectory"),
        (("verify", "/"), "/: this is a folder, not a trajectory"),
        (("compare", ".", "a.h5"), ".: this is a folder, not a trajectory"),
        (("recover", "."), ".: this is a folder, not a trajectory"),
        (("render", "a.h5"), "a.h5: no such file"),
        (("render", "scenes/rods.yaml"), "scenes/rods.yaml: is a scene, not a trajectory of atomsim"),
        (("render", "a.h5", "--rounds", "1,x"), "rounds are written 0,250,500 or 0-2000:100 (from, to, every) or -20"),
        (("render", "a.h5", "--rounds", "-0"), "rounds are written 0,250,500 or 0-2000:100 (from, to, every) or -20"),
        (
            ("render", "a.h5", "--camera", "30"),
            "--camera needs two numbers, as in 30,20; or front, side or top (got 30)",
        ),
        (("render", "a.h5", "--size", "640"), "size is written 640x480, in pixels, or 8x6cm; got 640"),
        (("show", "scenes/rods.yaml"), "scenes/rods.yaml: is a scene, not a trajectory of atomsim"),
        (("compare", "a.h5", "b.h5"), "a.h5: no such file"),
        (("verify", "a.h5"), "a.h5: no such file"),
        (("recover", "a.h5"), "a.h5: there is no journal a.h5.part to recover it from"),
        (("check", "a.yaml"), "a.yaml: there is no such file"),
    ],
)
def test_bad_usage_is_one_line_and_code_2(cli, arguments, message):
    result = cli(*arguments)
    assert result.code == 2
    assert result.out == ""
    assert result.err.startswith(message), result.err
    assert result.err.count("\n") == 1
    assert sorted(path.name for path in Path().iterdir()) == ["scenes"]


@pytest.mark.parametrize("command", ["run", "render", "check", "show", "compare", "verify", "recover", "schema"])
def test_help_of_each_command_shows_an_example(cli, command):
    result = cli(command, "--help")
    assert result.code == 0
    assert f"atomsim {command} " in result.out
    assert "Example" in result.out


FALL = """
atomsim: 1
time_step: 0.05
rounds: 40
record_every: 5
groups:
  floor: {shape: plane, counts: [3, 3], step_x: [1, 0, 0], step_y: [0, 1, 0]}
  brick: {shape: atoms, positions: [[0, 0, 30]]}
collisions: {touch: {between: [floor, brick]}}
forces:
  weight: {kind: gravity, acts_on: brick, impulse: [0, 0, -9.81]}
  ground: {kind: hold, acts_on: floor}
"""


def test_atoms_that_grew_too_fast_are_told_of_at_the_end(cli):
    Path("fall.yaml").write_text(FALL)
    result = cli("run", "fall.yaml")
    assert result.code == 0
    assert result.err.endswith(
        "\nwarning: from round 5 on atoms that may collide moved up to 19.6 per round, so some may have passed through "
        "others unseen (contact is at distance 2); use a smaller time_step or weaker impulses\n"
    )
    Path("slow.yaml").write_text(FALL.replace("-9.81", "-0.001"))
    assert "atoms that may collide moved" not in cli("run", "slow.yaml", "-o", "slow.h5").err


def test_render_replaces_only_pictures_of_its_own(cli):
    assert cli("run", "scenes/threads.yaml", "--rounds", "20").code == 0
    assert cli("render", "out.h5", "--size", "64x48").out == "out.png\n"
    first = Path("out.png").read_bytes()
    assert cli("render", "out.h5", "--size", "64x48").code == 0
    assert Path("out.png").read_bytes() == first
    Path("out.png").write_bytes(b"a photograph")
    result = cli("render", "out.h5", "--size", "64x48")
    assert (result.code, result.err) == (2, "out.png exists and atomsim did not draw it; add --force to replace it\n")
    assert cli("render", "out.h5", "--size", "64x48", "--force").code == 0
    assert Path("out.png").read_bytes() == first


def test_render_of_a_round_beyond_the_end(cli):
    assert cli("run", "scenes/threads.yaml", "--rounds", "20").code == 0
    result = cli("render", "out.h5", "--rounds", "0,5000")
    assert (result.code, result.err) == (2, "out.h5: there is no round 5000; it ends at round 20\n")


def test_render_writes_one_picture_per_frame(cli):
    assert cli("run", "scenes/threads.yaml", "--rounds", "20").code == 0
    result = cli("render", "out.h5", "--frames", "film", "--size", "64x48")
    assert result.out == "film: 3 pictures, round-00.png to round-20.png\n"
    assert len(list(Path("film").iterdir())) == 3


def test_check_describes_every_scene_and_reports_every_mistake(cli):
    result = cli("check", "scenes/rods.yaml")
    assert result.code == 0
    assert result.out == (
        "scenes/rods.yaml: Two rods collide, bounce apart and vibrate\n"
        "  atoms      140: left 70, right 70\n"
        "  bonds      4,830: left 2,415 (dense), right 2,415 (dense)\n"
        "  collisions 8,806 pairs: contact 4,900, own 3,906\n"
        "  forces     0\n"
        "  run        4,000 rounds of τ = 0.01: stable below 0.0286\n"
        "  record     401 frames, 2.8 MB\n"
        "  memory     about 60.6 MB\n"
    )
    broken = (
        Path("scenes/rods.yaml").read_text().replace("count: 70", "cuont: 70").replace("within: left", "within: lft")
    )
    Path("broken.yaml").write_text(broken)
    result = cli("check", "broken.yaml", "scenes/ring.yaml")
    assert result.code == 2
    assert result.err.count("broken.yaml:") >= 3
    assert "did you mean `count`?" in result.err
    assert "did you mean `left`?" in result.err
    assert result.out.startswith("scenes/ring.yaml: ")


def line_of_rounds(scene):
    """Return the line of a shipped scene that says which rounds are shown."""
    lines = Path(f"scenes/{scene}.yaml").read_text(encoding="utf-8").splitlines()
    return 1 + next(number for number, line in enumerate(lines) if line.startswith("  rounds:"))


def test_check_says_what_is_found_with_its_remedy(cli):
    result = cli("check", "scenes/rods.yaml", "--set", "rounds=250")
    assert result.code == 0
    assert result.out.endswith(
        "  memory     about 60.6 MB\n"
        f"scenes/rods.yaml:{line_of_rounds('rods')}: note: there is no round 300 to show; "
        "the run ends at 250 [no-such-round]\n"
        "  remedy:\n"
        "    render:\n"
        "      rounds: [0, 200]\n"
    )


def test_check_gives_findings_as_data_whatever_else_is_wrong(cli):
    Path("broken.yaml").write_text("atomsim: 1\n")
    result = cli("check", "--json", "scenes/ring.yaml", "broken.yaml", "scenes/rods.yaml", "--set", "rounds=250")
    assert result.code == 2
    assert result.err.startswith("broken.yaml:1:1: ")
    found = json.loads(result.out)
    assert [(each["code"], each["file"], each["line"], each["rounds"]) for each in found] == [
        ("no-such-round", "scenes/ring.yaml", line_of_rounds("ring"), [2000, 3000, 3400, 4000]),
        ("no-such-round", "scenes/rods.yaml", line_of_rounds("rods"), [300, 400, 600, 900, 1300, 2000]),
    ]
    assert list(found[0]) == ["code", "level", "when", "names", "file", "line", "rounds", "message", "remedy"]
    assert json.loads(cli("check", "--json", "broken.yaml").out) == []


def test_version(cli):
    assert re.fullmatch(r"atomsim \d+\.\d+\.\d+\n", cli("--version").out)


def test_a_complete_run_has_nothing_left_to_do(cli):
    """A queue that starts every job again with --resume must not fail."""
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-q").code == 0
    before = Path("out.h5").read_bytes()
    for options in ((), ("--rounds", "20"), ("--rounds", "10"), ("--force",)):
        result = cli("run", "--resume", "out.h5", *options)
        assert (result.code, result.err) == (0, "")
        assert result.out == "out.h5: complete, it has done 20 rounds already; ask for more with --rounds\n"
        quiet = cli("run", "--resume", "out.h5", "-q", *options)
        assert (quiet.code, quiet.out, quiet.err) == (0, "", "")
    result = cli("run", "scenes/balls.yaml", "--resume", "out.h5")
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith("out.h5 is a run of another scene than scenes/balls.yaml is now:")
    assert Path("out.h5").read_bytes() == before


def test_what_was_added_to_a_trajectory_is_not_lost_without_a_word(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-q").code == 0
    with h5py.File("out.h5", "r+") as file:
        file["analysis/tension"] = [1.0, 2.0, 3.0]
    before = Path("out.h5").read_bytes()
    result = cli("run", "--resume", "out.h5", "--rounds", "40")
    assert (result.code, result.out) == (2, "")
    assert result.err == (
        "out.h5: holds what another program put into it, and going on would lose it: /analysis; copy out.h5 if that is "
        "to be kept, then add --force to go on without it\n"
    )
    assert Path("out.h5").read_bytes() == before
    assert cli("run", "--resume", "out.h5", "--rounds", "40", "-q", "--force").code == 0
    assert cli("show", "out.h5").code == 0


def test_a_scene_without_a_time_step_is_told_one_that_it_allows(cli):
    Path("rod.yaml").write_text(
        "atomsim: 1\nrounds: 10\ngroups:\n  rod: {shape: string, count: 70, step: [0.25, 0, 0]}\n"
        "bonds:\n  rod: {within: rod, rule: all-pairs}\n"
    )
    for command in ("check", "run"):
        result = cli(command, "rod.yaml")
        assert (result.code, result.out) == (2, "")
        assert result.err == (
            "rod.yaml:1:1: time_step: missing: τ, by which velocities move positions in each round [time]; "
            "this scene is stable below 0.0286: begin with `time_step: 0.01`\n"
        )
    assert cli("run", "rod.yaml", "--set", "time_step=0.01").code == 0
