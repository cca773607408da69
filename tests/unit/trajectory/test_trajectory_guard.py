"""Files that strangers send: whatever is in them, they end in the right frames or in one line."""

from __future__ import annotations

import json
import os
import random
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from sample_run import digest_of, frame, header, holds, killed, record

from atomsim.errors import InputError
from atomsim.trajectory import End, Trajectory, guard
from atomsim.trajectory.journal.form import BONDS, FRAMES, GO_ON, HEAD, PREFIX, checksum_start
from atomsim.trajectory.rows import row_dtype

ROUNDS = [0, 10, 20, 30, 40]
N_MUTATIONS = 20_000 if os.environ.get("ATOMSIM_LONG") else 150
POSITION = "particles/trajectory/position/value"


def mutated(data: bytes, seed: int) -> bytes:
    """Cut a file short, flip bits in it, overwrite a range, or copy one range over another."""
    dice = random.Random(seed)
    changed = bytearray(data)
    here, there, length = dice.randrange(len(data)), dice.randrange(len(data)), dice.choice([1, 4, 8, 64, 512])
    length = min(length, len(data) - max(here, there))
    match dice.randrange(4):
        case 0:
            del changed[here:]
        case 1:
            for _ in range(dice.choice([1, 1, 2, 8, 64])):
                changed[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        case 2:
            changed[here : here + length] = dice.choice([dice.randbytes(length), b"\0" * length, b"\xff" * length])
        case 3:
            changed[here : here + length] = data[there : there + length]
    return bytes(changed)


@pytest.mark.parametrize("kind", ["plain", "compressed", "journal"])
def test_a_mutated_file_gives_the_right_frames_or_one_line(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "out.h5"
    if kind == "journal":
        source = killed(path, header(40), stop_after=40)
    else:
        source = record(path, header(40, compress=kind == "compressed"))
    data = source.read_bytes()
    n_refused = 0
    for seed in range(N_MUTATIONS):
        source.write_bytes(mutated(data, seed))
        try:
            with Trajectory(path) as trajectory:
                kept = ROUNDS[: len(trajectory)] if kind == "journal" else ROUNDS
                assert holds(trajectory, kept), seed
        except InputError as error:
            n_refused += 1
            _check_one_line(error, source)
    assert N_MUTATIONS // 10 < n_refused < N_MUTATIONS


def _check_one_line(error: InputError, path: Path) -> None:
    text = str(error)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    assert len(text) < len(str(path)) + 350


# --- Files made to do damage ---


def put(name: str, **dataset: Any) -> Callable[[h5py.File], None]:
    """Return an act that puts another dataset in the place of one."""

    def act(file: h5py.File) -> None:
        del file[name]
        file.create_dataset(name, **dataset)

    return act


def link(name: str, to: Any) -> Callable[[h5py.File], None]:
    """Return an act that puts a link in the place of a dataset."""

    def act(file: h5py.File) -> None:
        del file[name]
        file[name] = to

    return act


def become_virtual(file: h5py.File) -> None:
    layout = h5py.VirtualLayout((5, 7, 3), "<f8")
    layout[:] = h5py.VirtualSource("other.h5", POSITION, (5, 7, 3))
    del file[POSITION]
    file.create_virtual_dataset(POSITION, layout)


def write_value(name: str, value: Any) -> Callable[[h5py.File], None]:
    """Return an act that changes what is in a dataset, and leaves its form."""

    def act(file: h5py.File) -> None:
        file[name][...] = value

    return act


def keep_only_text(file: h5py.File) -> None:
    for name in list(file):
        del file[name]


HOSTILE: dict[str, tuple[Callable[[h5py.File], None], str]] = {
    "soft link": (
        link("connectivity/bonds", h5py.SoftLink("/parameters/atomsim/bond_table")),
        "damaged, or not a trajectory of atomsim (`connectivity/bonds` is a link that leads elsewhere)",
    ),
    "external link": (
        link("particles", h5py.ExternalLink("other.h5", "/particles")),
        "damaged, or not a trajectory of atomsim (`particles/trajectory/position/step` is a link that leads elsewhere)",
    ),
    "dangling link": (
        link("observables/contacts/value", h5py.SoftLink("/nowhere")),
        "damaged, or not a trajectory of atomsim (`observables/contacts/value` is a link that leads elsewhere)",
    ),
    "external dataset": (
        put(
            "parameters/atomsim/rule_lines",
            shape=(4,),
            dtype="<i8",
            external=[("/etc/passwd", 0, 32)],
        ),
        "damaged, or not a trajectory of atomsim (`parameters/atomsim/rule_lines` is kept in another file)",
    ),
    "virtual dataset": (
        become_virtual,
        f"damaged, or not a trajectory of atomsim (`{POSITION}` is kept in another file)",
    ),
    "group for a dataset": (
        lambda file: (file.__delitem__("connectivity/bonds"), file.create_group("connectivity/bonds"))[0],
        "damaged, or not a trajectory of atomsim (`connectivity/bonds` is not a dataset)",
    ),
    "text of varying length": (
        put("parameters/atomsim/title", data="a title"),
        "damaged, or not a trajectory of atomsim (`parameters/atomsim/title` has another type)",
    ),
    "claims 192 TiB": (
        put("particles/trajectory/position/step", shape=(1 << 44,), dtype="<i8"),
        "damaged, or not a trajectory of atomsim (`particles/trajectory/position/step` is stored in another way)",
    ),
    "another shape": (
        put(POSITION, shape=(5, 1 << 40, 3), dtype="<f8", chunks=(1, 1 << 10, 3)),
        f"damaged, or not a trajectory of atomsim (`{POSITION}` has another shape)",
    ),
    "other chunks": (
        put(POSITION, shape=(5, 7, 3), dtype="<f8", chunks=(1, 7, 3)),
        f"damaged, or not a trajectory of atomsim (`{POSITION}` is cut into other chunks)",
    ),
    "no chunks": (
        put(POSITION, data=np.zeros((5, 7, 3))),
        f"damaged, or not a trajectory of atomsim (`{POSITION}` is cut into other chunks)",
    ),
    "chunks never written": (
        put(POSITION, shape=(5, 7, 3), dtype="<f8", chunks=(5, 7, 3)),
        f"damaged: a part of `{POSITION}` is missing",
    ),
    "another filter": (
        put(POSITION, data=np.zeros((5, 7, 3)), chunks=(5, 7, 3), compression="lzf"),
        f"damaged, or not a trajectory of atomsim (`{POSITION}` is compressed in another way)",
    ),
    "compressed where it says it is not": (
        put(POSITION, data=np.zeros((5, 7, 3)), chunks=(5, 7, 3), compression="gzip", shuffle=True),
        "damaged, or not a trajectory of atomsim (it is compressed in another way)",
    ),
    "another number in a frame": (
        write_value(POSITION, 0.0),
        "damaged: the state at round 0 does not match its digest",
    ),
    "another observable": (
        write_value("observables/kinetic_energy/value", 1.0),
        "damaged: its contents do not match their digest",
    ),
    "another title": (
        write_value("parameters/atomsim/title", b"Another"),
        "damaged: its contents do not match their digest",
    ),
    "another scene": (
        write_value("parameters/atomsim/scene", b"atomsim: 1"),
        "damaged: its scene does not match its digest",
    ),
    "rounds that go back": (
        write_value("particles/trajectory/position/step", [0, 10, 20, 20, 40]),
        "damaged: the rounds of its frames do not increase",
    ),
    "other times": (
        write_value("particles/trajectory/position/time", 0.0),
        "damaged: the times of its frames are not those of its rounds",
    ),
    "a later version": (
        write_value("parameters/atomsim/schema_version", 3),
        "written in version 3 of the trajectory file; this atomsim reads version 2: a newer atomsim is needed",
    ),
    "nothing of ours": (
        keep_only_text,
        "is an HDF5 file of another program, not a trajectory of atomsim; read it with h5py",
    ),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused_with_its_reason(tmp_path: Path, name: str) -> None:
    act, message = HOSTILE[name]
    path = record(tmp_path / "out.h5", header(40))
    record(tmp_path / "other.h5", header(40))
    with h5py.File(path, "r+") as file:
        act(file)
    with pytest.raises(InputError) as caught, Trajectory(path) as trajectory:
        trajectory.verify()
    assert str(caught.value) == f"{path}: {message}"


def test_a_bomb_is_not_unpacked(tmp_path: Path) -> None:
    """A chunk that unpacks to a thousand times what its shape says is not followed to its end."""
    path = record(tmp_path / "out.h5", header(40, compress=True))
    packer = zlib.compressobj()
    bomb = packer.compress(bytes(1 << 20)) + packer.flush()
    with h5py.File(path, "r+") as file:
        file[POSITION].id.write_direct_chunk((0, 0, 0), bomb)
    with Trajectory(path) as trajectory, pytest.raises(InputError, match="does not match its digest"):
        trajectory.verify()


def test_a_dataset_larger_than_the_file_is_not_read(tmp_path: Path) -> None:
    """HDF5 reserves room for a dataset that nobody has written."""
    path = record(tmp_path / "out.h5", header(40))
    name = "parameters/atomsim/scene"
    with h5py.File(path, "r+") as file:
        del file[name]
        create = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        create.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
        create.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
        text = h5py.h5t.C_S1.copy()
        text.set_size(1 << 30)
        h5py.h5d.create(file.id, name.encode(), text, h5py.h5s.create(h5py.h5s.SCALAR), dcpl=create)
    size = path.stat().st_size
    os.truncate(path, min(size, 1 << 20))
    with pytest.raises(InputError) as caught:
        Trajectory(path)
    _check_one_line(caught.value, path)


def test_more_than_the_free_memory_is_not_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = record(tmp_path / "out.h5", header(40))
    monkeypatch.setattr(guard, "free_memory", lambda: 100)
    with pytest.raises(InputError) as caught:
        Trajectory(path)
    assert str(caught.value) == f"{path}: needs more memory than there is"


def test_free_memory_is_a_sensible_number() -> None:
    assert 1 << 20 < guard.free_memory() < 1 << 50


# --- Journals made to do damage: their checksums are right ---


def journal_of(*records: tuple[bytes, bytes]) -> bytes:
    """Return a journal of records whose checksums are right."""
    prefixes = (
        PREFIX.pack(kind, len(data), zlib.crc32(data, checksum_start(kind, len(data)))) for kind, data in records
    )
    return b"".join(prefix + data for prefix, (_, data) in zip(prefixes, records, strict=True))


@pytest.mark.parametrize(
    ("records", "message"),
    [
        ([(HEAD, b"{}")], "damaged, or not a trajectory of atomsim (`schema_version` makes no sense)"),
        ([(HEAD, b"[]")], "damaged: its header is not a mapping"),
        ([(HEAD, b"[" * 100_000)], "damaged, or not a trajectory of atomsim"),
        ([(HEAD, b"\xff")], "damaged, or not a trajectory of atomsim"),
        ([(HEAD, b'{"schema_version": 1}')], "damaged: its header is not whole"),
        ([(HEAD, b'{"schema_version": 1}'), (BONDS, b"12345")], "damaged, or not a trajectory of atomsim"),
        ([(HEAD, b'{"schema_version": 9}')], "written in version 9 of the trajectory file; "),
    ],
)
def test_a_forged_journal_is_refused(tmp_path: Path, records: list[tuple[bytes, bytes]], message: str) -> None:
    path = tmp_path / "out.h5.part"
    path.write_bytes(journal_of(*records))
    with pytest.raises(InputError) as caught:
        Trajectory(path)
    assert str(caught.value).startswith(f"{path}: {message}")
    _check_one_line(caught.value, path)


def test_a_forged_frame_is_found_by_its_digest(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    journal = killed(path, header(40), stop_after=0)
    row = np.zeros(1, row_dtype(7))
    row["series"]["round"] = 10
    row["series"]["digest"] = frame(10).digest
    with journal.open("ab") as file:
        file.write(journal_of((FRAMES, row.tobytes())))
    with Trajectory(path) as trajectory:
        assert len(trajectory) == 2
        with pytest.raises(InputError, match="the state at round 10 does not match its digest"):
            trajectory.verify()


def test_a_journal_whose_rounds_go_back_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    journal = killed(path, header(40), stop_after=0)
    with journal.open("ab") as file:
        file.write(journal_of((FRAMES, np.zeros(1, row_dtype(7)).tobytes())))
    with pytest.raises(InputError, match="the rounds of its frames do not increase"):
        Trajectory(path)


def test_a_record_of_an_unknown_kind_ends_the_journal(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    journal = killed(path, header(40), stop_after=20)
    before = digest_of(journal)
    with journal.open("ab") as file:
        file.write(journal_of((b"atom.xyz", b"")))
    assert digest_of(journal) != before
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20])
        assert trajectory.end == End("killed")
        assert trajectory.lost_bytes == PREFIX.size


def test_a_block_without_frames_is_damage_in_a_journal(tmp_path: Path) -> None:
    """Nobody writes one; what follows it is not believed."""
    path = tmp_path / "out.h5"
    journal = killed(path, header(40), stop_after=20)
    more = json.dumps({"rounds": 35}).encode()
    empty = PREFIX.pack(FRAMES, 0, checksum_start(FRAMES, 0))
    goes_on = PREFIX.pack(GO_ON, len(more), zlib.crc32(more, checksum_start(GO_ON, len(more)))) + more
    data = journal.read_bytes()
    journal.write_bytes(data + empty + goes_on)
    with Trajectory(path) as trajectory:
        assert (trajectory.header.rounds, trajectory.rounds.tolist()) == (40, [0, 10, 20])
    journal.write_bytes(data + goes_on)
    with Trajectory(path) as trajectory:
        assert trajectory.header.rounds == 35
