"""Plots: what stands on them and where, read from their SVG, and files that are whole or not there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from support.running import SCENES
from support.small_strip import small_plot

import atomsim
from atomsim.drawing.chart import Chart, Line, Mark
from atomsim.drawing.plot import plot_to
from atomsim.errors import InputError


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two runs."""
    folder = tmp_path_factory.mktemp("runs")
    atomsim.run(atomsim.load(SCENES / "balls.yaml", ["rounds=1500"]), folder / "balls.h5")
    atomsim.run(atomsim.load(SCENES / "balls.yaml", ["rounds=600", "groups.ball_1.color=white"]), folder / "white.h5")
    return folder


def words(svg: Path) -> list[str]:
    """Return every text on a plot; an SVG file holds them as comments."""
    return [text for text in re.findall(r"<!-- (.+?) -->", svg.read_text(encoding="utf-8")) if "matplotlib" not in text]


def plotted(runs: Path, *names: str, **settings: object) -> list[str]:
    out = runs / "plot.svg"
    atomsim.plot([runs / name for name in names], out, **settings)  # type: ignore[arg-type]
    return words(out)


def test_the_first_groups_that_move_are_shown_with_what_happened(runs: Path) -> None:
    found = plotted(runs, "balls.h5")
    assert {"Two balls on an elastic surface", "height", "speed", "length", "length/time", "round", "surface"} <= set(
        found
    )
    assert {"ball_1 touches surface", "ball_2 falls off surface"} <= set(found)
    assert "ball_1 touches, bounces off, leaves ball_2" in found


def test_only_events_of_what_is_measured_are_marked(runs: Path) -> None:
    found = plotted(runs, "balls.h5", measures="height of ball_2")
    assert "height of ball_2" in found
    assert "ball_2 touches surface" in found
    assert not any("ball_1" in text and "ball_2" not in text for text in found)
    assert not any("touches" in text for text in plotted(runs, "balls.h5", measures="energy", mark_events=False))
    assert any("touches" in text for text in plotted(runs, "balls.h5", measures="energy"))


def test_what_falls_out_of_the_scene_leaves_the_chart_and_an_arrow_says_so(runs: Path) -> None:
    found = plotted(
        runs, "balls.h5", measures=["height of ball_1", "height of surface", "speed of ball_1", "speed of ball_2"]
    )
    assert {"ball_1 ↓", "surface", "ball_1 ↑", "ball_2 ↑"} <= set(found)
    assert "−100" not in found  # it falls to −144


def test_components_have_a_chart_and_letters(runs: Path) -> None:
    found = plotted(runs, "balls.h5", measures=["velocity of ball_1"], rounds="0-500", mark_events=False)
    assert [text for text in found if text in ("x", "y", "z")] == ["x", "y", "z"]
    assert "velocity of ball_1" in found


def test_several_runs_share_the_charts_by_their_names(runs: Path) -> None:
    found = plotted(runs, "balls.h5", "white.h5", measures=["height of ball_1", "gap between ball_1 and surface"])
    assert (found.count("white"), found.count("balls ↓"), found.count("balls ↑")) == (2, 1, 1)
    assert "Two balls on an elastic surface" not in found


def test_lines_have_the_colors_of_groups_darkened_where_they_would_not_show(runs: Path) -> None:
    plotted(runs, "white.h5", measures=["height of ball_1", "height of ball_2"])
    text = (runs / "plot.svg").read_text(encoding="utf-8")
    assert "#daa520" in text
    assert "#ffffff" not in re.sub(r"#ffffff; ?opacity|fill: #ffffff", "", text)
    assert "#bababa" in text


def test_rounds_limit_what_is_shown(runs: Path) -> None:
    found = plotted(runs, "balls.h5", measures="height of ball_1", rounds="0-100")
    assert "100" in found
    assert not any("touches" in text for text in found)


@pytest.mark.parametrize("extension", ["png", "jpg", "webp"])
def test_pictures_have_the_size_that_is_asked_for(tmp_path: Path, extension: str) -> None:
    small_plot(tmp_path / f"a.{extension}")
    with Image.open(tmp_path / f"a.{extension}") as picture:
        assert picture.size == (400, 300)


@pytest.mark.parametrize(
    ("size", "message"),
    [
        ((300, 300), None),
        ((100, 300), "a plot of this needs"),
        ((400, 100), "a plot of this needs"),
        ((20000, 300), "would be larger than 16000 pixels"),
    ],
)
def test_sizes_that_will_not_do_are_refused(tmp_path: Path, size: tuple[int, int], message: str | None) -> None:
    if message is None:
        small_plot(tmp_path / "a.png", size)
    else:
        with pytest.raises(InputError, match=message):
            small_plot(tmp_path / "a.png", size)
        assert list(tmp_path.iterdir()) == []


def test_a_single_frame_a_constant_and_nothing_finite_can_be_drawn(tmp_path: Path) -> None:
    def line(*values: float) -> Line:
        return Line("a", np.arange(len(values)), np.array(values), "#000000", np.ones(len(values), dtype=bool))

    charts = [Chart("one", "", (line(*values),)) for values in ([3.0], [5.0, 5.0], [np.nan, np.inf], [1e300, -1e300])]
    plot_to(charts, [], "", tmp_path / "a.svg")
    assert words(tmp_path / "a.svg").count("a") == 4


def test_a_title_is_shortened_to_its_room(tmp_path: Path) -> None:
    line = Line("l" * 300, np.arange(2), np.zeros(2), "#000000", np.ones(2, dtype=bool))
    marks = [Mark(0, "m" * 500, "#000000")]
    plot_to([Chart("c" * 300, "u", (line,))], marks, "t" * 500, tmp_path / "a.svg")
    assert all(text.endswith("…") for text in words(tmp_path / "a.svg") if text[0] in "lcmt")


def test_of_many_events_what_finds_no_room_is_still_a_line(tmp_path: Path) -> None:
    line = Line("", np.arange(100), np.zeros(100), "#000000", np.ones(100, dtype=bool))
    marks = [Mark(number, f"event number {number}", "#000000") for number in range(100)]
    plot_to([Chart("c", "", (line,))], marks, "", tmp_path / "a.svg")
    assert 10 < sum("event" in text for text in words(tmp_path / "a.svg")) < 100
    assert (tmp_path / "a.svg").read_text().count("#b4b4be") == 100


@pytest.mark.parametrize(
    ("picture", "message"),
    [("a.txt", "the extension tells the format"), ("no/a.png", "the folder .*no does not exist")],
)
def test_names_that_will_not_do_are_refused_before_anything_is_read(picture: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        atomsim.plot("no such file.h5", tmp_path / picture)
