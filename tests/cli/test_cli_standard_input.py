"""Scenes from standard input, named `-`, and what is no scene file: pipes, devices, streams that are closed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from support.process import COMMAND, finish, python

from atomsim.trajectory import Trajectory

SCENES = Path(__file__).parents[2] / "scenes"
SCENE = (SCENES / "rods.yaml").read_text(encoding="utf-8")
BROKEN = SCENE.replace("shape: string", "shape: sting", 1)


def test_a_scene_is_read_from_standard_input(tmp_path):
    done = finish("run", "-", "--rounds", "20", "--backend", "numpy", cwd=tmp_path, said=SCENE)
    assert (done.returncode, done.stderr) == (0, "")
    with Trajectory(tmp_path / "out.h5") as trajectory:
        assert trajectory.header.scene_name == "standard input"
        assert len(trajectory) == 3
    for command in (
        ("verify", "out.h5"),
        ("run", "--resume", "out.h5", "--rounds", "40"),
        ("show", "out.h5", "--scene"),
    ):
        assert finish(*command, cwd=tmp_path).returncode == 0
    again = finish("run", "-", "--resume", "out.h5", "--rounds", "60", cwd=tmp_path, said=SCENE)
    assert (again.returncode, again.stderr) == (0, "")


def test_messages_name_standard_input(tmp_path):
    done = finish("check", "-", cwd=tmp_path, said=BROKEN)
    line = next(number for number, text in enumerate(BROKEN.splitlines(), 1) if "sting" in text)
    assert done.returncode == 2
    assert done.stderr.startswith(f"standard input:{line}:")
    assert "did you mean `string`?" in done.stderr
    assert finish("check", "-", cwd=tmp_path, said=SCENE).stdout.startswith("standard input: ")


def test_what_it_extends_lies_in_the_current_folder(tmp_path):
    (tmp_path / "base.yaml").write_text(SCENE)
    done = finish("check", "-", cwd=tmp_path, said="extends: base.yaml\ntitle: Another\n")
    assert (done.returncode, done.stdout.splitlines()[0]) == (0, "standard input: Another")
    done = finish("check", "-", cwd=tmp_path, said="extends: ../base.yaml\n")
    assert done.returncode == 2
    assert "extends: leads outside the folder of standard input" in done.stderr


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ("", "standard input:1:1: the scene is empty; it begins with `atomsim: 1`\n"),
        ("a" * (2**24 + 1), "standard input: the file is larger than 16 MiB\n"),
    ],
    ids=["nothing", "too much"],
)
def test_what_is_no_scene(tmp_path, said, message):
    done = finish("check", "-", cwd=tmp_path, said=said)
    assert (done.returncode, done.stderr) == (2, message)


def test_standard_input_that_is_closed_is_empty(tmp_path):
    done = finish("check", "-", cwd=tmp_path, before=lambda: os.close(0))
    assert (done.returncode, done.stderr) == (
        2,
        "standard input:1:1: the scene is empty; it begins with `atomsim: 1`\n",
    )


def test_standard_input_is_read_once(cli):
    result = cli("check", "-", "scenes/rods.yaml", "-")
    assert (result.code, result.out) == (2, "")
    assert result.err == "- stands for standard input, which can be read only once\n"


@pytest.mark.parametrize("action", ["record", "check"])
def test_a_golden_needs_a_name(cli, action):
    result = cli("golden", action, "-")
    assert (result.code, result.out) == (2, "")
    assert result.err == "a golden is named after the file of its scene, and standard input has no name\n"


def test_expectations_need_a_name(cli):
    result = cli("test", "-")
    assert (result.code, result.out) == (2, "")
    assert result.err == "expectations are named after the file of their scene, and standard input has no name\n"


@pytest.mark.parametrize("command", ["run", "check", "golden check", "golden record"])
def test_a_pipe_by_name_is_refused_and_not_waited_for(cli, command):
    os.mkfifo("pipe.yaml")
    result = cli(*command.split(), "pipe.yaml")
    assert (result.code, result.out) == (2, "")
    assert (
        result.err
        == "pipe.yaml: this is not a regular file; as standard input it can be read: atomsim check - < pipe.yaml\n"
    )


@pytest.mark.parametrize("command", ["show", "render", "verify", "recover", "measure", "run --resume"])
@pytest.mark.parametrize("name", ["out.h5", "out.h5.part"])
def test_a_pipe_is_no_trajectory(cli, command, name):
    os.mkfifo(name)
    result = cli(*command.split(), "out.h5")
    assert (result.code, result.out) == (2, "")
    assert "not a regular file" in result.err or "there is no journal" in result.err
    assert Path(name).is_fifo()


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("run scenes/rods.yaml -o", "out.h5"),
        ("run scenes/rods.yaml --force -o", "out.h5"),
        ("render good.h5 --force -o", "a.png"),
        ("render good.h5 -o", "a.png"),
        ("measure good.h5 --force -o", "a.csv"),
        ("new rods --force -o", "a.yaml"),
        ("golden record scenes/rods.yaml --into", "folder"),
        ("render good.h5 --frames", "folder"),
    ],
)
def test_a_pipe_is_not_written_to(cli, command, name):
    assert cli("run", "scenes/rods.yaml", "--rounds", "10", "-q", "-o", "good.h5").code == 0
    os.mkfifo(name)
    result = cli(*command.split(), name)
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith(name)
    assert Path(name).is_fifo()


def test_what_a_shell_has_opened_is_read(tmp_path):
    """`<(program)` of bash, `/dev/stdin`: whoever gave us the stream writes into it."""
    scene = SCENES / "rods.yaml"
    for command in (f"check <(cat {scene})", f"check /dev/stdin < {scene}"):
        done = finish(program=["bash", "-c", f"{' '.join(COMMAND)} {command}"], cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
    assert finish("check", "/dev/stdin", cwd=tmp_path, said=SCENE).returncode == 0


NOT_BLOCKING = """
import os, subprocess, sys
for stream in (sys.stdin, sys.stdout):
    os.set_blocking(stream.fileno(), False)
reader = subprocess.Popen(["sh", "-c", "sleep 1; cat"], stdin=subprocess.PIPE)
os.set_blocking(reader.stdin.fileno(), False)
code = subprocess.call([sys.executable, "-m", "atomsim", *sys.argv[1:]], stdout=reader.stdin)
reader.communicate()
sys.exit(code)
"""


@pytest.mark.parametrize("command", [("schema",), ("check", "-")])
def test_streams_that_another_program_set_not_to_block(tmp_path, command):
    """As some programs leave them: reading or writing fails instead of waiting, here for a reader that is slow."""
    done = finish(*command, program=python(NOT_BLOCKING), cwd=tmp_path, said=SCENE)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(done.stdout) > 100
