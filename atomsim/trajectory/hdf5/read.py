"""The reader of a finished HDF5 file."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from atomsim.core.memory import Memory
from atomsim.core.model import State
from atomsim.trajectory.guard import DamageError, check_room, odd
from atomsim.trajectory.hdf5 import MEMORY, NUMBERS, PARAMETERS, PARTICLES, chunk_rows
from atomsim.trajectory.hdf5.foreign import require_ours, short_text
from atomsim.trajectory.hdf5.hardening import PlainFile
from atomsim.trajectory.header import Header, Kind, check_version, contents_digest, end_from, fields, header_from
from atomsim.trajectory.rows import OBSERVABLES, SERIES, Series, check_rounds, state_of


class Finished:
    """What is in a finished file.

    Attributes:
        header: what it says besides its frames.
        series: what is known of each frame besides its atoms.
        end: how the run ended.
    """

    def __init__(self, path: Path) -> None:
        """Open the file, read and check all but positions and velocities.

        Raises:
            Exception: of nearly any kind, when it is damaged; see `guard.reading`.
        """
        self._file = _opened(path)
        try:
            require_ours(self._file)
            self._plain = PlainFile(self._file, path.stat().st_size)
            self._read(self._plain)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def state(self, index: int) -> State:
        """Return the state of a frame, checked against its digest."""
        memory = Memory({name: values[index] for name, values in self._memory.items()})
        return state_of(self.series[index], self._position.row(index), self._velocity.row(index), memory)

    def additions(self) -> list[str]:
        """Return the paths of what another program has added to the file, or changed where no digest tells."""
        # Deferred because only going on with a run has to know.
        from atomsim.trajectory.hdf5.additions import additions

        return additions(self._file, self._plain, self)

    def _read(self, file: PlainFile) -> None:
        self.header = replace(_header(file), author=short_text(self._file, "h5md/author", "name") or "unknown")
        self.end = end_from({name: file.text(f"{PARAMETERS}/{name}") for name in ("end", "end_report")})
        self.series = _series(file, self.header.time_step)
        if file.text(f"{PARAMETERS}/contents_sha256") != contents_digest(self.header, self.end, self.series):
            raise DamageError("damaged: its contents do not match their digest")
        n_frames, n_atoms = len(self.series), self.header.n_atoms
        rows = chunk_rows(n_frames, n_atoms)
        shape = (n_frames, n_atoms, 3)
        self._position = file.chunks(f"{PARTICLES}/position/value", shape, rows)
        self._velocity = file.chunks(f"{PARTICLES}/velocity/value", shape, rows)
        self._memory = {
            array.name: file.in_one_run(f"{MEMORY}/{array.name}", array.dtype.str, (n_frames, *array.shape))
            for array in self.header.layout
        }
        check_room(sum(array.n_bytes for array in self.header.layout))
        if not self._position.compressed == self._velocity.compressed == self.header.compress:
            raise odd("it is compressed in another way")


def has_ours(path: Path) -> bool | None:
    """Tell whether an HDF5 file has anything of ours in it; None if it is too damaged to tell."""
    try:
        with _opened(path) as file:
            require_ours(file)
    except DamageError:
        return False
    except Exception:  # HDF5 answers damage with nearly every kind
        return None
    return True


def _opened(path: Path) -> Any:
    """Open a file for reading.

    HDF5's own locks fail on some network file systems, and nobody writes a finished file, so none is wanted. But a file
    that is open elsewhere in this process (h5py, MDAnalysis) opens only with the locks that it was opened with there.
    """
    for locking in (False, "best-effort"):
        try:
            return h5py.File(path, "r", locking=locking)
        except OSError as error:
            if "flag values don't match" not in str(error):
                raise
    return h5py.File(path, "r", locking=True)


def _header(file: PlainFile) -> Header:
    values = {"schema_version": _value(file, "schema_version", "whole")}
    check_version(values)
    values = {name: _value(file, name, kind) for name, kind in fields(values["schema_version"]).items()}
    if file.text(f"{PARAMETERS}/scene_sha256") != hashlib.sha256(values["scene"].encode()).hexdigest():
        raise DamageError("damaged: its scene does not match its digest")
    bond = file.array("connectivity/bonds", "<i4", (None, 2))
    return header_from(values, bond, file.array(f"{PARAMETERS}/bond_table", "<i4", (None,)))


def _value(file: PlainFile, name: str, kind: Kind) -> Any:
    path = f"{PARAMETERS}/{name}"
    if kind == "text":
        return file.text(path)
    if kind == "texts":
        return file.texts(path)
    return file.array(path, NUMBERS[kind], (None,) if kind == "wholes" else ()).tolist()


def _series(file: PlainFile, time_step: float) -> Series:
    rounds = file.array(f"{PARTICLES}/position/step", "<i8", (None,))
    n_frames = len(rounds)
    if n_frames == 0:
        raise odd("it holds no frame")
    check_room(n_frames * SERIES.itemsize)
    series = np.empty(n_frames, SERIES)
    series["round"] = rounds
    series["digest"] = file.array(f"{PARAMETERS}/state_sha256", "S64", (n_frames,))
    for name in OBSERVABLES:
        column = SERIES[name]
        series[name] = file.array(f"observables/{name}/value", column.base.str, (n_frames, *column.shape))
    check_rounds(series)
    if np.any(file.array(f"{PARTICLES}/position/time", "<f8", (n_frames,)) != rounds * time_step):
        raise DamageError("damaged: the times of its frames are not those of its rounds")
    return series
