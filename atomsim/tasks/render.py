"""Which frames of trajectories a picture shows and from where, as their scenes say; knows not how they are drawn."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

from atomsim.compiler.colors import atom_color, rgb
from atomsim.drawing import Row, View, compose, frames_to
from atomsim.errors import InputError, Notice
from atomsim.tasks.recompute import compile_inside
from atomsim.trajectory import Trajectory

Hear: TypeAlias = Callable[[Notice], None]

N_FRAMES = 6
"""How many rounds a strip shows where nobody chose."""


def render(
    trajectories: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    picture: str | os.PathLike[str],
    *,
    rounds: Sequence[int] | None = None,
    camera: tuple[float, float] | None = None,
    size: tuple[int, int] | None = None,
    notice: Hear | None = None,
) -> None:
    """Draw a strip: frames side by side, a row per trajectory. A picture of that name is replaced.

    Args:
        trajectories: one trajectory or several.
        picture: the file to write; its extension tells the format: png, jpg, webp, pdf or svg.
        rounds: the rounds to show; by default what each scene says, else evenly spread ones.
        camera: azimuth and elevation of the viewer [degrees], instead of what the scenes say.
        size: width and height of a frame [pixels].
        notice: hears what a user should know about where the frames come from.

    Raises:
        InputError: a trajectory, a round, a size or a name that will not do.
        RunError: the picture cannot be written.
    """
    with ExitStack() as opened:
        found = _opened(trajectories, opened, notice)
        compose([_row(trajectory, rounds, camera, every=False) for trajectory in found], Path(picture), size)


def render_frames(
    trajectories: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    folder: str | os.PathLike[str],
    *,
    rounds: Sequence[int] | None = None,
    camera: tuple[float, float] | None = None,
    size: tuple[int, int] | None = None,
    notice: Hear | None = None,
) -> list[Path]:
    """Draw every frame, or those of some rounds, as a PNG of its own; see `render`.

    Returns:
        The files, in order.
    """
    with ExitStack() as opened:
        found = _opened(trajectories, opened, notice)
        rows = [_row(trajectory, rounds, camera, every=True) for trajectory in found]
        return frames_to(rows, Path(folder), size)


def _opened(
    trajectories: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], opened: ExitStack, notice: Hear | None
) -> list[Trajectory]:
    """Open one trajectory or several, until the stack is left."""
    paths = [trajectories] if isinstance(trajectories, (str, os.PathLike)) else trajectories
    found = [opened.enter_context(Trajectory(path)) for path in paths]
    for message in (message for trajectory in found for message in trajectory.notices()):
        if notice is not None:
            notice(message)
    return found


def _row(
    trajectory: Trajectory, rounds: Sequence[int] | None, camera: tuple[float, float] | None, *, every: bool
) -> Row:
    """Choose the frames of one trajectory and from where they are seen."""
    inside, _, _ = compile_inside(trajectory.header, trajectory.path)  # compiled only to be sure that it fits
    scene = inside.scene
    chosen = scene.render
    wanted = trajectory.rounds.tolist() if rounds is None and every else rounds
    asked = _asked(trajectory, wanted, chosen.rounds)
    view = View(**chosen.camera.model_dump())
    if camera is not None:
        view = replace(view, azimuth=camera[0], elevation=camera[1])
    return Row(
        title=_title(trajectory),
        frames=tuple(trajectory[_nearest(trajectory, round_index)] for round_index in asked),
        color=atom_color(scene),
        view=view,
        background=rgb(chosen.background),
        asked=asked,
        start=trajectory[0].position,
    )


def _title(trajectory: Trajectory) -> str:
    """Return what stands above the row; a run that blew up is not shown as if nothing had happened."""
    title = trajectory.header.title or Path(trajectory.header.scene_name).name
    if trajectory.end.kind == "blew up":
        return f"{title} — blew up after round {trajectory.rounds[-1]}"
    return title


def _asked(trajectory: Trajectory, rounds: Sequence[int] | None, chosen: Sequence[int] | None) -> tuple[int, ...]:
    """Return the rounds to show: as asked for, else as the scene says as far as the run went, else evenly spread."""
    last = int(trajectory.rounds[-1])
    if rounds is not None:
        beyond = [round_index for round_index in rounds if round_index > last]
        if beyond:
            raise InputError(f"{trajectory.path}: there is no round {beyond[0]}; it ends at round {last}")
        return tuple(rounds)
    if chosen is not None:
        reached = tuple(round_index for round_index in chosen if round_index <= last)
        return reached if len(reached) == len(chosen) or last in reached else (*reached, last)
    recorded = trajectory.rounds
    places = sorted({place * (len(recorded) - 1) // (N_FRAMES - 1) for place in range(N_FRAMES)})
    return tuple(int(recorded[place]) for place in places)


def _nearest(trajectory: Trajectory, round_index: int) -> int:
    """Return the index of the frame recorded nearest to a round, the earlier of two."""
    return int(abs(trajectory.rounds - round_index).argmin())
