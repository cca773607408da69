"""What users put into a finished file with other programs: going on keeps it, or is refused before it is touched."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from sample_run import digest_of, go_on, header, holds, killed, record, resume

from atomsim.errors import InputError, Remedy
from atomsim.trajectory import StoppedRun, Trajectory


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return record(tmp_path / "out.h5", header(20))


def put(path: str, value: object) -> Callable[[h5py.File], None]:
    """Return what puts a dataset into the place of another, or where none was."""

    def act(file: h5py.File) -> None:
        if path in file:
            del file[path]
        file[path] = value

    return act


def repack(file: h5py.File) -> None:
    del file["particles/trajectory/mass"]
    file.create_dataset("particles/trajectory/mass", data=np.ones(7), compression="gzip")


ADDITIONS: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "a dataset in a group of its own": (put("analysis/tension", [1.0, 2.0, 3.0]), "/analysis"),
    "a series beside ours": (put("observables/tension/value", [1.0, 2.0, 3.0]), "/observables/tension"),
    "a dataset among ours": (put("particles/trajectory/charge", np.zeros(7)), "/particles/trajectory/charge"),
    "a link": (put("latest", h5py.SoftLink("/particles")), "/latest"),
    "an attribute of the file": (lambda file: file.attrs.update(doi="10.1/x"), "/@doi"),
    "an attribute of a group": (lambda file: file["particles/trajectory"].attrs.update(t=1), "/particles/trajectory@t"),
    "an attribute of a dataset": (lambda file: file["connectivity/bonds"].attrs.update(n=2), "/connectivity/bonds@n"),
    "an address": (lambda file: file["h5md/author"].attrs.update(email="a@b.c"), "/h5md/author@email"),
    "other masses": (put("particles/trajectory/mass", np.full(7, 2.0)), "/particles/trajectory/mass"),
    "other units": (
        lambda file: file["particles/trajectory/position/value"].attrs.modify("unit", "nm"),
        "/particles/trajectory/position/value@unit",
    ),
    "a dataset for a group": (put("particles/trajectory/box", [1.0]), "/particles/trajectory/box"),
    "a link for a dataset": (
        put("parameters/vmd_structure/bond_to", h5py.SoftLink("bond_from")),
        "/parameters/vmd_structure/bond_to",
    ),
    "a packed dataset for a plain one": (
        repack,
        "/particles/trajectory/mass",
    ),
    "very many": (
        lambda file: (
            [file.create_group(f"more/{i}") for i in range(3)] and [file.create_group(f"x{i}") for i in range(9)]
        ),
        "/more, /x0, /x1, /x2, /x3 and more",
    ),
}


@pytest.mark.parametrize("name", ADDITIONS)
def test_going_on_does_not_lose_what_was_added(path: Path, name: str) -> None:
    act, place = ADDITIONS[name]
    with h5py.File(path, "r+") as file:
        act(file)
    before = digest_of(path)
    with pytest.raises(InputError) as caught:
        StoppedRun(path, 40)
    assert str(caught.value) == f"{path}: holds what another program put into it, and going on would lose it: {place}"
    assert caught.value.remedies == (Remedy("lose additions", path),)
    assert digest_of(path) == before
    assert list(path.parent.iterdir()) == [path]
    with StoppedRun(path, 40, replace=True) as stopped, stopped.go_on() as recording:
        go_on(recording)
    assert digest_of(path) == digest_of(record(path.with_name("whole.h5"), header(40)))


def test_a_file_of_ours_has_no_additions(tmp_path: Path) -> None:
    for run in (header(40), header(40, compress=True), header(7, n_atoms=20)):
        with Trajectory(record(tmp_path / "out.h5", run, replace=True)) as trajectory:
            assert trajectory.additions() == []
    killed(tmp_path / "journal.h5", header(40), 20)
    with Trajectory(tmp_path / "journal.h5") as trajectory:
        assert trajectory.additions() == []


def test_what_was_added_to_a_complete_run_is_no_matter(path: Path) -> None:
    with h5py.File(path, "r+") as file:
        file["analysis/tension"] = [1.0]
    before = digest_of(path)
    with StoppedRun(path) as stopped:
        assert stopped.is_complete
    assert digest_of(path) == before


@pytest.mark.parametrize("author", ["Mauno Rönkkö", "Ada", "A" * 200, np.bytes_("Ada"), ["Ada"]])
def test_the_name_of_an_author_goes_on(path: Path, author: object) -> None:
    """Also through a run that is killed and gone on with, and in the bytes of what comes of it."""
    with h5py.File(path, "r+") as file:
        file["h5md/author"].attrs["name"] = author
    with resume(path, rounds=40) as recording:
        go_on(recording, stop_after=30, finish=False)
    with resume(path) as recording:
        go_on(recording)
    expected = {"Ada"} if not isinstance(author, str) else {author}
    with h5py.File(path) as file:
        name = file["h5md/author"].attrs["name"]
        assert (name.decode() if isinstance(name, bytes) else str(name)) in expected
    with Trajectory(path) as trajectory:
        assert holds(trajectory, [0, 10, 20, 30, 40])
        assert trajectory.additions() == []


def test_what_is_no_name_of_an_author_is_not_one(path: Path) -> None:
    with h5py.File(path, "r+") as file:
        file["h5md/author"].attrs["name"] = 5
    with Trajectory(path) as trajectory:
        assert trajectory.header.author == "unknown"
        assert trajectory.additions() == ["/h5md/author@name"]
