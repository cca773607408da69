"""Ctrl-C, SIGTERM and SIGHUP: what there is gets written, the exit code tells, and one line says how to go on."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from support.process import COMMAND, clean_environment, finish, heed, python, start

from atomsim.trajectory import Trajectory, journal_path

SCENES = Path(__file__).parents[2] / "scenes"
LONG_RUN = ("run", SCENES / "rods.yaml", "--rounds", "10000000", "--backend", "numpy")


def wait_for(condition, seconds=30.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def started(cwd: Path, *more: str) -> subprocess.Popen[str]:
    """Start a run that would take minutes; return when it has recorded its first frame."""
    process = start(*LONG_RUN, *more, cwd=cwd)
    journal = journal_path(cwd / "out.h5")
    wait_for(lambda: process.poll() is not None or (journal.exists() and journal.stat().st_size > 60_000))
    return process


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_stopped_run_writes_what_there_is_and_says_how_to_go_on(tmp_path, number, code):
    process = started(tmp_path)
    process.send_signal(number)
    out, err = process.communicate()
    assert process.returncode == code
    assert out == ""
    found = re.fullmatch(r"stopped after round (\d+) of 10000000; to go on: atomsim run --resume out\.h5\n", err)
    assert found, err
    with Trajectory(tmp_path / "out.h5") as trajectory:
        assert (trajectory.end.kind, trajectory.from_journal) == ("interrupted", False)
        last_round = int(trajectory.rounds[-1])
        assert last_round == int(found[1])
    again = finish("run", "--resume", "out.h5", "--rounds", str(last_round + 15), "-q", cwd=tmp_path)
    assert (again.returncode, again.stderr) == (0, "")
    whole = (SCENES / "rods.yaml", "-o", "whole.h5", "--rounds", str(last_round + 15), "-q")
    assert finish("run", *whole, cwd=tmp_path).returncode == 0
    assert (tmp_path / "out.h5").read_bytes() == (tmp_path / "whole.h5").read_bytes()


SECOND_SIGNAL = """
import os, signal
from atomsim.cli import main
from atomsim.core.numpy_backend.stepper import NumpyStepper
advance = NumpyStepper.advance
def twice(stepper, n_rounds):
    advance(stepper, n_rounds)
    if stepper.state().round_index > 30:
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGINT)
NumpyStepper.advance = twice
main()
"""


def test_a_second_signal_does_not_wait(tmp_path):
    """The first one decides the exit code; the frames are in the journal."""
    done = finish(*LONG_RUN, program=python(SECOND_SIGNAL), cwd=tmp_path, before=heed)
    assert done.returncode == 143
    assert done.stderr == "stopped at once; to go on: atomsim run --resume out.h5\n"
    with Trajectory(tmp_path / "out.h5") as trajectory:
        assert trajectory.from_journal
        assert trajectory.rounds.tolist() == [0, 10, 20, 30]


def test_a_terminal_that_closes_may_say_so_twice(tmp_path):
    """Once by itself and once by its shell: nobody is impatient."""
    twice = SECOND_SIGNAL.replace("signal.SIGTERM", "signal.SIGHUP").replace("signal.SIGINT", "signal.SIGHUP")
    done = finish(*LONG_RUN, program=python(twice), cwd=tmp_path, before=heed)
    assert done.returncode == 129
    assert done.stderr.startswith("stopped after round ")
    with Trajectory(tmp_path / "out.h5") as trajectory:
        assert (trajectory.end.kind, trajectory.from_journal) == ("interrupted", False)


def test_a_terminal_that_is_closed_in_earnest(tmp_path):
    """The kernel tells the run, which can no longer say anything, and still writes what there is."""
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(tmp_path)
        heed()
        os.execve(sys.executable, [*COMMAND, *map(str, LONG_RUN)], clean_environment())
    journal = journal_path(tmp_path / "out.h5")
    wait_for(lambda: journal.exists() and journal.stat().st_size > 80_000)  # a second block of frames
    os.close(terminal)
    _, status = os.waitpid(process, 0)
    assert os.waitstatus_to_exitcode(status) == 129
    with Trajectory(tmp_path / "out.h5") as trajectory:
        assert (trajectory.end.kind, trajectory.from_journal) == ("interrupted", False)


READY = "import sys; from atomsim.cli import main; print('ready', flush=True); main()"


def test_ctrl_c_at_any_moment_of_the_start_is_quiet(tmp_path):
    """From the first line of ours on: while modules are loaded, the scene is compiled, the run begins."""
    for moment in (0.02, 0.04, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4):
        process = start(*LONG_RUN, "-o", f"{moment}.h5", program=python(READY), cwd=tmp_path)
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(moment)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
        assert (process.returncode, out) == (130, ""), (moment, err)
        assert re.fullmatch(r"(stopped after round .*\n)?", err), (moment, err)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_signals_that_are_ignored_stay_ignored(tmp_path, number):
    """Behind `nohup`, or in the background of a script, neither Ctrl-C nor a closed terminal is meant for this run."""
    deaf = start(
        *("run", SCENES / "rods.yaml", "-q", "--backend", "numpy"),
        program=python(READY),
        cwd=tmp_path,
        before=lambda: signal.signal(number, signal.SIG_IGN),
    )
    wait_for((tmp_path / "out.h5.part").exists)
    deaf.send_signal(number)
    deaf.communicate()
    assert deaf.returncode == 0


def test_a_resumed_run_may_name_its_scene(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "33", "-q").code == 0
    result = cli("run", "scenes/rods.yaml", "--resume", "out.h5", "--rounds", "75", "-q")
    assert (result.code, result.err) == (0, "")
    assert cli("run", "scenes/rods.yaml", "-o", "whole.h5", "--rounds", "75", "-q").code == 0
    assert Path("out.h5").read_bytes() == Path("whole.h5").read_bytes()


def test_a_scene_that_only_looks_different_is_the_same(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "33", "-q").code == 0
    changed = ["title=Another", "rounds=9999", "render={rounds: [0]}", "groups.left.velocity=[1.0, 0, 0]"]
    settings = [part for setting in changed for part in ("--set", setting)]
    assert cli("run", "scenes/rods.yaml", "--resume", "out.h5", "--rounds", "50", *settings, "-q").code == 0


def test_a_changed_scene_is_refused_with_the_difference(cli):
    assert cli("run", "scenes/rods.yaml", "--rounds", "33", "-q").code == 0
    before = Path("out.h5").read_bytes()
    changed = [
        "time_step=0.02",
        "groups.left.count=60",
        "bonds.right=null",
        "forces={g: {kind: gravity, impulse: [0, 0, -1]}}",
    ]
    settings = [part for setting in changed for part in ("--set", setting)]
    result = cli("run", "scenes/rods.yaml", "--resume", "out.h5", "--rounds", "50", *settings)
    assert (result.code, result.out) == (2, "")
    assert result.err == (
        "out.h5 is a run of another scene than scenes/rods.yaml is now:\n"
        "  time_step: 0.01 before, 0.02 now\n"
        "  groups.left.count: 70 before, 60 now\n"
        "  bonds.right: no longer there\n"
        "  forces.g: new\n"
        "to go on: atomsim run --resume out.h5; to run scenes/rods.yaml: choose another name with -o\n"
    )
    assert Path("out.h5").read_bytes() == before
    assert not Path("out.h5.part").exists()


def test_declarations_in_another_order_are_another_scene(cli):
    """The order of tables is the order in which forces are summed."""
    assert cli("run", "scenes/rods.yaml", "--rounds", "33", "-q").code == 0
    text = Path("scenes/rods.yaml").read_text()
    left, right = (f"  {side}: {{within: {side}, rule: all-pairs}}\n" for side in ("left", "right"))
    Path("scenes/rods.yaml").write_text(text.replace(left + right, right + left))
    result = cli("run", "scenes/rods.yaml", "--resume", "out.h5", "--rounds", "50")
    assert (result.code, "  bonds: in another order\n" in result.err) == (2, True)


def test_a_blown_up_run_is_not_gone_on_with(cli):
    blow_up = ("run", "scenes/rods.yaml", "--rounds", "400", "--set", "time_step=0.1", "-q")
    first = cli(*blow_up)
    assert first.code == 3
    before = Path("out.h5").read_bytes()
    result = cli("run", "--resume", "out.h5")
    assert (result.code, result.err) == (
        2,
        "out.h5: blew up after round 10 and would again; change its scene and run that\n",
    )
    assert Path("out.h5").read_bytes() == before
    assert "  ended      blew up: the simulation blew up in round 15: " in cli("show", "out.h5").out


def test_a_run_killed_before_its_first_frame_begins_anew(cli, monkeypatch):
    """Its journal says what is to be run, and no more; every command says so."""

    def killed(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("atomsim.tasks.prepare.simulate", killed)
        assert cli("run", "scenes/rods.yaml", "--rounds", "20").code == 130
    message = "out.h5.part: holds no frame yet; to run it: atomsim run --resume out.h5\n"
    for arguments in (("show", "out.h5"), ("render", "out.h5"), ("verify", "out.h5"), ("compare", "out.h5", "out.h5")):
        result = cli(*arguments)
        assert (result.code, result.err) == (2, message)
    assert cli("recover", "out.h5").err.startswith("out.h5: nothing to build: its journal out.h5.part holds no frame")
    assert cli("run", "--resume", "out.h5", "-q").code == 0
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-o", "whole.h5", "-q").code == 0
    assert Path("out.h5").read_bytes() == Path("whole.h5").read_bytes()


def test_commands_for_names_with_spaces_can_be_pasted(cli):
    name = "my run (1).h5"
    assert "next: atomsim render 'my run (1).h5'\n" in cli("run", "scenes/rods.yaml", "--rounds", "20", "-o", name).out
    result = cli("run", "scenes/rods.yaml", "-o", name)
    assert result.err.endswith("to go on: atomsim run --resume 'my run (1).h5'\n")
