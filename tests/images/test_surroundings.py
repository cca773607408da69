"""Strips and plots have the same bytes in whatever surroundings matplotlib is met, and leave these as they were."""

import os
import sys
import threading
import warnings
from pathlib import Path

import matplotlib as mpl
import pytest
from support import small_strip as program
from support.process import finish
from support.small_strip import PICTURES, small_strip

LOUD = """
font.size: 40
text.color: red
savefig.dpi: 7
savefig.bbox: tight
svg.fonttype: none
axes.formatter.use_locale: True
"""


def bytes_in(folder: Path) -> list[bytes]:
    return [(folder / name).read_bytes() for name in PICTURES]


@pytest.fixture(scope="module")
def expected(tmp_path_factory) -> list[bytes]:
    folder = tmp_path_factory.mktemp("expected")
    small_strip(folder)
    return bytes_in(folder)


def draw(cwd: Path, **variables: str) -> None:
    """Draw in a process of its own, which has to be silent."""
    done = finish(cwd, program=(sys.executable, program.__file__), cwd=cwd, **variables)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def settings(folder: Path, text: str | bytes) -> Path:
    """Write a file of settings."""
    path = folder / "matplotlibrc"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_settings_that_matplotlib_understands_have_no_say(tmp_path, expected):
    settings(tmp_path, LOUD)
    draw(tmp_path, MPLBACKEND="tkagg")
    assert bytes_in(tmp_path) == expected


def test_settings_and_folders_that_matplotlib_complains_of_are_not_mentioned(tmp_path, expected):
    settings(tmp_path, "no colon\nunknown.key: 1\nbackend: nonsense\nfont.size: large?\n")
    (tmp_path / "file").touch()
    draw(tmp_path, MPLCONFIGDIR=str(tmp_path / "file"))
    assert bytes_in(tmp_path) == expected


def test_settings_that_cannot_be_read_and_the_backend_of_a_notebook_have_no_say(tmp_path, expected):
    settings(tmp_path, "font.family: Café\n".encode("latin-1"))
    draw(tmp_path, MPLBACKEND="module://matplotlib_inline.backend_inline")
    assert bytes_in(tmp_path) == expected


def test_settings_and_styles_of_the_user_that_cannot_be_read_have_no_say(tmp_path, expected):
    (tmp_path / "stylelib").mkdir()
    (tmp_path / "stylelib" / "mine.mplstyle").write_bytes(b"\xe9 broken")
    (tmp_path / "elsewhere").mkdir()
    chosen = settings(tmp_path, b"font.size: \xe9\n")
    draw(tmp_path / "elsewhere", MPLCONFIGDIR=str(tmp_path), MATPLOTLIBRC=str(chosen), MPLBACKEND="nonsense")
    assert bytes_in(tmp_path / "elsewhere") == expected


def test_settings_that_never_end_are_not_read(tmp_path, expected):
    os.mkfifo(tmp_path / "matplotlibrc")
    draw(tmp_path)
    assert bytes_in(tmp_path) == expected


def test_many_threads_leave_the_users_settings_alone(tmp_path, expected):
    folders = [tmp_path / str(number) for number in range(8)]
    for folder in folders:
        folder.mkdir()
    with mpl.rc_context({"font.size": 31, "text.color": "red", "savefig.facecolor": "black"}):
        before, filters = dict(dict.items(mpl.rcParams)), list(warnings.filters)
        threads = [threading.Thread(target=small_strip, args=(folder,)) for folder in folders]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert dict(dict.items(mpl.rcParams)) == before
        assert warnings.filters == filters
    assert all(bytes_in(folder) == expected for folder in folders)


def test_what_the_user_sets_while_a_strip_is_drawn_stays_set(tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    def set_meanwhile(*_: object, **__: object) -> None:
        mpl.rcParams["font.size"] = 17.0

    with mpl.rc_context({"font.size": 31, "text.color": "red"}):
        monkeypatch.setattr(Figure, "savefig", set_meanwhile)
        small_strip(tmp_path)
        assert (mpl.rcParams["font.size"], mpl.rcParams["text.color"]) == (17.0, "red")
