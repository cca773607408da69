"""Every option of `atomsim run` does what its help says."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

import atomsim

SHORT = ("run", "scenes/threads.yaml", "--rounds", "20")

FAST = """
atomsim: 1
time_step: 0.05
rounds: 40
groups: {left: {shape: atoms, positions: [[0, 0, 0]]}, right: {shape: atoms, positions: [[9, 0, 0]]}}
collisions: {touch: {between: [left, right]}}
forces: {wind: {kind: gravity, acts_on: right, impulse: [10, 0, 0]}}
"""


@pytest.mark.parametrize("options", [("-o", "other.h5"), ("--compress",)])
def test_options_of_a_new_file_do_not_go_with_resume(cli, options):
    assert cli(*SHORT, "-q").code == 0
    before = Path("out.h5").read_bytes()
    result = cli("run", "--resume", "out.h5", "--rounds", "40", *options)
    assert (result.code, result.out) == (2, "")
    assert result.err == ("--resume goes on with the file that it names; -o and --compress do not go with it\n")
    assert Path("out.h5").read_bytes() == before
    assert not Path("other.h5").exists()


def test_compress_makes_a_smaller_file_of_the_same_frames(cli):
    assert cli(*SHORT, "-q").code == 0
    assert cli(*SHORT, "-q", "--compress", "-o", "small.h5").code == 0
    assert Path("small.h5").stat().st_size < Path("out.h5").stat().st_size
    assert cli("compare", "out.h5", "small.h5").out == "identical: 3 frames up to round 20\n"
    assert cli("run", "--resume", "small.h5", "--rounds", "40", "-q").code == 0
    with atomsim.Trajectory("small.h5") as trajectory:
        assert trajectory.header.compress


def test_quiet_leaves_out_warnings_before_and_after(cli):
    Path("fast.yaml").write_text(FAST)
    assert "warning: " in cli("run", "fast.yaml", "-o", "loud.h5").err
    assert cli("run", "fast.yaml", "-q").err == ""
    blow_up = ("run", "scenes/rods.yaml", "--rounds", "400", "--set", "time_step=0.1", "--force")
    assert cli(*blow_up).err.startswith("--set time_step=0.1: warning: time_step 0.1 ")
    assert cli(*blow_up, "-q").err.startswith("the simulation blew up in round 15: ")


class Terminal(io.StringIO):
    """A stream that somebody watches."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("options", "is_shown"), [((), True), (("-q",), False)])
def test_progress_is_shown_on_a_terminal_but_for_quiet(cli, monkeypatch, options, is_shown):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert cli(*SHORT, *options).code == 0
    assert ("round 0 of 20" in terminal.getvalue()) == is_shown


@pytest.mark.parametrize(
    "command",
    [SHORT, ("run", "--resume", "out.h5", "--rounds", "40"), ("verify", "out.h5")],
    ids=["run", "on", "verify"],
)
def test_backend_and_threads_reach_what_computes(cli, command):
    assert cli(*SHORT, "-q").code == 0
    result = cli(*command, *(("--force",) if command is SHORT else ()), "--backend", "numpy", "--threads", "2")
    assert (result.code, result.out) == (2, "")
    assert result.err == "the NumPy backend has one thread; several need Numba: pip install 'atomsim[fast]'\n"


def test_check_has_nothing_against_showing_the_last_round(cli):
    result = cli("check", "scenes/rods.yaml", "--set", "rounds=20", "--set", "render={rounds: [0, 20]}")
    assert result.code == 0
    assert "[no-such-round]" not in result.out
