"""Files that appear whole or not at all."""

import errno
from pathlib import Path

import pytest

from atomsim.drawing.files import check_target, write_whole
from atomsim.errors import InputError, RunError


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a.bmp", "{}/a.bmp: the extension tells the format; use .png or .svg (got `.bmp`)"),
        ("a", "{}/a: the extension tells the format; use .png or .svg (got no extension)"),
        ("folder.png", "{}/folder.png: this is a folder; give the name of a file"),
        ("none/a.png", "{}/none/a.png: the folder {}/none does not exist"),
    ],
)
def test_names_that_cannot_be_written_are_refused(tmp_path, name, message):
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(InputError) as caught:
        check_target(tmp_path / name, (".png", ".svg"))
    assert str(caught.value) == message.format(*[tmp_path] * message.count("{}"))


def test_capitals_are_as_good(tmp_path):
    check_target(tmp_path / "A.PNG", (".png", ".svg"))


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "a.png"
    write_whole(path, b"old")
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_leaves_the_old_file_and_no_litter(tmp_path, monkeypatch):
    path = tmp_path / "a.png"
    write_whole(path, b"old")

    def half(self: Path, content: bytes) -> int:
        with self.open("wb") as file:
            file.write(content[:1])
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", half)
    with pytest.raises(RunError) as caught:
        write_whole(path, b"new")
    assert str(caught.value) == f"{path}: cannot be written: No space left on device"
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
