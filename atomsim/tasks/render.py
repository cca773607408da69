"""Pictures of trajectories: which frames they show and from where, as the user or else the scene says."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from atomsim.arguments import function, path, paths, whole_pair
from atomsim.compiler.colors import atom_color, rgb
from atomsim.compiler.selections import SelectionError, atoms_named
from atomsim.core.model import Floats, Indices
from atomsim.drawing import Report, Row, compose, frames_to
from atomsim.errors import InputError, Notice
from atomsim.scene.language import Camera, Scene
from atomsim.scene.loader import camera_with
from atomsim.tasks.cameras import AskedCamera, camera_keys, view_of
from atomsim.tasks.overview import Overview
from atomsim.tasks.recompute import broken, laid_out_inside
from atomsim.tasks.rounds import Latest, Wish, chosen, wishes
from atomsim.trajectory import Frames, Trajectory

Paths: TypeAlias = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]

Hear: TypeAlias = Callable[[Notice], None]

N_FRAMES = 6
"""How many rounds a strip shows where nobody chose."""


def render(
    trajectories: Paths,
    picture: str | os.PathLike[str],
    *,
    rounds: str | Sequence[int] | None = None,
    camera: AskedCamera | None = None,
    size: tuple[int, int] | None = None,
    notice: Hear | None = None,
    report: Report | None = None,
) -> None:
    """Draw a strip: frames side by side, a row per trajectory. A picture of that name is replaced.

    The scenes inside the trajectories are read, but not compiled.

    Args:
        trajectories: one trajectory or several.
        picture: the file to write; its extension tells the format: png, jpg, webp, pdf or svg.
        rounds: the rounds to show, as numbers or as a text such as on the command line, `"0-2000:100"`; by default
            what each scene says, else the first, the last and four between, closest where most happens.
        camera: from where it is seen, instead of what the scenes say: azimuth and elevation [degrees], or `front`,
            `side` or `top`, or a mapping with keys of `render.camera` of a scene.
        size: width and height of a frame [pixels].
        notice: hears what a user should know about where the frames come from.
        report: hears how many pictures of how many are drawn, at the start and after each.

    Raises:
        InputError: a trajectory, a round, a size or a name that will not do.
        RunError: the picture cannot be written.
    """
    out, wish = path("picture", picture), _Wish.of(rounds, camera, size)
    with _opened(trajectories, notice, report) as found:
        compose(_rows(found, wish, every=False), out, wish.size, report)


def render_frames(
    trajectories: Paths,
    folder: str | os.PathLike[str],
    *,
    rounds: str | Sequence[int] | None = None,
    camera: AskedCamera | None = None,
    size: tuple[int, int] | None = None,
    notice: Hear | None = None,
    report: Report | None = None,
) -> list[Path]:
    """Draw every frame, or those of some rounds, as a PNG of its own; see `render`.

    However long the trajectories are, one frame at a time is in memory.

    Returns:
        The files, in order.
    """
    into, wish = path("folder", folder), _Wish.of(rounds, camera, size)
    with _opened(trajectories, notice, report) as found:
        return frames_to(_rows(found, wish, every=True), into, wish.size, report)


@dataclass(frozen=True, slots=True)
class _Wish:
    """What the user asks for, checked as far as can be without a scene; None is left to the scenes."""

    rounds: tuple[Wish, ...] | None
    camera: Mapping[str, Any]
    size: tuple[int, int] | None

    @classmethod
    def of(cls, rounds: Any, camera: Any, size: Any) -> _Wish:
        """Check the arguments of a function."""
        return cls(
            None if rounds is None else wishes(rounds),
            camera_keys("camera", camera),
            None if size is None else whole_pair("size", size, "width and height in pixels, such as (640, 480)"),
        )


@contextmanager
def _opened(trajectories: Paths, notice: Hear | None, report: Report | None) -> Iterator[list[Trajectory]]:
    """Open one trajectory or several, and say what should be known about them."""
    function("notice", notice)
    function("report", report)
    with ExitStack() as opened:
        found = [opened.enter_context(Trajectory(file)) for file in paths("trajectories", trajectories)]
        for message in (message for trajectory in found for message in trajectory.notices()):
            if notice is not None:
                notice(message)
        yield found


def _rows(trajectories: list[Trajectory], wish: _Wish, *, every: bool) -> list[Row]:
    """Choose the frames of every trajectory and from where they are seen."""
    overview = Overview(trajectories)
    return [_row(trajectory, wish, overview, every=every) for trajectory in trajectories]


def _row(trajectory: Trajectory, wish: _Wish, overview: Overview, *, every: bool) -> Row:
    """Choose the frames of one trajectory and from where they are seen."""
    scene = laid_out_inside(trajectory.header, trajectory.path).scene
    camera = camera_with(scene, wish.camera) if wish.camera else scene.render.camera
    rounds, places = _frames(trajectory, wish.rounds, scene.render.rounds, overview, every=every)
    color = _color(scene, trajectory)
    return Row(
        title=title_of(trajectory),
        frames=Frames(trajectory, places.tolist()),
        rounds=tuple(rounds.tolist()),
        paint=lambda frame: color,
        view=view_of(camera, overview.azimuth),
        background=rgb(scene.render.background),
        start=trajectory[0].position,
        scenery=None if camera.width else overview.scenery(trajectory),
        followed=_followed(scene, camera, trajectory),
    )


def title_of(trajectory: Trajectory) -> str:
    """Return what stands above the row; a run that blew up is not shown as if nothing had happened."""
    title = trajectory.header.title or Path(trajectory.header.scene_name).name
    if trajectory.end.kind == "blew up":
        return f"{title} — blew up after round {trajectory.rounds[-1]}"
    return title


def _color(scene: Scene, trajectory: Trajectory) -> Floats:
    """Return the colours of the atoms, (n_atoms, 3) float64; a scene that was never compiled may name atoms amiss."""
    try:
        return atom_color(scene)
    except SelectionError as error:
        raise broken(trajectory.header, trajectory.path, f"render.colors: {error}") from None


def _followed(scene: Scene, camera: Camera, trajectory: Trajectory) -> Indices | None:
    """Return the atoms that stay in the middle of the picture."""
    if camera.follow is None:
        return None
    try:
        return atoms_named(scene, camera.follow)
    except SelectionError as error:
        raise InputError(f"{trajectory.path}: camera.follow: {error}") from None


def _frames(
    trajectory: Trajectory,
    asked: tuple[Wish, ...] | None,
    said: tuple[int, ...] | None,
    overview: Overview,
    *,
    every: bool,
) -> tuple[Indices, Indices]:
    """Return rounds and the places of their frames: as asked for, all of them, as the scene says, or the telling."""
    recorded = trajectory.rounds
    if asked is None and every:
        asked = (Latest(len(recorded)),)
    elif asked is None and said is not None:
        asked = _reached(said, int(recorded[-1]))
    if asked is None:
        places = overview.telling(trajectory, N_FRAMES)
        return recorded[places], places
    try:
        return chosen(asked, recorded)
    except InputError as error:
        raise InputError(f"{trajectory.path}: {error}") from None


def _reached(said: tuple[int, ...], last: int) -> tuple[int, ...]:
    """Return the rounds that a scene says as far as the run went."""
    reached = tuple(round_index for round_index in said if round_index <= last)
    return reached if len(reached) == len(said) or last in reached else (*reached, last)
