"""Measures over the frames of a file: arrays by name, some rounds or all, without reading what is not needed."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.running import SCENES

import atomsim
from atomsim.tasks.recompute import laid_out_inside
from atomsim.tasks.tables import is_our_table, write_measures

MEASURES = [
    "x of ring",
    "velocity of surface[0, :]",
    "turning of ring",
    "gap between ring and surface",
    "energy",
    "contacts",
]


@pytest.fixture(scope="module")
def ring(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of 61 frames, of which the last is not at a multiple of ten."""
    out = tmp_path_factory.mktemp("ring") / "ring.h5"
    atomsim.run(atomsim.load(SCENES / "ring.yaml", ["rounds=595"]), out)
    return out


def test_arrays_by_name_are_what_frames_give(ring: Path) -> None:
    measured = atomsim.measure(ring, MEASURES)
    with atomsim.Trajectory(ring) as trajectory:
        frames = list(trajectory)
        energies = trajectory.observables
        assert measured.round.tolist() == trajectory.rounds.tolist()
        assert measured.time.tolist() == trajectory.time.tolist()
    assert list(measured) == MEASURES
    assert measured["x of ring"] == pytest.approx([frame.position[:20, 0].mean() for frame in frames])
    assert measured["velocity of surface[0, :]"].shape == (61, 3)
    assert measured["Contacts"].tolist() == energies["contacts"].tolist()
    total = sum(energies[name] for name in ("kinetic_energy", "potential_energy_bonds", "potential_energy_collisions"))
    assert measured["energy"] == pytest.approx(total)
    assert measured["z of turning of ring"].tolist() == measured["turning of ring"][:, 2].tolist()
    assert measured.table.shape == (61, 10)
    assert len(measured.columns) == 10


@pytest.mark.parametrize("text", ["y of ring", "ring", "height of ring", "gap between ring and ring["])
def test_what_was_not_measured_is_not_there(ring: Path, text: str) -> None:
    measured = atomsim.measure(ring, ["x of ring"], rounds=[0])
    with pytest.raises(KeyError):
        measured[text]
    assert text not in measured


def test_some_rounds_are_the_nearest_frames_and_turns_are_counted_all_the_same(ring: Path) -> None:
    everything = atomsim.measure(ring, MEASURES)
    some = atomsim.measure(ring, MEASURES, rounds=[595, 0, 301, 304, 3])
    assert some.round.tolist() == [0, 300, 595]
    assert some.table.tobytes() == everything.table[[0, 30, 60]].tobytes()


def test_rounds_may_be_written_as_on_the_command_line(ring: Path) -> None:
    assert atomsim.measure(ring, "energy", rounds="0-200:100,-2,0").round.tolist() == [0, 100, 200, 590, 595]


def test_one_measure_may_be_a_text_and_a_file_may_be_open(ring: Path) -> None:
    with atomsim.Trajectory(ring) as trajectory:
        measured = atomsim.measure(trajectory, "speed of ring")
        assert len(trajectory[0].position) == 20 + 289
    assert list(measured) == ["speed of ring"]


def test_what_moves_is_measured_where_nobody_says_what(ring: Path) -> None:
    assert list(atomsim.measure(ring, rounds=[0])) == ["height of ring", "speed of ring"]


def test_where_everything_is_held_the_whole_is_measured(tmp_path: Path) -> None:
    atomsim.run(atomsim.load(SCENES / "ring.yaml", ["rounds=10", "forces.ground.acts_on=all"]), tmp_path / "held.h5")
    assert list(atomsim.measure(tmp_path / "held.h5")) == ["height of all", "speed of all"]


def test_the_height_is_along_the_axis_that_the_camera_has_upwards(ring: Path) -> None:
    measured = atomsim.measure(ring, ["height of ring", "y of ring"], rounds=[0])
    assert measured["height of ring"].tolist() == measured["y of ring"].tolist() == [6.0]


def test_observables_are_known_without_reading_a_frame(ring: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(atomsim.Trajectory, "_frame", None)
    assert atomsim.measure(ring, ["energy", "bond energy"]).table.shape == (61, 2)


@pytest.mark.parametrize(
    ("measures", "rounds", "message"),
    [
        ("hight of ring", None, "there is no measure `hight`; did you mean `height`?"),
        ("height of ring[", None, "height of ring[: `ring[` is no selection"),
        ("height of rong", None, "ring.h5: height of rong: there is no group `rong`; did you mean `ring`?"),
        (
            "max strain of bonds.rong",
            None,
            "ring.h5: max strain of bonds.rong: there is no `bonds.rong`; did you mean `ring`?",
        ),
        ("tilt of ring[0]", None, "ring.h5: tilt of ring[0]: `ring[0]` is a single atom"),
        ([], None, "measures: needs measures, such as `height of ring`, at least one (got [])"),
        (["energy", 3], None, "measures: needs measures, such as `height of ring`, at least one (got 3)"),
        ("energy", [], "rounds: needs whole numbers, such as [0, 250]"),
        ("energy", [0.5], "rounds: needs a whole number of 0 or more (got 0.5)"),
        ("energy", [596], "ring.h5: there is no round 596; it ends at round 595"),
        ("energy", [-1], "rounds: needs a whole number of 0 or more (got -1)"),
    ],
)
def test_mistakes_are_told(ring: Path, measures: str | list[str], rounds: list[int] | None, message: str) -> None:
    with pytest.raises(atomsim.InputError) as error:
        atomsim.measure(ring, measures, rounds=rounds)
    assert message in str(error.value)


def test_a_simulation_measures_what_its_file_would_give(ring: Path) -> None:
    simulation = atomsim.Simulation(atomsim.load(SCENES / "ring.yaml"))
    measured = atomsim.measure(ring, MEASURES)
    for frame in range(4):
        found = simulation.measure(MEASURES)
        assert list(found) == MEASURES
        for text, value in found.items():
            assert np.array_equal(value, measured[text][frame])
        simulation.step(10)
    assert simulation.measure().contacts == measured["contacts"][4]
    with pytest.raises(atomsim.InputError, match=r"^height of rong: there is no group `rong`; did you mean `ring`\?$"):
        simulation.measure("height of rong")


def test_a_scene_of_other_groups_than_the_frames_is_refused(ring: Path) -> None:
    with atomsim.Trajectory(ring) as trajectory:
        header = trajectory.header
    assert laid_out_inside(header, ring).scene.groups
    other = replace(header, group_names=("hoop", "surface"))
    with pytest.raises(atomsim.InputError, match="the scene inside has other groups than the frames"):
        laid_out_inside(other, ring)


def test_a_table_gives_every_number_back(ring: Path, tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    with atomsim.Trajectory(ring) as trajectory:
        assert write_measures(trajectory, [*MEASURES, "speed of [ring, surface]"], table) == 61
    measured = atomsim.measure(ring, [*MEASURES, "speed of [ring, surface]"])
    with table.open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    assert names == ["round", "time", *measured.columns]
    assert np.array(rows, dtype=float)[:, 2:].tobytes() == measured.table.tobytes()
    assert is_our_table(table)


@pytest.mark.parametrize(
    "content",
    [b"", b"round,time,price\n", b"a,b\n", b"\xff\xfe", b"time,round,energy\n", b'round,time,"\n' * 9],
)
def test_tables_of_others_are_told_apart(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_bytes(content)
    assert not is_our_table(path)
    assert not is_our_table(tmp_path / "none.csv")
