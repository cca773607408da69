"""Shells complete commands, options, backends and scenes: what they ask, and real shells where there are any."""

from __future__ import annotations

import os
import pty
import select
import shutil
import sys
import time
from pathlib import Path

import pytest
from support.process import clean_environment, finish

BESIDE_PYTHON = str(Path(sys.executable).parent)

ASKED = {
    "bash": lambda words: {"COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)},
    "zsh": lambda words: {"_TYPER_COMPLETE_ARGS": " ".join(words)},
    "fish": lambda words: {"_TYPER_COMPLETE_ARGS": " ".join(words), "_TYPER_COMPLETE_FISH_ACTION": "get-args"},
}
"""How the script of each shell asks for what may follow."""

EXPECTED = [
    (("atomsim", "ver"), {"verify"}),
    (("atomsim", "golden", ""), {"record", "check"}),
    (("atomsim", "run", "--back"), {"--backend"}),
    (("atomsim", "run", "--backend", ""), {"auto", "numpy", "numba"}),
    (("atomsim", "golden", "check", "--backend", "num"), {"numpy", "numba"}),
    (("atomsim", "new", "rod"), {"rods", "rod-thread"}),
]


@pytest.mark.parametrize("shell", ASKED)
def test_what_a_shell_is_answered(tmp_path, shell):
    for words, expected in EXPECTED:
        asked = {"_ATOMSIM_COMPLETE": f"complete_{shell}", **ASKED[shell](words)}
        done = finish(cwd=tmp_path, **asked)
        assert (done.returncode, done.stderr) == (0, ""), words
        answer = done.stdout.replace("'*: :((", "").replace("))'", "")
        lines = [line.split("\t")[0].strip().strip('"').split('":')[0] for line in answer.splitlines()]
        found = {line.removeprefix("_arguments ").strip('"') for line in lines}
        assert found == expected, words


BASH = """
eval "$(_ATOMSIM_COMPLETE=source_bash atomsim)"
COMP_WORDS=(atomsim run --backend num); COMP_CWORD=3
_atomsim_completion atomsim
echo "${COMPREPLY[*]}"
complete -p atomsim
"""


def test_bash_completes_a_backend_and_leaves_files_to_itself(tmp_path):
    path = f"{BESIDE_PYTHON}:{os.environ['PATH']}"
    done = finish(program=["bash", "--norc", "-c", BASH], cwd=tmp_path, PATH=path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "numpy numba\ncomplete -o default -F _atomsim_completion atomsim\n"


def typed_into(shell: list[str], lines: list[str], expected: str, folder: Path) -> str:
    """Type into a shell on a terminal until it shows what is expected, or half a minute has passed."""
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        path = f"{BESIDE_PYTHON}:{os.environ['PATH']}"
        os.execvpe(shell[0], shell, clean_environment(PATH=path, HOME=str(folder), TERM="xterm"))
    shown = ""
    try:
        for line in lines:
            os.write(terminal, line.encode())
        deadline = time.monotonic() + 30.0
        while expected not in shown and time.monotonic() < deadline:
            if select.select([terminal], [], [], 0.1)[0]:
                shown += os.read(terminal, 65536).decode(errors="replace")
    finally:
        os.close(terminal)
        os.waitpid(process, 0)
    return shown


@pytest.mark.skipif(shutil.which("zsh") is None, reason="there is no zsh")
def test_zsh_completes_a_backend_and_files(tmp_path):
    (tmp_path / "mine.yaml").touch()
    setup = 'autoload -U compinit; compinit -u -D; eval "$(_ATOMSIM_COMPLETE=source_zsh atomsim)"\r'
    shown = typed_into(["zsh", "-f", "-i"], [setup, "atomsim run min\t --backend nump\t"], "--backend numpy", tmp_path)
    assert "mine.yaml" in shown
    assert "--backend numpy" in shown


@pytest.mark.skipif(shutil.which("fish") is None, reason="there is no fish")
def test_fish_completes_a_backend_and_files(tmp_path):
    (tmp_path / "mine.yaml").touch()
    path = f"{BESIDE_PYTHON}:{os.environ['PATH']}"
    program = [
        "fish",
        "--no-config",
        "-c",
        '_ATOMSIM_COMPLETE=source_fish atomsim | source; complete -C "atomsim run --backend n"; '
        'complete -C "atomsim run min"',
    ]
    done = finish(program=program, cwd=tmp_path, PATH=path, HOME=str(tmp_path))
    assert sorted(done.stdout.split()) == ["mine.yaml", "numba", "numpy"]
