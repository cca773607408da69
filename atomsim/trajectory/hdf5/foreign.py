"""HDF5 files that are no trajectories of ours: which program wrote each, and what can read it."""

from __future__ import annotations

from typing import Any

import h5py
import numpy as np

from atomsim.trajectory.guard import DamageError

_LONGEST_NAME = 60
_MOST_BYTES = 1000

_MARKS: tuple[tuple[str, str, str], ...] = (
    ("_NCProperties", "a netCDF-4 file", "xarray"),
    ("PYTABLES_FORMAT_VERSION", "a file of PyTables or pandas", "pandas.read_hdf or PyTables"),
    ("NX_class", "a NeXus file", "h5py"),
    ("NeXus_version", "a NeXus file", "h5py"),
)
"""Attributes of the root that a kind of file has, what it is then, and what reads it."""


def require_ours(file: Any) -> None:
    """Refuse a file in which there is nothing of ours.

    Args:
        file: an HDF5 file opened for reading.

    Raises:
        DamageError: the message says what it is, and what can read it.
    """
    if "parameters" in file and isinstance(file.get("parameters"), h5py.Group) and "atomsim" in file["parameters"]:
        return
    creator = short_text(file, "h5md/creator", "name")
    if creator == "atomsim":
        return  # it is one, and damaged
    if creator is not None:
        version = short_text(file, "h5md/creator", "version") or ""
        by = " ".join(f"{creator[:_LONGEST_NAME]} {version[:_LONGEST_NAME]}".split())
        raise _other(f"an H5MD file written by {by}", "MDAnalysis, VMD or h5py")
    if short_text(file, "", "program") == "MDTraj":
        raise _other("an HDF5 trajectory of MDTraj", "MDTraj")
    for mark, kind, readers in _MARKS:
        if mark in file.attrs:
            raise _other(kind, readers)
    raise _other("an HDF5 file of another program", "h5py")


def _other(kind: str, readers: str) -> DamageError:
    return DamageError(f"is {kind}, not a trajectory of atomsim; read it with {readers}")


def short_text(file: Any, path: str, name: str) -> str | None:
    """Return a text that is an attribute of a group, or its beginning; None if there is none."""
    here = file
    for part in path.split("/") if path else ():
        if not isinstance(here.get(part, getlink=True), h5py.HardLink) or not isinstance(here[part], h5py.Group):
            return None
        here = here[part]
    if name not in here.attrs or here.attrs.get_id(name).get_storage_size() > _MOST_BYTES:
        return None
    value = here.attrs[name]
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.reshape(())[()]
    if isinstance(value, bytes):
        value = value.decode("utf-8", "replace")
    return str(value)[:_MOST_BYTES] if isinstance(value, str) else None
