"""`atomsim plot`: which words are trajectories and which are measures, what is written, and whole messages."""

from __future__ import annotations

import re
from pathlib import Path

import pytest


@pytest.fixture
def runs(cli):
    """Two runs, one of which has a name that could be a measure."""
    for name in ("ring.h5", "energy"):
        assert cli("run", "scenes/ring.yaml", "--rounds", "40", "-o", name, "--quiet").code == 0


def words(svg: str) -> list[str]:
    return re.findall(r"<!-- (.+?) -->", Path(svg).read_text(encoding="utf-8"))


@pytest.mark.usefixtures("runs")
def test_the_picture_stands_beside_the_trajectory(cli):
    result = cli("plot", "ring.h5")
    assert (result.code, result.out, result.err) == (0, "ring-plot.png\n", "")
    first = Path("ring-plot.png").read_bytes()
    assert cli("plot", "ring.h5").code == 0
    assert Path("ring-plot.png").read_bytes() == first


@pytest.mark.usefixtures("runs")
def test_files_come_first_then_measures(cli):
    result = cli("plot", "ring.h5", "energy", "height of ring", "-o", "both.svg")
    assert (result.code, result.out, result.err) == (0, "both.svg\n", "")
    assert {"ring", "energy", "height of ring"} <= set(words("both.svg"))
    assert cli("plot", "ring.h5", "height of ring", "energy", "-o", "one.svg").code == 0
    assert {"height of ring", "energy", "ring touches surface"} <= set(words("one.svg"))


@pytest.mark.usefixtures("runs")
def test_rounds_size_and_no_events(cli):
    result = cli("plot", "ring.h5", "x of ring", "--rounds", "0-20", "--size", "320x240", "--no-events", "-o", "a.svg")
    assert (result.code, result.err) == (0, "")
    assert not any("touches" in text for text in words("a.svg"))
    assert 'viewBox="0 0 360 270"' in Path("a.svg").read_text()  # 320 and 240 pixels of 64 to the inch, in points


@pytest.mark.usefixtures("runs")
def test_a_picture_of_others_stays(cli):
    Path("mine.png").write_bytes(b"precious")
    result = cli("plot", "ring.h5", "-o", "mine.png")
    assert (result.code, result.out) == (2, "")
    assert result.err == "mine.png exists and atomsim did not draw it; add --force to replace it\n"
    assert Path("mine.png").read_bytes() == b"precious"
    assert cli("plot", "ring.h5", "-o", "mine.png", "--force").code == 0


@pytest.mark.usefixtures("runs")
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ring.h5", "hight of ring"), "there is no measure `hight`; did you mean `height`?"),
        (("ring.h5", "no.h5", "energy"), "no.h5: no such file"),
        (("no.h5",), "no.h5: no such file"),
        (("ring.h5", "height of rung"), "ring.h5: height of rung: there is no group `rung`; did you mean `ring`?"),
        (("ring.h5", "--rounds", "50"), "ring.h5: there is no round 50; it ends at round 40"),
        (("ring.h5", "--size", "40x40"), "a plot of this needs 186x384 pixels or more"),
        (("ring.h5", "--size", "big"), "--size needs two numbers, as in 1280x720 (got big)"),
        (("ring.h5", "-o", "a.txt"), "a.txt: the extension tells the format; use .png, .jpg"),
    ],
)
def test_mistakes_end_in_one_line(cli, arguments, message):
    before = sorted(path.name for path in Path().iterdir())
    result = cli("plot", *arguments)
    assert (result.code, result.out) == (2, "")
    assert result.err.count("\n") == 1
    assert result.err.startswith(message)
    assert sorted(path.name for path in Path().iterdir()) == before
