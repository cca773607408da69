"""`atomsim scenes` and `atomsim new`: the scenes at hand, and a copy of one to begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atomsim.cli.remedies import command
from atomsim.cli.terminal.output import say

HEADINGS = {"paper": "Scenes of the paper", "recipe": "Recipes"}


def scenes() -> None:
    """List the scenes that come with atomsim.

    Example:

    atomsim scenes
    """
    from atomsim.tasks.offered import offers

    found = offers()
    width = max(len(offer.name) for offer in found)
    for kind, heading in HEADINGS.items():
        say(f"{heading}:")
        for offer in (offer for offer in found if offer.kind == kind):
            say(f"  {offer.name:<{width}}  {offer.title()}")
    say("a copy to change: atomsim new NAME")


def new(
    name: Annotated[str, typer.Argument(metavar="NAME", help="One of those that `atomsim scenes` lists.")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="SCENE", help="The file to write.", show_default=False)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that exist.")] = False,
) -> None:
    """Copy a scene that comes with atomsim, to begin with.

    What it extends is copied beside it. By default the copy is called as the scene is, in the current folder.

    Example:

    atomsim new rods
    """
    from atomsim.tasks.offered import begin

    written = begin(name, output, replace=force)
    say("\n".join(str(path) for path in written))
    say(f"next: {command('run', written[0])}")
