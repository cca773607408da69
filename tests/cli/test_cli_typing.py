"""Mistakes of typing: one line in our own words, with the way out, and exit code 2."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.main import get_command

from atomsim.cli.app import app

EXAMPLE = "as in: atomsim run scenes/rods.yaml -o rods.h5 --set time_step=0.005"

MISTAKES = {
    "runn x": "atomsim: there is no command runn; did you mean run?",
    "RUN x": "atomsim: there is no command RUN; did you mean run?",
    "help": "atomsim: there is no command help; to see all: atomsim --help",
    "scenes/rods.yaml": "atomsim: there is no command scenes/rods.yaml; did you mean: atomsim run scenes/rods.yaml?",
    "mine.h5": "atomsim: there is no command mine.h5; did you mean: atomsim show mine.h5?",
    "golden": "atomsim golden: a command is missing: record or check",
    "golden chek x": "atomsim golden: there is no command chek; did you mean check?",
    "--rounds 5 run x": "atomsim: there is no option --rounds here; options stand behind their command",
    "--versoin": "atomsim: there is no option --versoin; did you mean --version?",
    "run x --roundz 5": "atomsim run: there is no option --roundz; did you mean --rounds?",
    "run x -rounds 5": "atomsim run: there is no option -rounds; did you mean --rounds?",
    "run x --what": "atomsim run: there is no option --what; to see all: atomsim run --help",
    "run x -x": "atomsim run: there is no option -x; to see all: atomsim run --help",
    "run x —force": "atomsim run: `—force` is too much; options begin with - or --",
    "run x y": f"atomsim run: `y` is too much, {EXAMPLE}",
    "run": "name a scene to run, as in: atomsim run scenes/rods.yaml",
    "run x --rounds": "--rounds needs a value",
    "run x --quiet=1": "--quiet takes no value",
    "run x --rounds many": "--rounds needs a whole number of 1 or more (got many)",
    "run x --rounds 0": "--rounds needs a whole number of 1 or more (got 0)",
    "run x --rounds -5": "--rounds needs a whole number of 1 or more (got -5)",
    "run x --rounds 1.5": "--rounds needs a whole number of 1 or more (got 1.5)",
    "run x --rounds 1e999": "--rounds needs a whole number of 1 or more (got 1e999)",
    "run x --rounds .nan": "--rounds needs a whole number of 1 or more (got .nan)",
    "run x --rounds 1,000": "--rounds needs a whole number of 1 or more; write 1000 (got 1,000)",
    "run x --rounds 1_000": "--rounds needs a whole number of 1 or more; write 1000 (got 1_000)",
    "run x --rounds=": '--rounds needs a whole number of 1 or more (got "")',
    "run x --threads all": "--threads needs a whole number of 1 or more (got all)",
    "run x --backend gpu": "--backend needs auto, numpy or numba (got gpu)",
    "run x -o -": "--output needs a name, not a stream (got -)",
    "compare x": "atomsim compare: B is missing, as in: atomsim compare a.h5 b.h5 --tolerance 1e-9",
    "compare x y --tolerance nan": "--tolerance needs a number of 0 or more (got nan)",
    "compare x y --tolerance -1": "--tolerance needs a number of 0 or more (got -1)",
    "check": "atomsim check: SCENE is missing, as in: atomsim check scenes/*.yaml",
    "check scenes\\rods.yaml": "scenes\\rods.yaml: there is no such file; did you mean `scenes/rods.yaml`?",
    "check scenes/rods.yaml\r": "scenes/rods.yaml\\r: there is no such file; did you mean `scenes/rods.yaml`?",
}


@pytest.mark.parametrize("typed", MISTAKES)
def test_a_mistake_is_one_line_of_ours(cli, typed):
    Path("mine.h5").touch()
    result = cli(*typed.replace("\\", "\\").split(" "))
    assert (result.code, result.out) == (2, "")
    assert result.err == MISTAKES[typed].replace("\\", "\\") + "\n"


FILES = {"CSV", "FILE", "FOLDER", "OUT", "PICTURE", "SCENE", "XML"}
"""What options for files and folders ask for."""


def options_for_files():
    """Yield every option of every command that names a file or a folder, with its command."""
    for name, command in get_command(app).commands.items():
        for inner, each in getattr(command, "commands", {"": command}).items():
            for parameter in each.params:
                if parameter.param_type_name == "option" and parameter.metavar in FILES:
                    yield f"{name} {inner}".split(), parameter.opts[0]


@pytest.mark.parametrize(("words", "option"), list(options_for_files()), ids=str)
def test_an_option_is_no_name_of_a_file(cli, words, option):
    """As in `-o --force`, where the name was forgotten."""
    result = cli(*words, "x", option, "--force")
    assert (result.code, result.out) == (2, "")
    assert result.err == f"{option} needs a name; one that begins so is written ./--force (got --force)\n"


def test_there_are_options_for_files():
    assert len(list(options_for_files())) >= 9


def test_a_tilde_in_quotes(cli, monkeypatch):
    monkeypatch.setenv("HOME", str(Path.cwd()))
    result = cli("check", "~/scenes/rods.yaml")
    assert result.code == 2
    assert result.err == f"~/scenes/rods.yaml: there is no such file; did you mean `{Path.cwd()}/scenes/rods.yaml`?\n"


@pytest.mark.parametrize("rounds", ["1e1", "10", "10.0", "+10"])
def test_numbers_are_written_as_in_a_scene(cli, rounds):
    assert cli("run", "scenes/rods.yaml", "-q", "--rounds", rounds).code == 0
    assert "round 0 to 10 of 10" in cli("show", "out.h5").out


def test_the_help_of_every_command_speaks_of_no_types_of_python(cli):
    for name, command in get_command(app).commands.items():
        for words in ([name, inner] for inner in getattr(command, "commands", {"": None})):
            result = cli(*filter(None, words), "--help")
            assert result.code == 0
            assert not re.search(r"<\w|[{}]|list\[", result.out), result.out
            assert "x>=" not in result.out
            assert "...." not in result.out
