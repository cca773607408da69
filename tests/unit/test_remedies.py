"""Errors state facts wherever they come from; what to type stands in the command line alone."""

from __future__ import annotations

import ast
import pickle
import re
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest
from typer.main import get_command

import atomsim
from atomsim.cli.app import app
from atomsim.cli.remedies import in_words, with_remedies
from atomsim.errors import AtomsimError, InputError, Mark, Notice, Problem, Remedy, RemedyKind, SceneError

PACKAGE = Path(atomsim.__file__).parent
BELOW_THE_COMMAND_LINE = sorted(path for path in PACKAGE.rglob("*.py") if "cli" not in path.relative_to(PACKAGE).parts)

TOP = get_command(app)
COMMANDS = "|".join(TOP.commands)
PARAMETERS = [parameter for command in TOP.commands.values() for parameter in command.params]
OPTIONS = "|".join({option for parameter in PARAMETERS for option in parameter.opts if option[0] == "-"})
TYPED = re.compile(rf"(?<![\w-])({OPTIONS})(?![\w-])|\batomsim ({COMMANDS})\b")
"""What people type after a prompt: options and commands."""

PLACES = {"--set ", "# Written by "}
"""How the place of a setting is called in messages, as a file is called by its name; what stands in files of ours."""


def texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield every text of a module that is no documentation, with its line."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    documentation = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documentation:
            yield node.lineno, node.value


def test_nothing_below_the_command_line_tells_what_to_type() -> None:
    typed = [
        f"{path.relative_to(PACKAGE)}:{line}: {text}"
        for path in BELOW_THE_COMMAND_LINE
        for line, text in texts(path)
        if TYPED.search(text) and not any(place in text for place in PLACES) and "pip install" not in text
    ]
    assert typed == []


@pytest.mark.parametrize("kind", get_args(RemedyKind))
def test_the_command_line_has_words_for_every_remedy(kind: RemedyKind) -> None:
    assert TYPED.search(in_words(Remedy(kind, Path("a.h5"))))


def test_remedies_follow_the_facts() -> None:
    error = InputError("a.h5 exists", Remedy("replace"), Remedy("go on", Path("a b.h5")))
    assert with_remedies(error) == "a.h5 exists; add --force to replace it; to go on: atomsim run --resume 'a b.h5'"
    assert with_remedies(InputError("no")) == with_remedies(Notice("no")) == "no"
    assert with_remedies(InputError("two:\n  lines", Remedy("rename"))) == "two:\n  lines\nchoose another name with -o"


@pytest.mark.parametrize(
    "error",
    [
        InputError("a.h5 exists", Remedy("go on", Path("a.h5"))),
        SceneError([Problem(Mark("a.h5", 0, 0), "", "this is a trajectory")], Remedy("show scene", Path("a.h5"))),
    ],
)
def test_errors_travel_with_their_remedies(error: AtomsimError) -> None:
    arrived = pickle.loads(pickle.dumps(error))
    assert (str(arrived), arrived.remedies) == (str(error), error.remedies)
