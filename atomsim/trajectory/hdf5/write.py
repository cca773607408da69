"""The writer of the finished HDF5 file, in the layout of H5MD 1.1.

The bytes depend on the frames alone, not on how the journal groups them or how often the run was stopped.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Protocol, TypeAlias

import h5py
import numpy as np

from atomsim.trajectory.hdf5 import MEMORY, NUMBERS, PARAMETERS, PARTICLES, chunk_rows
from atomsim.trajectory.hdf5.sink import Sink
from atomsim.trajectory.header import End, Header, contents_digest, document, fields, storable
from atomsim.trajectory.interrupts import postponed
from atomsim.trajectory.journal.read import Journal
from atomsim.trajectory.rows import OBSERVABLES, Rows, Series

UNITS = {"time": "ps", "position": "Angstrom", "velocity": "Angstrom ps-1"}
"""Labels that readers of H5MD demand."""

UNIT_NOTE = (
    "placeholder labels of reduced units: a length of 1 is the radius of an atom, velocities are per unit of time"
)

Group: TypeAlias = Any  # h5py has no types
Dataset: TypeAlias = Any

Report: TypeAlias = Callable[[int, int], object]
"""Called with the number of frames written and that of all frames."""


class Contents(Protocol):
    """What a trajectory says besides its frames, and what is known of each frame besides its atoms."""

    header: Header
    series: Series
    end: End


def write(journal: Journal, path: Path, report: Report | None = None) -> None:
    """Write everything that is in a journal to a new HDF5 file, and see that it is on the disk.

    Args:
        journal: the frames and what belongs to them.
        path: the file, which is not there yet.
        report: hears how many frames of how many are written.

    Raises:
        OSError: the disk does not take it.
    """
    with Sink(path) as sink, postponed() as let_interrupts_through:

        def between_pieces(n_written: int) -> None:
            sink.check()
            let_interrupts_through()
            if report is not None:
                report(n_written, len(journal.series))

        def pieces() -> Iterator[tuple[int, Rows]]:
            rows = chunk_rows(len(journal.series), journal.header.n_atoms)
            for start in range(0, len(journal.series), rows):
                stop = min(start + rows, len(journal.series))
                yield start, journal.rows(start, stop)
                between_pieces(stop)

        # Everything that could make two identical runs differ is switched off: times are not tracked, and the oldest
        # and newest form of the format that may be chosen are fixed.
        with h5py.File(sink, "w", libver=("earliest", "v110")) as file:
            _write(file, journal, pieces())
        sink.sync()


def without_frames(contents: Contents) -> Any:
    """Return an HDF5 file in memory as `write` would make it, but for what is known of the atoms in each frame."""
    file = h5py.File("memory", "w", libver=("earliest", "v110"), driver="core", backing_store=False)
    _write(file, contents, ())
    return file


def _write(file: Group, contents: Contents, pieces: Iterable[tuple[int, Rows]]) -> None:
    _write_identity(file, contents.header)
    _write_frames(file, contents, pieces)
    _write_observables(file, contents)
    _write_bonds(file, contents.header)
    _write_parameters(file.require_group(PARAMETERS), contents)


def _write_identity(file: Group, header: Header) -> None:
    h5md = file.create_group("h5md")
    h5md.attrs["version"] = np.array([1, 1], "<i4")
    author = np.bytes_(header.author) if header.author.isascii() else _texts(header.author)
    h5md.create_group("author").attrs["name"] = author
    creator = h5md.create_group("creator")
    creator.attrs["name"] = np.bytes_("atomsim")
    creator.attrs["version"] = np.bytes_(header.program_version)


def _write_frames(file: Group, contents: Contents, pieces: Iterable[tuple[int, Rows]]) -> None:
    header, series = contents.header, contents.series
    atoms = file.create_group(PARTICLES)
    atoms.attrs["unit_note"] = np.bytes_(UNIT_NOTE)
    box = atoms.create_group("box")
    box.attrs["dimension"] = np.int32(3)
    box.attrs["boundary"] = np.array([b"none"] * 3)
    position, velocity = atoms.create_group("position"), atoms.create_group("velocity")
    position["step"] = series["round"]
    position["time"] = series["round"] * header.time_step
    position["time"].attrs["unit"] = UNITS["time"]
    _share_time(file, velocity)
    rows = chunk_rows(len(series), header.n_atoms)
    values = {name: _create_value(atoms[name], name, contents, rows) for name in ("position", "velocity")}
    memory = {
        array.name: file.create_dataset(
            f"{MEMORY}/{array.name}", (len(series), *array.shape), array.dtype, track_times=False
        )
        for array in header.layout
    }
    for start, piece in pieces:
        for name, value in values.items():
            value[start : start + len(piece)] = piece[name]
        for name, value in memory.items():
            value[start : start + len(piece)] = piece["memory"][name]
    species = [np.full(group.stop - group.start, i, "<i4") for i, group in enumerate(header.groups)]
    atoms["mass"] = np.ones(header.n_atoms)
    atoms["species"] = np.concatenate(species)


def _create_value(group: Group, name: str, contents: Contents, rows: int) -> Dataset:
    n_atoms = contents.header.n_atoms
    filters = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if contents.header.compress else {}
    shape, chunks = (len(contents.series), n_atoms, 3), (rows, n_atoms, 3)
    value = group.create_dataset("value", shape, "<f8", chunks=chunks, track_times=False, **filters)
    value.attrs["unit"] = UNITS[name]
    return value


def _share_time(file: Group, group: Group) -> None:
    """Every series has the times of the positions; hard links say so at no cost."""
    for name in ("step", "time"):
        group[name] = file[f"{PARTICLES}/position/{name}"]


def _write_observables(file: Group, contents: Contents) -> None:
    series, header = contents.series, contents.header
    columns = {name: series[name] for name in OBSERVABLES}
    # Asked for the time between two frames, MDAnalysis takes this one before it guesses.
    columns["dt"] = np.full(len(series), header.record_every * header.time_step)
    for name, column in columns.items():
        group = file.create_group(f"observables/{name}")
        group["value"] = column
        _share_time(file, group)


def _write_bonds(file: Group, header: Header) -> None:
    bond = header.bond
    file["connectivity/bonds"] = bond
    file["connectivity/bonds"].attrs["particles_group"] = file[PARTICLES].ref
    # VMD counts atoms from 1.
    file["parameters/vmd_structure/bond_from"] = bond[:, 0] + np.int32(1)
    file["parameters/vmd_structure/bond_to"] = bond[:, 1] + np.int32(1)


def _write_parameters(group: Group, contents: Contents) -> None:
    header, end = contents.header, contents.end
    values = document(header)
    for name, kind in fields(values["schema_version"]).items():
        group[name] = _texts(values[name]) if kind in ("text", "texts") else np.array(values[name], NUMBERS[kind])
    group["scene_sha256"] = _texts(hashlib.sha256(values["scene"].encode()).hexdigest())
    group["bond_table"] = header.bond_table
    group["state_sha256"] = contents.series["digest"]
    group["end"] = _texts(end.kind)
    group["end_report"] = _texts(storable(end.report))
    group["contents_sha256"] = _texts(contents_digest(header, end, contents.series))


def _texts(value: str | list[str]) -> np.ndarray[Any, Any]:
    """Return one text or several as UTF-8 of fixed length: texts of varying length would live in a heap of the file."""
    encoded = [text.encode() for text in ([value] if isinstance(value, str) else value)]
    longest = max((len(text) for text in encoded), default=0)
    array = np.array(encoded, h5py.string_dtype("utf-8", max(1, longest)))
    return array.reshape(()) if isinstance(value, str) else array
