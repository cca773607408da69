"""Children of tests are started in one place, so that none inherits an environment that decides what it shows."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.process import KEPT, clean_environment, finish, python

TESTS = Path(__file__).parents[1]

STARTERS = {"run", "Popen", "call", "check_call", "check_output"}

PROGRAMS_OF_THE_SYSTEM = {"mount", "umount"}


def starts(path: Path) -> Iterator[tuple[str, int, str]]:
    """Yield where a file starts a process, and which."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in STARTERS):
            continue
        if isinstance(node.func.value, ast.Name) and node.func.value.id == "subprocess":
            first = next(iter(ast.walk(node.args[0].elts[0])), None) if isinstance(node.args[0], ast.List) else None
            yield path.name, node.lineno, first.value if isinstance(first, ast.Constant) else ""


def test_children_are_started_by_the_helper_alone() -> None:
    found = [start for path in TESTS.rglob("*.py") if path.name != "process.py" for start in starts(path)]
    assert [start for start in found if start[2] not in PROGRAMS_OF_THE_SYSTEM] == []


def test_children_inherit_nothing_that_changes_what_they_do(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("PYTHONUNBUFFERED", "PYTHONOPTIMIZE", "MPLBACKEND", "NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "LC_ALL"):
        monkeypatch.setenv(name, "2")
    code = "import os, sys; print(sorted(os.environ), sys.flags.optimize)"
    names, optimize = finish(program=python(code), LOUD="1").stdout.rsplit(" ", 1)
    assert set(ast.literal_eval(names)) - {"LC_CTYPE"} == {*clean_environment(), "LOUD"} <= {*KEPT, "LOUD"}
    assert optimize == "0\n"
