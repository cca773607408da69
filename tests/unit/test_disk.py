"""Files that appear whole or not at all, behind links and with the permissions that they had."""

import errno
import os
import resource
from pathlib import Path

import pytest

from atomsim import disk
from atomsim.disk import behind, whole_file, write_whole
from atomsim.errors import InputError, RunError


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    return path


def test_a_file_is_replaced_whole(path):
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert list(path.parent.iterdir()) == [path]


def test_a_disk_that_takes_no_more_leaves_the_old_file_and_no_litter(path):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2, limits[1]))
    try:
        with pytest.raises(RunError) as caught:
            write_whole(path, b"new")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert str(caught.value) == f"{path}: cannot be written: File too large"
    assert path.read_bytes() == b"old"
    assert list(path.parent.iterdir()) == [path]


def test_what_breaks_off_leaves_the_old_file_and_no_litter(path):
    def break_off():
        with whole_file(path) as file:
            file.write(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        break_off()
    assert path.read_bytes() == b"old"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("exists", [True, False])
def test_a_link_stays_and_the_file_behind_it_is_written(tmp_path, exists):
    (tmp_path / "scratch").mkdir()
    real = tmp_path / "scratch" / "real.png"
    if exists:
        real.write_bytes(b"old")
    (tmp_path / "near.png").symlink_to("scratch/real.png")  # as `ln -s` makes it: seen from where the link is
    (tmp_path / "far.png").symlink_to("near.png")
    write_whole(tmp_path / "far.png", b"new")
    assert real.read_bytes() == b"new"
    assert not real.is_symlink()
    assert os.readlink(tmp_path / "near.png") == "scratch/real.png"  # noqa: PTH115
    assert os.readlink(tmp_path / "far.png") == "near.png"  # noqa: PTH115
    assert len(list(tmp_path.rglob("*"))) == 4


def test_links_in_a_circle_are_refused(tmp_path):
    (tmp_path / "a.png").symlink_to("b.png")
    (tmp_path / "b.png").symlink_to("a.png")
    with pytest.raises(InputError, match=r"a\.png: its links lead in a circle$"):
        behind(tmp_path / "a.png")


def test_permissions_stay(path):
    path.chmod(0o640)
    write_whole(path, b"new")
    assert path.stat().st_mode & 0o777 == 0o640


def test_what_cannot_have_its_old_group_is_closed_to_the_new_one(path, monkeypatch):
    path.chmod(0o664)
    real_stat = Path.stat

    def of_another_group(self, **options):
        found = list(real_stat(self, **options))
        found[5] += self == path
        return os.stat_result(found)

    def refuse(*_):
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))

    monkeypatch.setattr(Path, "stat", of_another_group)
    monkeypatch.setattr(os, "chown", refuse)
    write_whole(path, b"new")
    monkeypatch.undo()
    assert path.stat().st_mode & 0o777 == 0o604


def test_a_write_protected_file_stays(path, monkeypatch):
    monkeypatch.setattr(disk.os, "access", lambda *_: False)  # chmod does not keep root out
    with pytest.raises(RunError, match=r"a\.png: cannot be written: Permission denied$"):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old"
