"""Additions of other programs to a finished file, and changes in it that no digest tells."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

import h5py
import numpy as np

from atomsim.trajectory.guard import DamageError
from atomsim.trajectory.hdf5 import MEMORY, PARTICLES
from atomsim.trajectory.hdf5.hardening import PlainFile
from atomsim.trajectory.hdf5.write import Contents, without_frames

_MOST = 100
"""More additions are not looked for: a group may hold millions."""

_AUTHOR = "/h5md/author@name"
"""What a user may change, for it goes on with the run, as long as it is a text."""

_IN_DIGESTS = {f"/{PARTICLES}/position/value", f"/{PARTICLES}/velocity/value"}


def additions(file: Any, plain: PlainFile, contents: Contents) -> list[str]:
    """Return the paths of all that `write` would not write: `/analysis/tension`, `/particles/trajectory@temperature`.

    Args:
        file: an HDF5 file of ours, opened for reading.
        plain: the same.
        contents: what is in it.
    """
    with without_frames(contents) as ours:
        return list(islice(_more("", file, ours, plain), _MOST))


def _more(path: str, theirs: Any, ours: Any, plain: PlainFile) -> Iterator[str]:
    for name in theirs.attrs:
        place = f"{path or '/'}@{name}"
        is_kept = place == _AUTHOR and h5py.check_string_dtype(theirs.attrs.get_id(name).dtype) is not None
        if not (is_kept or (name in ours.attrs and _is_same(theirs.attrs, ours.attrs, name))):
            yield place
    if isinstance(ours, h5py.Group):
        for name in theirs:
            place = f"{path}/{name}"
            is_plain = name in ours and isinstance(theirs.get(name, getlink=True), h5py.HardLink)
            if not is_plain or type(theirs[name]) is not type(ours[name]):
                yield place
            else:
                yield from _more(place, theirs[name], ours[name], plain)
    elif path not in _IN_DIGESTS and not path.startswith(f"/{MEMORY}/") and not _holds(plain, path, ours):
        yield path


def _holds(plain: PlainFile, path: str, ours: Any) -> bool:
    """Tell whether a file holds a dataset of ours."""
    is_text = h5py.check_string_dtype(ours.dtype) is not None
    try:
        found = plain.array(path[1:], None if is_text else ours.dtype.str, ours.shape)
    except DamageError:
        return False
    return bool(np.array_equal(found, ours[()]))


def _is_same(theirs: Any, ours: Any, name: str) -> bool:
    """Tell whether an attribute has the value that we gave it; references lead to other places in other files."""
    expected, found = ours.get_id(name), theirs.get_id(name)
    if found.dtype != expected.dtype or found.shape != expected.shape:
        return False
    return h5py.check_ref_dtype(found.dtype) is not None or bool(np.array_equal(theirs[name], ours[name]))
