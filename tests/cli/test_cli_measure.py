"""`atomsim measure` as a user meets it: tables on the screen and in files, and whole messages."""

from __future__ import annotations

from pathlib import Path

import pytest

TABLE = """\
    round        time  height of ring  speed of ring
        0           0               6              0
       10         0.5         5.97257      0.0990237
       20           1         5.90712       0.141555
"""

ALL_FRAMES = "--events looks at all frames; measures and --rounds do not go with it"

IS_A_SCENE = "scenes/ring.yaml: is a scene, not a trajectory of atomsim; to run it: atomsim run scenes/ring.yaml"


@pytest.fixture
def ring(cli):
    assert cli("run", "scenes/ring.yaml", "--rounds", "20", "-o", "ring.h5", "--quiet").code == 0


def present() -> list[str]:
    """Return what is in the folder."""
    return sorted(path.name for path in Path().iterdir())


@pytest.mark.usefixtures("ring")
def test_a_table_is_printed(cli):
    result = cli("measure", "ring.h5", "height of ring", "speed of ring")
    assert (result.code, result.out, result.err) == (0, TABLE, "")
    assert cli("measure", "ring.h5").out == TABLE


@pytest.mark.usefixtures("ring")
def test_some_rounds_and_long_names(cli):
    result = cli("measure", "ring.h5", "z of relative velocity between ring and surface[0:3, 0]", "--rounds", "20,0")
    assert [line.split()[0] for line in result.out.splitlines()] == ["round", "0", "20"]
    assert len({len(line) for line in result.out.splitlines()}) == 1


@pytest.mark.usefixtures("ring")
def test_a_table_is_written_and_replaced(cli):
    path = Path("ring.csv")
    path.symlink_to("behind.csv")
    for _ in range(2):
        result = cli("measure", "ring.h5", "x of ring", "gap between [ring, surface] and ring", "-o", "ring.csv")
        assert (result.code, result.out, result.err) == (0, "ring.csv: 3 frames\n", "")
    assert path.is_symlink()
    lines = path.read_text().splitlines()
    assert lines[0] == 'round,time,x of ring,"gap between [ring, surface] and ring"'
    assert len(lines) == 4
    assert present() == ["behind.csv", "ring.csv", "ring.h5", "scenes"]


EVENTS = """\
    round        time  event
       10         0.5  ring touches surface
"""


@pytest.mark.usefixtures("ring")
def test_what_happened_is_printed_or_written(cli):
    result = cli("measure", "ring.h5", "--events")
    assert (result.code, result.out, result.err) == (0, EVENTS, "")
    for _ in range(2):
        result = cli("measure", "ring.h5", "--events", "-o", "events.csv")
        assert (result.code, result.out, result.err) == (0, "events.csv: 1 event\n", "")
    assert Path("events.csv").read_text() == "round,time,event,first,second\n10,0.5,first contact,ring,surface\n"


@pytest.mark.usefixtures("ring")
def test_a_file_of_others_stays(cli):
    Path("mine.csv").write_text("round,time,price\n1,2,3\n")
    result = cli("measure", "ring.h5", "-o", "mine.csv")
    assert (result.code, result.out) == (2, "")
    assert result.err == "mine.csv exists and is no table of atomsim's; add --force to replace it\n"
    assert Path("mine.csv").read_text() == "round,time,price\n1,2,3\n"
    assert cli("measure", "ring.h5", "-o", "mine.csv", "--force").code == 0
    assert Path("mine.csv").read_text().startswith("round,time,height of ring,speed of ring\n")


@pytest.mark.usefixtures("ring")
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ring.h5", "hight of ring"), "there is no measure `hight`; did you mean `height`?"),
        (("ring.h5", "height of rung"), "ring.h5: height of rung: there is no group `rung`; did you mean `ring`?"),
        (
            ("ring.h5", "height of ring[20]"),
            "ring.h5: height of ring[20]: `ring[20]` is out of range: ring has 20 there, 0 to 19",
        ),
        (("ring.h5", "gap between ring"), "gap is measured as `gap between A and B`"),
        (("ring.h5", "--rounds", "30"), "ring.h5: there is no round 30; it ends at round 20"),
        (("ring.h5", "energy", "--events"), ALL_FRAMES),
        (("ring.h5", "--events", "--rounds", "0"), ALL_FRAMES),
        (("ring.h5", "-o", "ring.txt"), "ring.txt: a table is written as .csv"),
        (("ring.h5", "-o", "no/ring.csv"), "no/ring.csv: the folder no does not exist"),
        (("no.h5", "energy"), "no.h5: no such file"),
        (("scenes/ring.yaml", "energy"), IS_A_SCENE),
    ],
)
def test_mistakes_end_in_one_line(cli, arguments, message):
    result = cli("measure", *arguments)
    assert (result.code, result.out, result.err) == (2, "", message + "\n")
    assert present() == ["ring.h5", "scenes"]


@pytest.mark.usefixtures("ring")
def test_a_table_that_breaks_off_leaves_nothing(cli):
    """The second frame is damaged: what was measured before it does not stand under the name."""
    import h5py

    with h5py.File("ring.h5", "r+") as file:
        file["particles/trajectory/position/value"][1] += 1
    Path("ring.csv").write_text("round,time,energy\n0,0,0\n")
    result = cli("measure", "ring.h5", "x of ring", "-o", "ring.csv")
    assert (result.code, result.err) == (2, "ring.h5: damaged: the state at round 10 does not match its digest\n")
    assert Path("ring.csv").read_text() == "round,time,energy\n0,0,0\n"
    assert present() == ["ring.csv", "ring.h5", "scenes"]
