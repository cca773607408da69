"""What typer says in words of its own, in ours: the help of commands, and mistakes of typing."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import typer
from typer.core import TyperCommand

from atomsim.cli.remedies import command

Function = TypeVar("Function", bound=Callable[..., object])

UsageError: Any = typer.BadParameter.__mro__[1]
"""What typer raises when it cannot make sense of what was typed; its home differs from version to version."""


_DASHES = "\N{EN DASH}\N{EM DASH}\N{MINUS SIGN}"
"""What word processors make of the hyphens of an option."""


def explained(text: str) -> Callable[[Function], Function]:
    """Give a command its help: a docstring would be gone under `python -OO`."""

    def explain(function: Function) -> Function:
        function.__doc__ = inspect.cleandoc(text)
        return function

    return explain


class Command(TyperCommand):
    """A command whose help names arguments by what they are, and not by types of Python."""

    def __init__(self, *arguments: Any, **settings: Any) -> None:
        super().__init__(*arguments, **settings)
        for parameter in self.params:
            if parameter.param_type_name == "argument":
                vars(parameter)["display_type_rich"] = lambda ctx: None

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return what stands behind the name of the command in its first line of help."""
        pieces = (re.sub(r"[{}]", "", piece) for piece in super().collect_usage_pieces(ctx))
        return [re.sub(r"\.{4,}$", "...", piece) for piece in pieces]


def in_our_words(error: Any) -> str:
    """Return what is wrong with what was typed, and how it is typed.

    Args:
        error: a `UsageError`.
    """
    from atomsim.scene.mistakes.wording import either, readable

    kind, message, context = type(error).__name__, error.format_message(), error.ctx
    if kind == "BadOptionUsage":
        return f"{error.option_name} {'takes no' if 'not take' in message else 'needs a'} value"
    if kind == "NoSuchOption":
        return f"{context.command_path}: there is no option {_no_such_option(error.option_name, context)}"
    if unknown := re.search(r"No such command (['\"])(.*?)\1", message):
        return f"{context.command_path}: there is no command {_no_such_command(unknown[2], context)}"
    if "Missing command" in message:
        return f"{context.command_path}: a command is missing: {either(context.command.commands)}"
    if kind == "MissingParameter":
        return f"{context.command_path}: {error.param.metavar} is missing{_example(context)}"
    if extra := re.search(r"unexpected extra arguments?(?:\(s\))? \((.*)\)", message):
        dash = "; options begin with - or --" if extra[1][0] in _DASHES else _example(context)
        return f"{context.command_path}: `{readable(extra[1])}` is too much{dash}"
    return f"{context.command_path}: {message}"


def _no_such_option(name: str, context: Any) -> str:
    """Name the option that was typed, and the one that may have been meant."""
    if not name.startswith("--"):  # of `-rounds`, typer tells no more than `-r`
        name = next((word for word in sys.argv if word.startswith(name) and len(word) > len(name)), name)
    inner = getattr(context.command, "commands", {}).values()
    if any(name in parameter.opts for command in inner for parameter in command.params):
        return f"{name} here; options stand behind their command"
    options = [option for parameter in context.command.params for option in parameter.opts]
    return _meant(name, name if name.startswith("--") else f"-{name}", options, context)


def _no_such_command(name: str, context: Any) -> str:
    """Name the command that was typed, and the one that may have been meant: the one for a file, or one like it."""
    if Path(name).is_file() and "show" in context.command.commands:
        return f"{name}; did you mean: {command('show' if Path(name).suffix == '.h5' else 'run', Path(name))}?"
    return _meant(name, name, context.command.commands, context)


def _meant(word: str, like: str, known: Iterable[str], context: Any) -> str:
    """Return a word, and which of those that are known may have been meant by it, or where all are listed."""
    from atomsim.scene.mistakes.wording import readable, suggestion  # only a mistake needs them

    close = suggestion(like, known)
    way_out = f"did you mean {close}?" if close else f"to see all: {context.command_path} --help"
    return f"{readable(word)}; {way_out}"


def _example(context: Any) -> str:
    """Show how the command is typed."""
    example = re.search(r"^Examples?:\s+(\S.*)$", context.command.help or "", re.MULTILINE)
    return f", as in: {example[1]}" if example else ""
