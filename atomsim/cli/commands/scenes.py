"""`atomsim scenes` and `atomsim new`: the scenes at hand, and a copy of one to begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.options import output
from atomsim.cli.remedies import command
from atomsim.cli.terminal.output import say
from atomsim.cli.voice import explained


def names() -> list[str]:
    """Return what can be copied."""
    from atomsim.tasks.offered import offers

    return [offer.name for offer in offers()]


HEADINGS = {"paper": "Scenes of the paper", "recipe": "Recipes"}


@explained(
    """
    List the scenes that come with atomsim.

    Example:

    atomsim scenes
    """
)
def scenes() -> None:
    from atomsim.tasks.offered import offers

    found = offers()
    width = max(len(offer.name) for offer in found)
    for kind, heading in HEADINGS.items():
        say(f"{heading}:")
        for offer in (offer for offer in found if offer.kind == kind):
            say(f"  {offer.name:<{width}}  {offer.title()}")
    say("a copy to change: atomsim new NAME")


@explained(
    """
    Copy a scene that comes with atomsim, to begin with.

    What it extends is copied beside it. By default the copy is called as the scene is, in the current folder.

    Example:

    atomsim new rods
    """
)
def new(
    name: Annotated[
        str,
        typer.Argument(metavar="NAME", autocompletion=names, help="One of those that `atomsim scenes` lists."),
    ],
    output: Annotated[Path | None, output("SCENE", "The file to write.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that exist.")] = False,
) -> None:
    from atomsim.tasks.offered import begin

    written = begin(name, output, replace=force)
    say("\n".join(str(path) for path in written))
    say(f"next: {command('run', written[0])}")
