"""Hardened access to an HDF5 file: named objects are read that are plainly stored in it, and no others.

HDF5 can lead a reader to other files (links, virtual and external datasets), through code loaded for the occasion
(filters), and to a thousand times the memory that the file takes on the disk. What is not plainly stored in this very
file, in the expected form and size, is refused before it is read.
"""

from __future__ import annotations

import zlib
from typing import Any, TypeAlias

import h5py
import numpy as np

from atomsim.trajectory.guard import DamageError, check_room, odd

Dataset: TypeAlias = Any  # h5py has no types
Array: TypeAlias = np.ndarray[Any, Any]

_SHUFFLE_AND_GZIP = (h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_DEFLATE)


class PlainFile:
    """An open HDF5 file of which objects are read by path.

    Args:
        file: opened for reading.
        size: of the file [bytes]; nothing in it can be larger.
    """

    def __init__(self, file: Any, size: int) -> None:
        self._file = file
        self._size = size

    def array(self, path: str, dtype: str | None, shape: tuple[int | None, ...]) -> Array:
        """Return a whole dataset that is stored in one run of bytes.

        Args:
            path: from the root.
            dtype: its exact type; None for text of fixed length.
            shape: the exact shape; None where any length will do.

        Raises:
            DamageError: it is not there, or not that.
            MemoryError: it does not fit.
        """
        dataset = self.in_one_run(path, dtype, shape)
        check_room(dataset.nbytes)
        return np.asarray(dataset[()])

    def in_one_run(self, path: str, dtype: str | None, shape: tuple[int | None, ...]) -> Dataset:
        """Return a dataset that is stored in one run of bytes, not read yet; like `array`."""
        dataset = self._dataset(path)
        _check_form(path, dataset, dtype, shape)
        plan = dataset.id.get_create_plist()
        if plan.get_layout() != h5py.h5d.CONTIGUOUS or dataset.id.get_storage_size() != dataset.nbytes:
            raise odd(f"`{path}` is stored in another way")
        if dataset.nbytes > self._size:
            raise DamageError(f"damaged, or made to do damage (`{path}` claims to be larger than the file)")
        return dataset

    def text(self, path: str) -> str:
        """Return a dataset that is one text; like `array`."""
        return bytes(self.array(path, None, ())[()]).decode()

    def texts(self, path: str) -> list[str]:
        """Return a dataset that is a list of texts; like `array`."""
        return [bytes(text).decode() for text in self.array(path, None, (None,))]

    def chunks(self, path: str, shape: tuple[int, int, int], rows: int) -> Chunks:
        """Return a dataset of float64 that is stored in chunks of so many rows.

        Raises:
            DamageError: it is not there, or not that.
            MemoryError: not even a single chunk fits.
        """
        dataset = self._dataset(path)
        _check_form(path, dataset, "<f8", shape)
        chunk_shape = (rows, *shape[1:])
        if dataset.chunks != chunk_shape:
            raise odd(f"`{path}` is cut into other chunks")
        plan = dataset.id.get_create_plist()
        filters = tuple(plan.get_filter(i)[0] for i in range(plan.get_nfilters()))
        if filters not in ((), _SHUFFLE_AND_GZIP):
            raise odd(f"`{path}` is compressed in another way")
        return Chunks(path, dataset.id, chunk_shape, bool(filters), self._size)

    def _dataset(self, path: str) -> Dataset:
        here = self._file
        for name in path.split("/"):
            if not isinstance(here, h5py.Group) or name not in here:
                raise odd(f"`{path}` is missing")
            if not isinstance(here.get(name, getlink=True), h5py.HardLink):
                raise odd(f"`{path}` is a link that leads elsewhere")
            here = here[name]
        if not isinstance(here, h5py.Dataset):
            raise odd(f"`{path}` is not a dataset")
        # Even the shape of a virtual dataset may be looked up in another file, so this comes before all else.
        plan = here.id.get_create_plist()
        if plan.get_layout() == h5py.h5d.VIRTUAL or plan.get_external_count() > 0:
            raise odd(f"`{path}` is kept in another file")
        return here


def _check_form(path: str, dataset: Dataset, dtype: str | None, shape: tuple[int | None, ...]) -> None:
    if dtype is None:
        text = h5py.check_string_dtype(dataset.dtype)
        has_type = text is not None and text.length is not None
    else:
        has_type = dataset.dtype == np.dtype(dtype)
    if not has_type:
        raise odd(f"`{path}` has another type")
    found = dataset.shape
    if len(found) != len(shape) or any(want not in (None, got) for want, got in zip(shape, found, strict=True)):
        raise odd(f"`{path}` has another shape")


class Chunks:
    """The rows of a chunked dataset, unpacked here rather than by HDF5, which would unpack a bomb to its full size.

    The chunk read last is kept, so that reading in order unpacks each one once.
    """

    def __init__(self, path: str, dataset_id: Any, shape: tuple[int, int, int], compressed: bool, size: int) -> None:
        self._path = path
        self._id = dataset_id
        self._shape = shape
        self._size = size
        self._start = -1
        self._chunk: Array = np.empty(0)
        self.compressed = compressed
        self._n_bytes = 8 * shape[0] * shape[1] * shape[2]
        # At most: the packed bytes, the unpacked ones and their copy in another order.
        check_room(3 * self._n_bytes)

    def row(self, index: int) -> Array:
        """Return a copy of one row, (n_atoms, 3) float64.

        Raises:
            DamageError: the chunk is not there, or not what its size says.
        """
        start = index - index % self._shape[0]
        if start != self._start:
            self._chunk = np.frombuffer(self._unpacked(self._packed(start)), "<f8").reshape(self._shape)
            self._start = start
        row: Array = self._chunk[index - start].copy()
        return row

    def _packed(self, start: int) -> bytes:
        info = self._id.get_chunk_info_by_coord((start, 0, 0))
        if info.byte_offset is None or info.byte_offset + info.size > self._size or info.filter_mask:
            raise DamageError(f"damaged: a part of `{self._path}` is missing")
        return bytes(self._id.read_direct_chunk((start, 0, 0))[1])

    def _unpacked(self, packed: bytes) -> bytes:
        unpacked = packed
        if self.compressed:
            unpacked = zlib.decompressobj().decompress(packed, self._n_bytes)
        if len(unpacked) != self._n_bytes:
            raise DamageError(f"damaged: a part of `{self._path}` has the wrong size")
        return _unshuffled(unpacked) if self.compressed else unpacked


def _unshuffled(data: bytes) -> bytes:
    """Undo the shuffle filter, which puts the first bytes of all numbers first, then the second bytes, and so on."""
    return np.frombuffer(data, "u1").reshape(8, -1).T.tobytes()
