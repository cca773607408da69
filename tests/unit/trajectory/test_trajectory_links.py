"""A trajectory whose name is a symbolic link: the link stays, the file behind it is written."""

from __future__ import annotations

from pathlib import Path

import pytest
from sample_run import digest_of, go_on, header, killed, record, resume

from atomsim.errors import InputError
from atomsim.trajectory import Recorder, Trajectory, journal_path, recover


@pytest.fixture
def link(tmp_path: Path) -> Path:
    """Return a link to where there is no file yet."""
    (tmp_path / "scratch").mkdir()
    link = tmp_path / "link.h5"
    link.symlink_to("scratch/real.h5")
    return link


def is_kept(link: Path) -> bool:
    """Tell whether there is nothing but the link and the one file behind it."""
    folder = link.parent
    real = folder / "scratch" / "real.h5"
    return link.readlink() == Path("scratch/real.h5") and set(folder.rglob("*")) == {link, real.parent, real}


@pytest.fixture
def whole(tmp_path_factory: pytest.TempPathFactory) -> str:
    return digest_of(record(tmp_path_factory.mktemp("whole") / "out.h5", header(40)))


def test_a_dangling_link(link: Path, whole: str) -> None:
    record(link, header(40))
    assert is_kept(link)
    assert digest_of(link) == whole


def test_replacing_what_is_behind_a_link(link: Path, whole: str) -> None:
    record(link, header(30))
    record(link, header(40), replace=True)
    assert is_kept(link)
    assert digest_of(link) == whole


def test_going_on_with_a_journal_behind_a_link(link: Path, whole: str) -> None:
    journal = killed(link, header(40), 20)
    assert journal == link.parent / "scratch" / "real.h5.part"
    with Trajectory(link) as seen:
        assert seen.from_journal
    with resume(link) as recording:
        go_on(recording)
    assert is_kept(link)
    assert digest_of(link) == whole


def test_going_on_with_a_finished_file_behind_a_link(link: Path, whole: str) -> None:
    record(link, header(20))
    with resume(link, rounds=40) as recording:
        go_on(recording)
    assert is_kept(link)
    assert digest_of(link) == whole


def test_recovering_behind_a_link(link: Path) -> None:
    killed(link, header(40), 20)
    recover(link)
    assert is_kept(link)


def test_two_names_of_one_file_share_its_lock_and_its_journal(link: Path) -> None:
    killed(link, header(40), 20)
    assert journal_path(link.parent / "scratch" / "real.h5") == journal_path(link)


def test_a_link_into_a_folder_that_is_not_there(tmp_path: Path) -> None:
    (tmp_path / "link.h5").symlink_to(tmp_path / "none" / "real.h5")
    with pytest.raises(InputError, match=rf"link\.h5: there is no folder {tmp_path}/none$"):
        Recorder.begin(tmp_path / "link.h5", header())


def test_a_link_to_a_journal_is_no_name_for_a_trajectory(tmp_path: Path) -> None:
    killed(tmp_path / "real.h5", header(40), 20)
    (tmp_path / "link.h5").symlink_to("real.h5.part")
    with pytest.raises(InputError, match=r"real\.h5\.part: this is the name of a journal"):
        Recorder.begin(tmp_path / "link.h5", header(), replace=True)


def test_links_in_a_circle(tmp_path: Path) -> None:
    (tmp_path / "a.h5").symlink_to("b.h5")
    (tmp_path / "b.h5").symlink_to("a.h5")
    for use in (Trajectory, recover, resume, lambda path: Recorder.begin(path, header())):
        with pytest.raises(InputError, match=r"a\.h5: its links lead in a circle$"):
            use(tmp_path / "a.h5")
