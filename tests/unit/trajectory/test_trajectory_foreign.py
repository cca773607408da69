"""Files of other programs: each is called what it is, with what can read it, and none of them is ever replaced."""

from __future__ import annotations

import gzip
import pickle
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import MDAnalysis
import numpy as np
import pytest
from sample_run import digest_of, header, holds, killed, record

from atomsim.cli.remedies import with_remedies
from atomsim.errors import InputError
from atomsim.trajectory import Recorder, Trajectory, journal_path

TRAJECTORIES = "MDAnalysis, VMD or OVITO"


def by_mdanalysis(path: Path) -> None:
    """Write two frames of three atoms, in the format that the extension says."""
    universe = MDAnalysis.Universe.empty(3, trajectory=True)
    universe.add_TopologyAttr("names", ["C"] * 3)
    universe.dimensions = [10, 10, 10, 90, 90, 90]
    options = {"velocities": False, "forces": False, "convert_units": False} if path.suffix == ".h5md" else {}
    with warnings.catch_warnings(), MDAnalysis.Writer(str(path), 3, **options) as writer:
        warnings.simplefilter("ignore")
        for _ in range(2):
            writer.write(universe.atoms)


def hdf5(fill: Callable[[h5py.File], object]) -> Callable[[Path], None]:
    """Return what writes an HDF5 file and fills it."""

    def write(path: Path) -> None:
        with h5py.File(path, "w") as file:
            fill(file)

    return write


def h5md(**creator: object) -> Callable[[Path], None]:
    return hdf5(lambda file: file.create_group("h5md/creator").attrs.update(creator))


def with_bytes(content: bytes) -> Callable[[Path], None]:
    return lambda path: path.write_bytes(content) and None


FILES: dict[str, tuple[Callable[[Path], None], str, str]] = {
    "a.h5md": (
        by_mdanalysis,
        f"an H5MD file written by MDAnalysis {MDAnalysis.__version__}",
        "MDAnalysis, VMD or h5py",
    ),
    "fixed.h5": (
        h5md(name=np.bytes_("espresso"), version=b"4"),
        "an H5MD file written by espresso 4",
        "MDAnalysis, VMD",
    ),
    "list.h5": (h5md(name=["lammps"]), "an H5MD file written by lammps", "MDAnalysis, VMD or h5py"),
    "long.h5": (h5md(name="x" * 500), f"an H5MD file written by {'x' * 60}", "MDAnalysis, VMD or h5py"),
    "mdtraj.h5": (hdf5(lambda file: file.attrs.update(program="MDTraj")), "an HDF5 trajectory of MDTraj", "MDTraj"),
    "a.nc": (hdf5(lambda file: file.attrs.update(_NCProperties="version=2")), "a netCDF-4 file", "xarray"),
    "plain.h5": (hdf5(lambda file: file.create_dataset("x", data=[1.0])), "an HDF5 file of another program", "h5py"),
    "empty.h5": (hdf5(lambda file: None), "an HDF5 file of another program", "h5py"),
    "a.dcd": (by_mdanalysis, "a DCD trajectory", TRAJECTORIES),
    "a.xtc": (by_mdanalysis, "an XTC trajectory of GROMACS", TRAJECTORIES),
    "a.trr": (by_mdanalysis, "a TRR trajectory of GROMACS", TRAJECTORIES),
    "a.xyz": (by_mdanalysis, "an XYZ file", "OVITO, VMD or ASE"),
    "a.pdb": (by_mdanalysis, "a PDB file", TRAJECTORIES),
    "a.ncdf": (with_bytes(b"CDF\x02\0\0\0\0"), "a netCDF file", "xarray, or MDAnalysis if it is one of AMBER"),
    "a.gsd": (with_bytes(b"\xdfe\xdfe\xdfe\xdfe" + bytes(200)), "a GSD file of HOOMD-blue", "gsd, MDAnalysis or OVITO"),
    "a.lammpstrj": (with_bytes(b"ITEM: TIMESTEP\n0\n"), "a dump of LAMMPS", "OVITO or MDAnalysis"),
    "a.npy": (lambda path: np.save(path, np.zeros(3)), "an array of NumPy", "numpy.load"),
    "a.npz": (lambda path: np.savez(path, x=np.zeros(3)), "a zip archive", "unzip, or numpy.load if it holds arrays"),
    "a.zip": (
        lambda path: zipfile.ZipFile(path, "w").writestr("a", "b"),
        "a zip archive",
        "unzip, or numpy.load if it holds arrays",
    ),
    "out.h5.gz": (with_bytes(gzip.compress(b"x")), "compressed with gzip", "gunzip"),
    "a.pkl": (with_bytes(pickle.dumps([1])), "a pickle of Python", "the program that wrote it"),
    "a.png": (with_bytes(b"\x89PNG\r\n\x1a\n"), "a picture or a page", "a viewer"),
    "lfs.h5": (
        with_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"),
        "a pointer of Git LFS",
        "git lfs pull, which puts the file itself in its place",
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_file_of_another_program_is_called_what_it_is(tmp_path: Path, name: str) -> None:
    write, kind, readers = FILES[name]
    path = tmp_path / name
    write(path)
    with pytest.raises(InputError) as caught:
        Trajectory(path)
    assert str(caught.value).startswith(f"{path}: is {kind}, not a trajectory of atomsim; read it with {readers}")


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("suffix", ["", ".part"])
def test_a_file_of_another_program_is_never_replaced(tmp_path: Path, name: str, suffix: str) -> None:
    """HDF5 that is not ours is no trajectory that may go."""
    taken = tmp_path / f"out.h5{suffix}"
    FILES[name][0](tmp_path / name)
    (tmp_path / name).rename(taken)
    before = digest_of(taken)
    with pytest.raises(InputError) as caught:
        Recorder.begin(tmp_path / "out.h5", header(), replace=True)
    assert str(caught.value) == f"{taken} exists and is no trajectory"
    assert digest_of(taken) == before


@pytest.mark.parametrize(
    "text",
    [
        "atomsim: 1\n",
        "\ufeff# rods\n\ntitle: Rods\natomsim: 1\n",
        '{"title": "x", "atomsim": 1}',
        "extends: a.yaml\natomsim: 1",
    ],
)
def test_a_scene_is_called_one(tmp_path: Path, text: str) -> None:
    path = tmp_path / "rods.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        Trajectory(path)
    assert with_remedies(caught.value) == (
        f"{path}: is a scene, not a trajectory of atomsim; to run it: atomsim run {path}"
    )


@pytest.mark.parametrize(
    ("content", "message"), [(b"", "is empty, not a trajectory of atomsim"), (b"?", "not a trajectory of atomsim")]
)
def test_what_nobody_knows(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "out.h5"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        Trajectory(path)
    assert str(caught.value) == f"{path}: {message}"


def test_damage_does_not_make_a_file_of_ours_another_programs(tmp_path: Path) -> None:
    """It may be replaced, and is called damaged."""
    path = record(tmp_path / "out.h5", header())
    with h5py.File(path, "r+") as file:
        del file["parameters"]
    with pytest.raises(InputError, match=r"damaged, or not a trajectory of atomsim \(`parameters/atomsim/schema_ver"):
        Trajectory(path)
    path.write_bytes(path.read_bytes()[:5_000])
    with pytest.raises(InputError, match="damaged: the end of the file is missing"):
        Trajectory(path)
    record(path, header(20), replace=True)
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20])


def test_what_another_program_put_into_another_order_is_still_ours(tmp_path: Path) -> None:
    """As `h5repack` and `h5copy` do."""
    path = record(tmp_path / "out.h5", header())
    other = tmp_path / "other.h5"
    with h5py.File(path) as file, h5py.File(other, "w") as copy:
        copy.create_dataset("filler", data=np.zeros(20_000))
        for name in file:
            file.copy(name, copy)
        del copy["filler"]
    other.replace(path)
    with pytest.raises(InputError, match=r"out\.h5 exists$"):
        Recorder.begin(path, header())


def test_an_author_called_like_us_does_not_make_a_file_ours(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    with h5py.File(path, "w") as file:
        file.create_group("h5md/creator").attrs["name"] = "other"
        file.create_dataset("notes", data=np.bytes_("not by atomsim"))
    killed(tmp_path / "x.h5", header(), 10)
    with pytest.raises(InputError, match=r"is an H5MD file written by other, not a trajectory"):
        Trajectory(path)
    with pytest.raises(InputError, match="exists and is no trajectory"):
        Recorder.begin(path, header(), replace=True)
    assert journal_path(tmp_path / "x.h5").exists()
