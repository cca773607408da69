"""Names that a picture may have."""

import pytest

from atomsim.drawing.files import check_picture
from atomsim.errors import InputError


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
        check_picture(tmp_path / name, (".png", ".svg"))
    assert str(caught.value) == message.format(*[tmp_path] * message.count("{}"))


def test_capitals_are_as_good(tmp_path):
    check_picture(tmp_path / "A.PNG", (".png", ".svg"))


def test_what_a_link_leads_to_needs_a_folder(tmp_path):
    (tmp_path / "a.png").symlink_to(tmp_path / "none" / "b.png")
    with pytest.raises(InputError) as caught:
        check_picture(tmp_path / "a.png", (".png", ".svg"))
    assert str(caught.value) == f"{tmp_path}/a.png: the folder {tmp_path}/none does not exist"
