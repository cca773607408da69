"""Where compiled kernels are kept, and that a second process finds them."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.process import finish, python

import atomsim
from atomsim.core.numba_backend import cache

START = """
from atomsim.core.numba_backend.stepper import NumbaStepper
from atomsim.core.proof import prove
from atomsim.core.numba_backend.round_kernels import advance_rounds
prove(NumbaStepper)
print(*map(len, (advance_rounds.stats.cache_hits, advance_rounds.stats.cache_misses)))
"""


def test_kernels_go_to_the_users_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    place = cache.folder()
    assert place is not None
    assert place.parent == tmp_path / ".cache"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")  # which would be another one in every folder
    assert cache.folder() == place
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert cache.folder() == tmp_path / "xdg" / place.name
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "numba"))
    assert cache.folder() == tmp_path / "numba" / place.name


def test_other_sources_have_another_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    core = tmp_path / "core" / "numba_backend"
    core.mkdir(parents=True)
    monkeypatch.setattr(cache, "__file__", str(core / "cache.py"))
    assert cache.folder() is None
    (core / "kernels.py").write_text("one")
    first = cache.folder()
    (core / "kernels.py").write_text("two")
    assert first is not None
    assert cache.folder() != first


def test_where_nothing_can_be_written_nothing_is_kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file" / "below"))
    assert cache.writable_folder() is None
    assert not cache.has_kernels()
    cache.clear()


@pytest.mark.slow
def test_a_second_process_loads_what_the_first_compiled(tmp_path: Path) -> None:
    pytest.importorskip("numba", reason="the backend is an extra")
    package = Path(atomsim.__file__).parents[1]
    variables = {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(package)}
    outputs = [finish(program=python(START), **variables).stdout.split() for _ in range(2)]
    assert outputs == [["0", "1"], ["1", "0"]]
    assert not list(Path(cache.__file__).parent.rglob("*.nbc"))
