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
    folder = Path(f"frames of {' '.join(arguments)}")
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


def test_the_strip_is_spread_evenly_where_nobody_chose_and_nothing_happens(cli, record):
    record("out.h5")
    assert words(cli, "out.h5") == ["bricks.yaml", *(f"round {number}" for number in (0, 8, 16, 28, 36, 42))]
    record("long.h5", "rounds=300")
    assert words(cli, "long.h5")[1:] == [f"round {number}" for number in (0, 60, 120, 180, 240, 300)]
    record("short.h5", "rounds=9")
    assert words(cli, "short.h5") == ["bricks.yaml", "round 0", "round 4", "round 8", "round 9"]


LATE = ("rounds=400", "forces={kick: {kind: push, acts_on: brick, impulse: [0.5, 0, 0], from_round: 340}}")


def test_the_strip_shows_where_something_happens(cli, record):
    record("late.h5", *LATE)
    shown = [int(line.removeprefix("round ")) for line in words(cli, "late.h5")[1:]]
    assert (shown[0], shown[-1], len(shown)) == (0, 400, 6)
    assert len([number for number in shown if number >= 340]) >= 3


def test_rows_show_the_same_rounds_from_the_same_side(cli, record):
    """Two runs are compared column by column, so what happens in one of them chooses for both."""
    record("late.h5", *LATE)
    record("still.h5", "rounds=400")
    both = words(cli, "still.h5", "late.h5")
    assert both[1:7] == both[8:14] != words(cli, "still.h5")[1:]
    alone, beside = (picture(cli, name, "--rounds", "0") for name in ("late.h5", "still.h5"))
    assert (alone != beside).any()
    assert cli("render", "late.h5", "still.h5", "--rounds", "0", "--frames", "both", "--size", "96x72").code == 0
    one, other = (Image.open(path) for path in sorted(Path("both").iterdir()))
    assert (np.asarray(one) == np.asarray(other)).all()


def test_motion_is_seen_across_unless_somebody_says_otherwise(cli, record):
    moving = ("groups.brick.velocity=[3, 0, 0]", "render={camera: {look_at: [4, 4, 0], width: 30}}")
    record("moving.h5", *moving)
    across = picture(cli, "moving.h5", "--rounds", "0")
    assert (across == picture(cli, "moving.h5", "--rounds", "0", "--camera=-70,20")).all()
    record("said.h5", moving[0], "render={camera: {azimuth: 30, look_at: [4, 4, 0], width: 30}}")
    assert (picture(cli, "said.h5", "--rounds", "0") != across).any()
    record("side.h5", moving[0], "render={camera: {view: side, look_at: [4, 4, 0], width: 30}}")
    side = picture(cli, "side.h5", "--rounds", "0")
    assert (side == picture(cli, "moving.h5", "--rounds", "0", "--camera", "Side")).all()
    assert (side == picture(cli, "said.h5", "--rounds", "0", "--camera", "0,0")).all()


def test_where_to_look_and_how_much_to_see(cli, record):
    record("said.h5", "render={camera: {azimuth: 10, elevation: 30, look_at: [3, 3, 1], width: 25}}")
    record("asked.h5", "render={camera: {azimuth: 10, elevation: 30}}")
    asked = ("--look-at", "3,3,1", "--width", "25", "--rounds", "0")
    assert (picture(cli, "asked.h5", *asked) == picture(cli, "said.h5", "--rounds", "0")).all()


def test_a_group_is_followed(cli, record):
    """The brick flies on, and stays where it is in the picture; so the scene may say it, too."""
    flying = "groups.brick.velocity=[0, 3, 0]"
    record("out.h5", flying)
    view = ("--follow", "brick", "--camera", "top", "--width", "12")
    for number in (0, 42):
        seen = picture(cli, "out.h5", *view, "--rounds", str(number)).astype(int)
        row, column = np.nonzero(seen[:, :, 0] > seen[:, :, 2] + 30)
        assert (row.mean(), column.mean()) == (pytest.approx(36, abs=2), pytest.approx(48, abs=2))
    record("said.h5", flying, "render={camera: {follow: brick, view: top, width: 12}}")
    assert (picture(cli, "said.h5", "--rounds", "42") == seen).all()
    assert (picture(cli, "said.h5", "--rounds", "42", "--look-at", "0,0,0") != seen).any()


def test_several_cameras_make_several_rows(cli, record):
    record("out.h5", "title=Bricks")
    assert words(cli, "out.h5", "--rounds", "0", "--camera", "front", "--camera", "30,20") == [
        "Bricks — from the front",
        "round 0",
        "Bricks — from 30°, 20° up",
        "round 0",
    ]
    cameras = ("--camera", "front", "--camera", "top", "--rounds", "0", "--size", "96x72")
    assert cli("render", "out.h5", *cameras, "--frames", "rows").code == 0
    for number, name in enumerate(("front", "top"), 1):
        with Image.open(f"rows/row-{number}-round-0.png") as image:
            assert (np.asarray(image) == picture(cli, "out.h5", "--camera", name, "--rounds", "0")).all()


def test_a_group_fills_the_picture(cli, record):
    record("out.h5")
    near = picture(cli, "out.h5", "--close-up", "brick", "--rounds", "0", "--field-of-view", "40").astype(int)
    assert (near[:, :, 0] > near[:, :, 2] + 30).mean() > 0.3
    record("said.h5", "render={camera: {close_up: brick, field_of_view: 40}}")
    assert (picture(cli, "said.h5", "--rounds", "0") == near).all()


def test_dark_transparent_and_measured_on_paper(cli, record):
    record("out.h5")
    assert picture(cli, "out.h5", "--dark", "--rounds", "0")[0, 0].tolist() == [42, 42, 45]
    assert (
        cli("render", "out.h5", "--transparent", "--size", "1.27x0.9525cm", "--dpi", "200", "--rounds", "0").code == 0
    )
    with Image.open("out.png") as image:
        assert image.getpixel((0, 0))[3] == 0
        assert image.info["dpi"] == pytest.approx((200, 200), abs=0.01)
        assert 100 <= image.width < 150


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--camera", "front", "--camera", "back"), 'camera.view: needs front, side or top (got "back")'),
        (("--field-of-view", "150"), "camera.field_of_view: needs 120 or less (got 150)"),
        (("--size", "640"), "size is written 640x480, in pixels, or 8x6cm; got 640"),
        (("--dpi", "5"), "dpi: needs a whole number from 20 to 2400 (got 5)"),
        (("--transparent", "-o", "a.jpg"), "a.jpg: a JPEG cannot be transparent; use .png, .webp, .pdf or .svg"),
        (("--camera", "back"), 'camera.view: needs front, side or top (got "back")'),
        (("--camera", "30"), "--camera needs two numbers, as in 30,20; or front, side or top (got 30)"),
        (("--look-at", "brick"), "--look-at needs three numbers, as in 0,0,5 (got brick)"),
        (("--look-at", "1,2"), "--look-at needs three numbers, as in 0,0,5 (got 1,2)"),
        (("--width", "wide"), "--width needs a number of 0 or more (got wide)"),
        (("--width", "0"), "camera.width: needs a number above 0 (got 0)"),
        (("--follow", "brik"), "camera.follow: there is no group `brik`; did you mean `brick`?"),
        (("--follow", "brick[7]"), "out.h5: camera.follow: `brick[7]` is out of range: brick has 1 there, 0 to 0"),
        (
            ("--follow", "brick", "--look-at", "0,0,0"),
            "camera: say one of `look_at`, `follow` and `close_up`: where to look",
        ),
    ],
)
def test_cameras_that_will_not_do(cli, record, arguments, message):
    record("out.h5")
    result = cli("render", "out.h5", *arguments)
    assert (result.code, result.out, result.err) == (2, "", message + "\n")


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
