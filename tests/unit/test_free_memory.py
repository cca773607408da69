"""How much memory is free: what the machine says, or less where a container allows less."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from atomsim.core import free_memory as memory


def write_group(folder: Path, limit: str, used: str, kept: str) -> None:
    for name, text in {"memory.max": limit, "memory.current": used, "memory.stat": kept}.items():
        (folder / name).write_text(text)


def test_the_machine_has_a_sensible_amount() -> None:
    assert 1 << 20 < memory.free_memory() < 1 << 50


def test_a_container_allows_less(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that are kept for speed only make room."""
    write_group(tmp_path, "1000000\n", "400000\n", "anon 300000\nfile 100000\ninactive_file 50000\n")
    monkeypatch.setattr(memory, "GROUP", tmp_path)
    assert memory.free_memory() == 650_000


def test_a_container_that_is_full_allows_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_group(tmp_path, "1000000", "1200000", "inactive_file 0")
    monkeypatch.setattr(memory, "GROUP", tmp_path)
    assert memory.free_memory() == 0


@pytest.mark.parametrize(("limit", "kept"), [("max", "inactive_file 0"), ("1000", "nothing"), ("1000", "anon 3")])
def test_without_a_limit_the_machine_decides(tmp_path: Path, limit: str, kept: str) -> None:
    write_group(tmp_path, limit, "1", kept)
    assert memory._free_in_group(tmp_path) == sys.maxsize
    assert memory._free_in_group(tmp_path / "nowhere") == sys.maxsize
