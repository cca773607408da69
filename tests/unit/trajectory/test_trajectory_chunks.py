"""Chunks of a forged file: their place, size and filters are checked before they are read."""

from __future__ import annotations

from pathlib import Path

import h5py
import pytest
from sample_run import header, record

from atomsim.errors import InputError
from atomsim.trajectory import Trajectory

POSITION = "particles/trajectory/position/value"


def forged(path: Path, name: str, number: int) -> None:
    """Change a number of the only entry in the index of chunks: size, 4 bytes; filters, 4; place, 32; address, 8."""
    with h5py.File(path, "r") as file:
        info = file[POSITION].id.get_chunk_info(0)
    data = path.read_bytes()
    fields = {"size": info.size.to_bytes(4, "little"), "filters": bytes(4), "place": bytes(32)}
    fields["address"] = info.byte_offset.to_bytes(8, "little")
    entry = b"".join(fields.values())
    assert data.count(entry) == 1
    fields[name] = number.to_bytes(len(fields[name]), "little")
    path.write_bytes(data.replace(entry, b"".join(fields.values())))


@pytest.mark.parametrize("n_missing", [1, 840])
def test_a_chunk_beyond_the_end_of_the_file(tmp_path: Path, n_missing: int) -> None:
    """By one byte or altogether; 5 frames of 7 atoms are 840 bytes."""
    path = record(tmp_path / "out.h5", header(40))
    forged(path, "address", path.stat().st_size - 840 + n_missing)
    with Trajectory(path) as trajectory, pytest.raises(InputError) as caught:
        trajectory.verify()
    assert str(caught.value) == f"{path}: damaged: a part of `{POSITION}` is missing"


def test_a_chunk_that_ends_with_the_file_is_read(tmp_path: Path) -> None:
    path = record(tmp_path / "out.h5", header(40))
    with h5py.File(path, "r") as file:
        chunk = file[POSITION].id.get_chunk_info(0)
    size = path.stat().st_size
    forged(path, "address", size)
    data = path.read_bytes()
    assert data[40:48] == size.to_bytes(8, "little")  # where HDF5 thinks that the file ends
    end = (size + chunk.size).to_bytes(8, "little")
    path.write_bytes(data[:40] + end + data[48:] + data[chunk.byte_offset : chunk.byte_offset + chunk.size])
    with Trajectory(path) as trajectory:
        trajectory.verify()


@pytest.mark.parametrize(
    ("name", "number", "message"),
    [
        ("filters", 1, f"damaged: a part of `{POSITION}` is missing"),  # one of them was left out
        ("size", 700, f"damaged: a part of `{POSITION}` has the wrong size"),
    ],
)
def test_a_packed_chunk_that_is_not_whole(tmp_path: Path, name: str, number: int, message: str) -> None:
    path = record(tmp_path / "out.h5", header(40, compress=True))
    forged(path, name, number)
    with Trajectory(path) as trajectory, pytest.raises(InputError) as caught:
        trajectory.verify()
    assert str(caught.value) == f"{path}: {message}"
