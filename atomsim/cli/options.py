"""Options that several commands share; knows no command."""

from __future__ import annotations

from typing import Annotated, TypeAlias

import typer

Backend: TypeAlias = Annotated[
    str, typer.Option(metavar="auto|numpy|numba", help="What computes; the trajectory is the same to the last bit.")
]

Threads: TypeAlias = Annotated[
    int | None,
    typer.Option(metavar="N", help="Threads to compute with (Numba only); by default as many as are worth it."),
]
