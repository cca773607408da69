"""The finished file as others see it: H5MD 1.1, read by MDAnalysis without a warning."""

from __future__ import annotations

from pathlib import Path

import h5py
import MDAnalysis
import numpy as np
import pytest
from sample_run import SCENE, TIME_STEP, frame, header, record

ROUNDS = [0, 10, 20, 30, 40]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return record(tmp_path / "out.h5md", header(40))


def test_the_layout_is_the_one_of_the_handbook(path: Path) -> None:
    with h5py.File(path) as file:
        found: dict[str, tuple[str, tuple[int, ...]]] = {}
        file.visititems(
            lambda name, item: (
                found.update({name: (item.dtype.str, item.shape)}) if isinstance(item, h5py.Dataset) else None
            )
        )
        assert found["particles/trajectory/position/value"] == ("<f8", (5, 7, 3))
        assert found["particles/trajectory/velocity/value"] == ("<f8", (5, 7, 3))
        assert found["particles/trajectory/mass"] == ("<f8", (7,))
        assert found["particles/trajectory/species"] == ("<i4", (7,))
        assert found["connectivity/bonds"] == ("<i4", (2, 2))
        assert list(file["particles"]) == ["trajectory"]
        assert file["h5md"].attrs["version"].tolist() == [1, 1]
        assert file["h5md/creator"].attrs["name"] == b"atomsim"
        assert file["particles/trajectory/box"].attrs["boundary"].tolist() == [b"none"] * 3
        assert file["particles/trajectory/species"][()].tolist() == [0, 0, 0, 0, 1, 1, 1]
        assert file[file["connectivity/bonds"].attrs["particles_group"]].name == "/particles/trajectory"
        assert file["parameters/vmd_structure/bond_from"][()].tolist() == [1, 5]
        assert file["parameters/vmd_structure/bond_to"][()].tolist() == [2, 6]
        assert file["parameters/atomsim/scene"].asstr()[()] == SCENE
        assert file["parameters/atomsim/end"].asstr()[()] == "finished"


def test_every_series_shares_the_times_of_the_positions(path: Path) -> None:
    with h5py.File(path) as file:
        step, time = (file[f"particles/trajectory/position/{name}"] for name in ("step", "time"))
        assert step[()].tolist() == ROUNDS
        assert time[()].tolist() == [i * TIME_STEP for i in ROUNDS]
        assert len(file["observables"]) == 7
        for series in (file["particles/trajectory/velocity"], *file["observables"].values()):
            assert series["step"] == step
            assert series["time"] == time
            assert len(series["value"]) == 5


@pytest.mark.parametrize(("n_atoms", "rows"), [(7, 12), (1000, 12), (10_000, 4), (50_000, 1)])
def test_chunks_hold_about_a_mebibyte_and_no_spare_rows(tmp_path: Path, n_atoms: int, rows: int) -> None:
    path = record(tmp_path / "out.h5", header(11, n_atoms=n_atoms, record_every=1))
    with h5py.File(path) as file:
        for name in ("position", "velocity"):
            value = file[f"particles/trajectory/{name}/value"]
            assert value.chunks == (rows, n_atoms, 3)
            assert value.shape == value.maxshape == (12, n_atoms, 3)
            assert (value.compression, value.shuffle) == (None, False)


def test_the_compressed_file_is_shuffled_and_deflated(tmp_path: Path) -> None:
    with h5py.File(record(tmp_path / "out.h5", header(40, compress=True))) as file:
        value = file["particles/trajectory/position/value"]
        assert (value.compression, value.compression_opts, value.shuffle) == ("gzip", 1, True)
        assert np.array_equal(value[2], frame(20).position)


def test_mdanalysis_opens_it_by_its_extension(path: Path) -> None:
    universe = MDAnalysis.Universe(str(path), to_guess=())
    _check_universe(universe)


def test_mdanalysis_opens_it_under_any_name(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(40))
    universe = MDAnalysis.Universe.empty(7, trajectory=True)
    universe.load_new(str(path), format="H5MD")
    _check_universe(universe)
    _check_universe(MDAnalysis.Universe(str(path), format="H5MD", topology_format="MINIMAL", n_atoms=7, to_guess=()))


def _check_universe(universe: MDAnalysis.Universe) -> None:
    """Warnings are errors here, so that there is none is tested along the way."""
    assert len(universe.trajectory) == 5
    for step, i in zip(universe.trajectory, ROUNDS, strict=True):
        expected = frame(i)
        assert np.array_equal(step.positions, expected.position.astype("f4"))
        assert np.array_equal(step.velocities, expected.velocity.astype("f4"))
        assert step.data["step"] == i
        assert step.time == pytest.approx(i * TIME_STEP)
        assert step.dt == pytest.approx(10 * TIME_STEP)
        assert step.data["kinetic_energy"] == expected.observables.kinetic_energy
        assert np.array_equal(step.data["momentum"], expected.observables.momentum)
    universe.trajectory.close()
