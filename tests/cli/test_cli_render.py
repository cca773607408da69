"""`atomsim render`: which rounds a strip shows, from where, and what stands beside them; read from the pictures."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

SCENE = """
atomsim: 1
time_step: 0.05
rounds: 42
record_every: 4
groups:
  floor: {shape: plane, counts: [6, 6], step_x: [1.5, 0, 0], step_y: [0, 1.5, 0], color: "#4682b4"}
  brick: {shape: atoms, positions: [[0, 0, 3]], color: "#b22222"}
"""


@pytest.fixture
def record(cli):
    """Record a run of the scene with some settings: rounds 0, 4, 8 … 40 and 42."""
    Path("bricks.yaml").write_text(SCENE)

    def run(name: str, *settings: str, code: int = 0) -> None:
        changed = [part for setting in settings for part in ("--set", setting)]
        assert cli("run", "bricks.yaml", "-o", name, "-q", *changed).code == code

    return run


def words(cli, *arguments: str) -> list[str]:
    """Return every line of text on a strip, from top to bottom; an SVG file holds them as comments."""
    assert cli("render", *arguments, "-o", "words.svg", "--size", "240x40").code == 0
    return re.findall(r"<!-- (.+?) -->", Path("words.svg").read_text(encoding="utf-8"))


def picture(cli, *arguments: str) -> np.ndarray:
    """Return the pixels of the single frame that a command draws, (72, 96, 3)."""
    folder = Path(f"frames of {arguments[0]}")
    assert cli("render", *arguments, "--frames", str(folder), "--size", "96x72").code == 0
    [file] = folder.iterdir()
    with Image.open(file) as image:
        pixels = np.asarray(image.convert("RGB"))
    assert pixels.shape == (72, 96, 3)
    return pixels


def test_frames_do_not_replace_what_atomsim_did_not_draw(cli, record):
    record("out.h5")
    frames = ("render", "out.h5", "--frames", "film", "--size", "32x24", "--rounds", "0,12")
    Path("film").mkdir()
    Path("film/round-12.png").write_text("mine")
    Path("film/holiday.png").write_text("mine, too")
    result = cli(*frames)
    assert (result.code, result.out) == (2, "")
    assert result.err == "film/round-12.png exists and atomsim did not draw it; add --force to replace it\n"
    assert Path("film/round-12.png").read_text() == "mine"
    assert cli(*frames, "--force").code == 0
    assert cli(*frames).code == 0
    assert Path("film/holiday.png").read_text() == "mine, too"


def test_frames_and_a_strip_are_two_commands(cli, record):
    record("out.h5")
    result = cli("render", "out.h5", "--frames", "film", "-o", "strip.png")
    assert (result.code, result.out) == (2, "")
    assert result.err == "--frames writes pictures into its folder, and no strip; -o does not go with it\n"
    assert not Path("film").exists()


def test_the_strip_is_spread_evenly_over_the_frames_where_nobody_chose(cli, record):
    record("out.h5")
    assert words(cli, "out.h5") == ["bricks.yaml", *(f"round {number}" for number in (0, 8, 16, 24, 32, 42))]
    record("long.h5", "rounds=300")
    assert words(cli, "long.h5")[1:] == [f"round {number}" for number in (0, 60, 120, 180, 240, 300)]
    record("short.h5", "rounds=9")
    assert words(cli, "short.h5") == ["bricks.yaml", "round 0", "round 4", "round 8", "round 9"]


def test_the_strip_shows_what_the_scene_chose_as_far_as_the_run_went(cli, record):
    chosen = "render={rounds: [16, 0, 40, 300]}"
    cases = {400: (16, 0, 40, 300), 300: (16, 0, 40, 300), 299: (16, 0, 40, 299), 16: (16, 0), 12: (0, 12)}
    for n_rounds, shown in cases.items():
        record(f"{n_rounds}.h5", chosen, f"rounds={n_rounds}")
        assert words(cli, f"{n_rounds}.h5")[1:] == [f"round {number}" for number in shown]
    assert words(cli, "300.h5", "--rounds", "8")[1:] == ["round 8"]


def test_a_round_that_is_not_recorded_is_shown_by_the_nearest_the_earlier_of_two(cli, record):
    record("out.h5")
    assert words(cli, "out.h5", "--rounds", "0,5,6,7,41,42") == [
        "bricks.yaml",
        "round 0",
        "round 4 (nearest to 5)",
        "round 4 (nearest to 6)",
        "round 8 (nearest to 7)",
        "round 40 (nearest to 41)",
        "round 42",
    ]
    assert cli("render", "out.h5", "--rounds", "43").err == "out.h5: there is no round 43; it ends at round 42\n"


def test_every_row_has_the_title_of_its_scene(cli, record):
    record("a.h5", "title=One brick")
    record("b.h5")
    assert words(cli, "b.h5", "a.h5", "--rounds", "4") == ["bricks.yaml", "round 4", "One brick", "round 4"]


def test_a_run_that_blew_up_says_so_above_its_pictures(cli, record):
    blow_up = (
        "bonds={floor: {within: floor, rule: all-pairs}}",
        "groups.floor.spin={axis: z, rate: 0.1}",
        "time_step=0.1",
    )
    record("a.h5", "title=Bricks", "rounds=400", *blow_up, code=3)
    [last] = [line for line in cli("show", "a.h5").out.splitlines() if line.startswith("  frames")]
    last_round = re.search(r"round 0 to ([1-9]\d*) of 400", last)[1]
    assert words(cli, "a.h5")[0] == f"Bricks — blew up after round {last_round}"


def test_camera_is_azimuth_then_elevation(cli, record):
    """As if the scene had said so, which keeps its say in all else."""
    view = "look_at: [4, 4, 0], width: 14, up: y"
    record("asked.h5", f"render={{camera: {{{view}}}}}")
    record("said.h5", f"render={{camera: {{azimuth: 200, elevation: 70, {view}}}}}")
    asked = picture(cli, "asked.h5", "--rounds", "0", "--camera", "200,70")
    assert (asked == picture(cli, "said.h5", "--rounds", "0")).all()
    assert (asked != picture(cli, "asked.h5", "--rounds", "0")).any()
    for name, *camera in (("asked.h5", "--camera", "200,70"), ("said.h5",)):
        assert cli("render", name, "--rounds", "0", "--size", "96x72", *camera).code == 0
    assert Path("asked.png").read_bytes() == Path("said.png").read_bytes()


def test_what_has_left_since_the_start_is_no_part_of_a_later_picture(cli, record):
    """Also where the start is not shown: the brick is far above and the floor fills the picture."""
    record("out.h5", "groups.brick.velocity=[0, 0, 200]")
    later = picture(cli, "out.h5", "--rounds", "40")
    is_floor = later[:, :, 2] > later[:, :, 0].astype(int) + 20
    assert is_floor.mean() > 0.1


def test_the_background_is_that_of_the_scene(cli, record):
    record("out.h5", "render={background: lightyellow}")
    assert picture(cli, "out.h5", "--rounds", "0")[0, 0].tolist() == [255, 255, 224]


def test_capitals_in_sizes_and_extensions_are_as_good(cli, record):
    record("out.h5")
    assert cli("render", "out.h5", "-o", "A.PNG", "--size", "96X72", "--rounds", "0").out == "A.PNG\n"
    assert cli("render", "out.h5", "-o", "a.png", "--size", "96x72", "--rounds", "0").out == "a.png\n"
    assert Path("A.PNG").read_bytes() == Path("a.png").read_bytes()
    with Image.open("a.png") as image:
        assert 96 < image.width < 150


def test_pictures_of_a_run_that_has_not_finished_come_with_a_notice(cli, record, monkeypatch):
    from atomsim.trajectory import Recorder

    def killed(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Recorder, "finish", killed)
        record("out.h5", code=130)
    result = cli("render", "out.h5", "--rounds", "0", "--size", "64x48")
    assert (result.code, result.out) == (0, "out.png\n")
    assert result.err.startswith("out.h5: read from its journal up to round 42; to go on: ")
    assert cli("render", "out.h5", "--frames", "film", "--size", "64x48").err == result.err


@pytest.mark.parametrize(
    ("picture", "message"),
    [
        ("folder.png", "folder.png: this is a folder; give the name of a file"),
        ("pipe.png", "pipe.png exists and atomsim did not draw it; add --force to replace it"),
    ],
)
def test_what_is_no_file_is_no_picture(cli, record, picture: str, message: str) -> None:
    """A pipe is not even opened: it would wait for a writer for ever."""
    record("out.h5")
    Path("folder.png").mkdir()
    os.mkfifo("pipe.png")
    result = cli("render", "out.h5", "-o", picture)
    assert (result.code, result.out, result.err) == (2, "", message + "\n")


def test_a_name_that_looks_like_an_option_can_be_typed_as_told(cli) -> None:
    Path("bricks.yaml").write_text(SCENE)
    told = cli("run", "bricks.yaml", "-o", "./-x.h5").out.splitlines()[-1]
    assert told == "next: atomsim render ./-x.h5"
    assert cli(*told.split()[2:]).out == "-x.png\n"
