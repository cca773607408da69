"""What typer says in words of its own, in ours: the help of commands, and mistakes of typing."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import typer
from typer.core import TyperCommand

Function = TypeVar("Function", bound=Callable[..., object])

UsageError: Any = typer.BadParameter.__mro__[1]
"""What typer raises when it cannot make sense of what was typed; its home differs from version to version."""


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
        return [re.sub(r"[{}]", "", piece) for piece in super().collect_usage_pieces(ctx)]


def in_our_words(error: Any) -> str:
    """Return what is wrong with what was typed, and how it is typed.

    Args:
        error: a `UsageError`.
    """
    from atomsim.scene.mistakes.wording import either, readable

    kind, message, context = type(error).__name__, error.format_message(), error.ctx
    if kind == "BadOptionUsage":
        return f"{error.option_name} {'takes no' if 'not take' in message else 'needs a'} value"
    command = context.command
    if kind == "NoSuchOption":
        options = [name for parameter in command.params for name in parameter.opts]
        return f"{context.command_path}: {_unknown('there is no option', error.option_name, options, context)}"
    if unknown := re.search(r"No such command (['\"])(.*?)\1", message):
        return f"{context.command_path}: {_unknown('there is no command', unknown[2], command.commands, context)}"
    if "Missing command" in message:
        return f"{context.command_path}: a command is missing: {either(command.commands)}"
    if kind == "MissingParameter":
        return f"{context.command_path}: {error.param.metavar} is missing{_example(context)}"
    if extra := re.search(r"unexpected extra arguments?(?:\(s\))? \((.*)\)", message):
        return f"{context.command_path}: `{readable(extra[1])}` is too much{_example(context)}"
    return f"{context.command_path}: {message}"


def _unknown(words: str, word: str, known: Iterable[str], context: Any) -> str:
    """Say that there is no such command or option, and which one may have been meant, or where all are listed."""
    from atomsim.scene.mistakes.wording import readable, suggestion  # only a mistake needs them

    close = suggestion(word, known)
    way_out = f"did you mean {close}?" if close else f"to see all: {context.command_path} --help"
    return f"{words} {readable(word)}; {way_out}"


def _example(context: Any) -> str:
    """Show how the command is typed."""
    example = re.search(r"^Examples?:\s+(\S.*)$", context.command.help or "", re.MULTILINE)
    return f", as in: {example[1]}" if example else ""
