"""Goldens catch what they are there for: a law changed by one part in 10⁹, a missing file, a silent re-recording."""

from __future__ import annotations

import errno
import json
import os
import re
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import atomsim
from atomsim.cli import main
from atomsim.core.numpy_backend import bond_forms, stepper
from atomsim.core.pairs import collisions
from atomsim.tasks.golden import Golden, check_golden, read_golden, record_golden

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "tests" / "golden"
SCENES = sorted((ROOT / "scenes").glob("*.yaml"))


@pytest.fixture
def cli(monkeypatch, capsys):
    monkeypatch.setattr(sys, "warnoptions", ["error"])  # what libraries warn of is to be heard here

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["atomsim", *map(str, arguments)])
        capsys.readouterr()
        try:
            main()
        except SystemExit as end:
            return int(end.code or 0), *capsys.readouterr()
        return 0, *capsys.readouterr()

    return run


def test_every_shipped_scene_has_a_small_golden():
    assert len(SCENES) >= 7
    for scene in SCENES:
        golden = GOLDEN / f"{scene.stem}.golden.json"
        assert golden.stat().st_size < 400_000


def test_a_bond_law_changed_by_one_part_in_a_billion_is_caught(cli, monkeypatch):
    def changed(weight, rest_squared, law=bond_forms.weigh_bonds):
        law(weight, rest_squared)
        weight *= 1.0 + 1e-9

    monkeypatch.setattr(bond_forms, "weigh_bonds", changed)
    code, out, err = cli("golden", "check", ROOT / "scenes" / "threads.yaml", "--into", GOLDEN)
    assert code == 1
    assert re.search(
        r"threads\.yaml: differs from round \d+ on; round \d+: position of \d+ of 140 atoms differs, "
        r"first \w+\[\d+\] \(atom \d+\), most \w+\[\d+\] \(atom \d+\) by \d",
        out,
    ), out
    assert err == "1 of 1 scenes differ from their goldens\n"


def test_a_collision_law_changed_by_one_part_in_a_billion_is_caught(cli, monkeypatch):
    assert stepper.CONTACT_SQUARED is collisions.CONTACT_SQUARED
    monkeypatch.setattr(stepper, "CONTACT_SQUARED", 4.0 * (1.0 - 1e-9))
    code, out, _ = cli("golden", "check", ROOT / "scenes" / "balls.yaml", "--into", GOLDEN)
    assert code == 1
    first_wrong = int(re.search(r"differs from round (\d+) on; round \d+: ", out)[1])
    assert 140 <= first_wrong <= 160  # nothing touches before


def test_a_missing_golden_is_a_failure(cli, tmp_path):
    code, out, _ = cli("golden", "check", ROOT / "scenes" / "threads.yaml", "--into", tmp_path)
    assert code == 1
    assert "there is no golden" in out


@pytest.mark.parametrize("action", ["record", "check"])
def test_a_missing_scene_is_no_missing_golden(cli, tmp_path, action):
    """Nor is any other scene computed before it is told."""
    code, out, err = cli("golden", action, ROOT / "scenes" / "rods.yaml", tmp_path / "no.yaml", "--into", tmp_path)
    assert (code, out, err) == (2, "", f"{tmp_path / 'no.yaml'}: there is no such file\n")
    assert list(tmp_path.iterdir()) == []


def test_goldens_lie_beside_their_scenes_unless_a_folder_is_named(cli, pair, tmp_path, monkeypatch):
    scene, _, _ = pair
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    code, out, _ = cli("golden", "check", scene)
    assert (code, out) == (
        1,
        f"{scene}: there is no golden {tmp_path / 'golden' / 'pair.golden.json'}; "
        f"record it with: atomsim golden record {scene}\n",
    )
    assert cli("golden", "record", scene)[0] == 0
    assert {path.name for path in (tmp_path / "golden").iterdir()} == {"pair.golden.json", "LOG.md"}
    assert list((tmp_path / "elsewhere").iterdir()) == []
    assert cli("golden", "check", scene)[:2] == (0, f"{scene}: identical, 19 rounds\n")


@pytest.mark.parametrize("action", ["record", "check"])
@pytest.mark.parametrize("name", ["pair.golden.json", "LOG.md"])
def test_a_pipe_is_no_golden(cli, pair, tmp_path, action, name):
    os.mkfifo(tmp_path / name)
    code, out, err = cli("golden", action, pair[0], "--into", tmp_path, *["--reason", "x"][: 2 * (action == "record")])
    assert (code, out, err) == (2, "", f"{tmp_path / name}: is not a regular file\n")
    assert (tmp_path / name).is_fifo()


def test_recording_again_asks_for_a_reason_and_logs_it(cli, tmp_path):
    scene = tmp_path / "pair.yaml"
    scene.write_text(
        "atomsim: 1\ntime_step: 0.1\nrounds: 30\ngroups:\n"
        "  a: {shape: string, count: 2, step: [1, 0, 0], spin: {axis: z, rate: 1}}\n"
        "bonds:\n  a: {within: a, rule: all-pairs}\n"
    )
    folder = tmp_path / "golden"
    assert cli("golden", "record", scene, "--into", folder)[0] == 0
    before = (folder / "pair.golden.json").read_bytes()
    code, _, err = cli("golden", "record", scene, "--into", folder)
    assert code == 2
    assert err == f"{folder / 'pair.golden.json'} exists; say why it changes with --reason\n"
    scene.write_text(scene.read_text().replace("0.1", "0.2"))
    code, out, _ = cli("golden", "check", scene, "--into", folder)
    assert (code, "differs from round 10 on; round 10: position of 2 of 2 atoms differs" in out) == (1, True)
    assert cli("golden", "record", scene, "--into", folder, "--reason", "a longer step")[0] == 0
    assert (folder / "pair.golden.json").read_bytes() != before
    log = (folder / "LOG.md").read_text().splitlines()
    assert len(log) == 2
    assert log[0].endswith("first recording")
    assert log[1].endswith("a longer step")
    assert cli("golden", "check", scene, "--into", folder)[0] == 0


@pytest.mark.parametrize("action", ["record", "check"])
@pytest.mark.parametrize("below", ["", "deep/down"])
def test_a_file_is_no_folder_for_goldens(cli, tmp_path, action, below):
    (tmp_path / "file").write_text("mine")
    code, out, err = cli("golden", action, ROOT / "scenes" / "threads.yaml", "--into", tmp_path / "file" / below)
    assert (code, out, err) == (2, "", f"{tmp_path / 'file'}: this is a file; give the name of a folder\n")
    assert (tmp_path / "file").read_text() == "mine"


def test_a_scene_with_other_atoms_than_its_golden(cli, tmp_path):
    scene = tmp_path / "threads.yaml"
    scene.write_text((ROOT / "scenes" / "rods.yaml").read_text().replace("count: 70", "count: 71", 1))
    code, out, _ = cli("golden", "check", scene, "--into", GOLDEN)
    assert code == 1
    assert out == f"{scene}: differs from round 0 on; the golden has 140 atoms, the scene 141\n"


def test_two_scenes_of_one_name_do_not_share_a_golden(cli, tmp_path):
    scene = ROOT / "scenes" / "threads.yaml"
    shutil.copy(ROOT / "scenes" / "rods.yaml", tmp_path)
    shutil.copy(scene, tmp_path)
    code, out, err = cli("golden", "record", scene, tmp_path / "threads.yaml", "--into", tmp_path / "g")
    assert (code, out) == (2, "")
    assert err == (
        f"two of these scenes would share the golden {tmp_path / 'g' / 'threads.golden.json'}; "
        "record them into different folders\n"
    )
    assert not (tmp_path / "g").exists()


@pytest.mark.parametrize("damage", ["", "{}", "[]", '{"golden": 2}', "\x00\xff"])
def test_a_damaged_golden_is_no_golden(cli, tmp_path, damage):
    (tmp_path / "threads.golden.json").write_text(damage, encoding="latin-1")
    code, _, err = cli("golden", "check", ROOT / "scenes" / "threads.yaml", "--into", tmp_path)
    assert code == 2
    assert err.startswith(f"{tmp_path / 'threads.golden.json'}: is not a golden trajectory")


PAIR = (
    "atomsim: 1\ntime_step: 0.1\nrounds: 35\nrecord_every: 2\ngroups:\n"
    "  a: {shape: string, count: 2, step: [1, 0, 0], spin: {axis: z, rate: 1}}\n"
    "bonds:\n  a: {within: a, rule: all-pairs}\n"
)


@pytest.fixture
def pair(tmp_path):
    """A scene of two atoms and all its frames: rounds 0, 2, 4 … 34 and 35."""
    scene = tmp_path / "pair.yaml"
    scene.write_text(PAIR)
    model, state = atomsim.compile(atomsim.load(scene))
    return scene, list(atomsim.simulate(model, state, 35, 2)), model.groups


def test_a_golden_holds_what_the_scene_gave(cli, tmp_path, pair):
    """The digest of every frame; in full, numbers 0, 1, 4, 16 … and the last."""
    scene, frames, _ = pair
    code, out, _ = cli("golden", "record", scene, "--into", tmp_path)
    assert (code, out) == (0, f"{tmp_path / 'pair.golden.json'}: 19 digests, 5 frames\n")
    recorded = read_golden(tmp_path / "pair.golden.json")
    assert list(recorded.digests.items()) == [(frame.round_index, frame.digest) for frame in frames]
    assert list(recorded.frames) == [0, 2, 8, 32, 35]
    for number, full in zip((0, 1, 4, 16, 18), recorded.frames.values(), strict=True):
        assert full.tobytes() == frames[number].position.tobytes() + frames[number].velocity.tobytes()


@pytest.mark.parametrize(("n_frames", "in_full"), [(1, [0]), (2, [0, 2]), (4, [0, 2, 6]), (5, [0, 2, 8])])
def test_the_last_frame_is_held_once_whatever_its_number(pair, n_frames, in_full):
    assert list(record_golden(pair[1][:n_frames]).frames) == in_full


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ((0,), "differs from round 0 on; round 0: velocity of 1 of 2 atoms differs, first a[1] (atom 1), "),
        ((3, 4, 16), "differs from round 6 on; round 8: velocity of 1 of 2 atoms differs, first a[1] (atom 1), "),
        ((18,), "differs from round 35 on; round 35: velocity of 1 of 2 atoms differs, first a[1] (atom 1), "),
    ],
)
def test_the_first_round_that_differs_and_the_atom_in_the_next_full_frame(pair, wrong, said):
    _, frames, groups = pair
    approved = record_golden(frames)
    for number in wrong:
        velocity = frames[number].velocity.copy()
        velocity[1, 2] += 1e-12
        frames[number] = replace(
            frames[number], state=replace(frames[number].state, velocity=velocity), digest="another"
        )
    assert check_golden(Golden(approved.digests, {}), frames, groups) == said.split(";")[0]
    found = check_golden(approved, frames, groups)
    assert found is not None
    assert found.startswith(said)
    assert found.endswith("most a[1] (atom 1) by 1e-12")


def test_a_full_disk_leaves_the_old_golden_and_no_litter(cli, tmp_path, pair, monkeypatch):
    scene, _, _ = pair
    folder = tmp_path / "golden"
    assert cli("golden", "record", scene, "--into", folder)[0] == 0
    before = {path: path.read_bytes() for path in folder.iterdir()}

    def refused(self, target):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "replace", refused)
    code, _, err = cli("golden", "record", scene, "--into", folder, "--reason", "another")
    assert (code, err) == (1, f"{folder / 'pair.golden.json'}: cannot be written: No space left on device\n")
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


def test_a_run_of_other_rounds_than_its_golden(cli, tmp_path, pair):
    scene, _, _ = pair
    assert cli("golden", "record", scene, "--into", tmp_path)[0] == 0
    for rounds, wrong in ((34, "the run has 18 frames, the golden 19"), (36, "round 36 is not in the golden")):
        scene.write_text(PAIR.replace("rounds: 35", f"rounds: {rounds}"))
        code, out, _ = cli("golden", "check", scene, "--into", tmp_path)
        assert (code, out) == (1, f"{scene}: {wrong}\n")


def test_the_golden_of_the_rods_holds_every_frame():
    document = json.loads((GOLDEN / "rods.golden.json").read_text())
    assert list(document["digests"])[:3] == ["0", "10", "20"]
    assert len(document["digests"]) == 401
    assert list(map(int, document["frames"])) == [0, 10, 40, 160, 640, 2560, 4000]


def test_a_reason_is_one_line_of_the_log_whatever_is_in_it(cli, tmp_path):
    spaced, folder = tmp_path / "my pair.yaml", tmp_path / "g"
    spaced.write_text(PAIR)
    code, out, _ = cli("golden", "check", spaced, "--into", folder)
    assert code == 1
    assert out.endswith(f"record it with: atomsim golden record '{spaced}' --into {folder}\n")
    assert cli("golden", "record", spaced, "--into", folder, "--reason", "a\nlonger  step τ \udcff\n")[0] == 0
    log = (folder / "LOG.md").read_text(encoding="utf-8")
    assert re.fullmatch(r"- my pair: round 35 is [0-9a-f]{16}…: a longer step τ \\udcff\n", log)
