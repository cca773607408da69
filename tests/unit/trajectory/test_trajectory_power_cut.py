"""A power cut keeps what was said to be there: the order in which files reach the disk and get and lose their names."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sample_run import go_on, header, killed, record, resume

from atomsim.trajectory import recover


class Diary:
    """Writes down, in order, what is done to the files of a folder.

    A name is given only to a file that has reached the disk to its last byte: this is asserted at once.
    """

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.entries: list[str] = []
        self._synced: dict[int, int] = {}
        self._fsync, self._link, self._replace, self._unlink = os.fsync, os.link, os.replace, os.unlink
        for name in ("fsync", "link", "replace", "unlink"):
            patch.setattr(os, name, getattr(self, name))

    def fsync(self, fd: int) -> None:
        self._fsync(fd)
        found = os.fstat(fd)
        self._synced[found.st_ino] = found.st_size
        names = [path.name for path in self.folder.iterdir() if os.path.samestat(found, path.stat())]
        is_folder = os.path.samestat(found, self.folder.stat())
        self.entries.append("sync the folder" if is_folder else f"sync {' and '.join(names)}")

    def link(self, source: Path, target: Path) -> None:
        self._check(source)
        self._link(source, target)
        self.entries.append(f"name {source.name} {target.name}")

    def replace(self, source: Path, target: Path) -> None:
        self._check(source)
        self._replace(source, target)
        self.entries.append(f"name {source.name} {target.name}")

    def unlink(self, path: Any, **options: Any) -> None:
        self._unlink(path, **options)
        self.entries.append(f"remove {Path(path).name}")

    def _check(self, source: Path) -> None:
        assert self._synced.get(source.stat().st_ino) == source.stat().st_size, f"{source} is not on the disk"


@pytest.fixture
def diary(tmp_path: Path) -> Iterator[Diary]:
    with pytest.MonkeyPatch.context() as patch:
        yield Diary(tmp_path, patch)


BEGUN = ["sync out.h5.part.tmp", "name out.h5.part.tmp out.h5.part", "remove out.h5.part.tmp", "sync the folder"]
ENDED = ["sync out.h5.part"]
BUILT = ["sync out.h5.part.built", "sync out.h5.part", "name out.h5.part.built out.h5"]
NEW = ["remove out.h5.part.built", "sync the folder", "remove out.h5.part"]
REPLACED = ["sync the folder", "remove out.h5.part"]


def test_a_run_from_its_beginning_to_its_file(tmp_path: Path, diary: Diary) -> None:
    """The journal goes last: until then, every frame is in a file that has its name."""
    record(tmp_path / "out.h5", header())
    assert diary.entries == BEGUN + ENDED + BUILT + NEW


def test_a_run_that_replaces_a_journal(tmp_path: Path, diary: Diary) -> None:
    killed(tmp_path / "out.h5", header(), 20)
    assert diary.entries == BEGUN
    record(tmp_path / "out.h5", header(), replace=True)
    replaced = ["sync out.h5.part.tmp", "name out.h5.part.tmp out.h5.part", "sync the folder"]
    assert diary.entries[len(BEGUN) :] == replaced + ENDED + BUILT + NEW


def test_a_finished_run_that_goes_on(tmp_path: Path, diary: Diary) -> None:
    """The journal counts as the newer one as soon as it has its name, so it holds all frames by then."""
    path = record(tmp_path / "out.h5", header(20))
    diary.entries.clear()
    with resume(path, rounds=40) as recording:
        assert diary.entries == BEGUN
        go_on(recording)
    assert diary.entries == BEGUN + ENDED + BUILT + REPLACED


def test_a_journal_that_is_recovered(tmp_path: Path, diary: Diary) -> None:
    killed(tmp_path / "out.h5", header(), 20)
    diary.entries.clear()
    recover(tmp_path / "out.h5")
    assert diary.entries == BUILT + NEW
