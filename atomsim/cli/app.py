"""The list of commands, and how what was typed becomes one of them."""

from __future__ import annotations

import typer

from atomsim.cli.commands.check import check
from atomsim.cli.commands.compare import compare
from atomsim.cli.commands.golden import golden
from atomsim.cli.commands.measure import measure
from atomsim.cli.commands.plot import plot
from atomsim.cli.commands.recover import recover
from atomsim.cli.commands.render import render
from atomsim.cli.commands.report import report
from atomsim.cli.commands.run import run
from atomsim.cli.commands.scenes import new, scenes
from atomsim.cli.commands.schema import schema
from atomsim.cli.commands.show import show
from atomsim.cli.commands.test import try_out
from atomsim.cli.commands.verify import verify
from atomsim.cli.voice import Command, UsageError, in_our_words
from atomsim.errors import InputError
from atomsim.shipped import shipped
from atomsim.version import __version__

app = typer.Typer(
    name="atomsim",
    help="See what a robot's parts would do: a short YAML scene of bound and colliding unit balls becomes a "
    "trajectory and a picture.",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

for command in (scenes, new, run, render, measure, plot, check, show, report, compare, verify, recover, schema):
    app.command(cls=Command)(command)
app.command("test", cls=Command)(try_out)
app.add_typer(golden, name="golden")


BEGIN = """\
atomsim {version}: see what a robot's parts would do, from a short scene of bound and colliding unit balls.

To begin:
  atomsim scenes           the scenes at hand
  atomsim new rods         a copy of one, to change: rods.yaml
  atomsim run rods.yaml    what happens: out.h5
  atomsim render out.h5    a picture of it: out.png

All commands: atomsim --help
A tutorial: {docs}
"""
"""What a newcomer reads who types nothing but the name."""


@app.callback(invoke_without_command=True)
def _top(
    context: typer.Context, version: bool = typer.Option(False, "--version", help="Print the version and exit.")
) -> None:
    if version:
        print(f"atomsim {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(BEGIN.format(version=__version__, docs=shipped("docs") / "tutorial.md"), end="")


def run_typed() -> int:
    """Do what was typed and return the exit code.

    Raises:
        AtomsimError: whatever went wrong, mistakes of typing included.
    """
    try:
        code = app(prog_name="atomsim", standalone_mode=False)
    except UsageError as error:
        raise InputError(in_our_words(error)) from None
    except SystemExit as end:  # a run that was stopped at once, or a script for completion
        if isinstance(end.code, str):
            raise
        code = end.code
    return code if isinstance(code, int) else 0
