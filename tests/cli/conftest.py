"""A command line in a folder of its own: `cli("run", "rods.yaml")` gives what a user would see."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from atomsim.cli import main

SCENES = Path(__file__).parents[2] / "scenes"


@dataclass(frozen=True)
class Result:
    """What a command printed and the exit code that it ended with."""

    code: int
    out: str
    err: str


Cli = Callable[..., Result]


@pytest.fixture
def cli(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Cli:
    """Run commands in an empty folder with a copy of the shipped scenes in it."""
    shutil.copytree(SCENES, tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)

    monkeypatch.setattr(sys, "warnoptions", ["error"])  # what libraries warn of is to be heard here

    def run(*arguments: str) -> Result:
        monkeypatch.setattr(sys, "argv", ["atomsim", *arguments])
        capsys.readouterr()
        code = 0
        try:
            main()
        except SystemExit as end:
            code = int(end.code or 0)
        printed = capsys.readouterr()
        return Result(code, printed.out, printed.err)

    return run
