"""Pictures of trajectories: which frames they show and from where, as the user or else the scene says."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

from atomsim.arguments import flag, function, path, paths
from atomsim.compiler.colors import atom_color, rgb
from atomsim.compiler.selections import SelectionError, atoms_named
from atomsim.core.model import Floats, Indices
from atomsim.drawing import BLACK, WHITE, Paper, Report, Row, compose, frames_to
from atomsim.errors import InputError, Notice
from atomsim.scene.language import Camera, Scene
from atomsim.scene.loader import camera_with
from atomsim.tasks.cameras import AskedCamera, CameraWish, camera_wishes, view_of
from atomsim.tasks.overview import Overview
from atomsim.tasks.recompute import broken, laid_out_inside
from atomsim.tasks.rounds import Latest, Wish, chosen, wishes
from atomsim.tasks.sizes import AskedSize, Size
from atomsim.trajectory import Frames, Trajectory

Paths: TypeAlias = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]

Hear: TypeAlias = Callable[[Notice], None]

N_FRAMES = 6
"""How many rounds a strip shows where nobody chose."""

DARK = "#2a2a2d"
"""What stands behind atoms in a dark picture."""


def render(
    trajectories: Paths,
    picture: str | os.PathLike[str],
    *,
    rounds: str | Sequence[int] | None = None,
    camera: AskedCamera | None = None,
    size: AskedSize | None = None,
    dpi: int | None = None,
    dark: bool = False,
    transparent: bool = False,
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
            `side` or `top`, or a mapping with keys of `render.camera` of a scene; or a list of these, for as many rows.
        size: width and height of a frame [pixels], or a text such as `"8x6cm"`.
        dpi: pixels per inch of paper; 300 where the size is in centimetres.
        dark: whether pictures, page and words are for a dark surrounding.
        transparent: whether there is nothing behind the atoms, so that the picture can be laid over others.
        notice: hears what a user should know about where the frames come from.
        report: hears how many pictures of how many are drawn, at the start and after each.

    Raises:
        InputError: a trajectory, a round, a size or a name that will not do.
        RunError: the picture cannot be written.
    """
    out, wish = path("picture", picture), _Wish.of(rounds, camera, size, dpi, dark, transparent)
    with _opened(trajectories, notice, report) as found:
        compose(_rows(found, wish, every=False), out, wish.size.pixels, report, wish.paper, wish.size.dpi)


def render_frames(
    trajectories: Paths,
    folder: str | os.PathLike[str],
    *,
    rounds: str | Sequence[int] | None = None,
    camera: AskedCamera | None = None,
    size: AskedSize | None = None,
    dpi: int | None = None,
    dark: bool = False,
    transparent: bool = False,
    notice: Hear | None = None,
    report: Report | None = None,
) -> list[Path]:
    """Draw every frame, or those of some rounds, as a PNG of its own; see `render`.

    However long the trajectories are, one frame at a time is in memory.

    Returns:
        The files, in order.
    """
    into, wish = path("folder", folder), _Wish.of(rounds, camera, size, dpi, dark, transparent)
    with _opened(trajectories, notice, report) as found:
        return frames_to(_rows(found, wish, every=True), into, wish.size.pixels, report, wish.size.dpi)


@dataclass(frozen=True, slots=True)
class _Wish:
    """What the user asks for, checked as far as can be without a scene; None is left to the scenes."""

    rounds: tuple[Wish, ...] | None
    cameras: tuple[CameraWish, ...]
    size: Size
    is_dark: bool
    is_transparent: bool

    @classmethod
    def of(cls, rounds: Any, camera: Any, size: Any, dpi: Any, dark: Any, transparent: Any) -> _Wish:
        """Check the arguments of a function."""
        return cls(
            None if rounds is None else wishes(rounds),
            camera_wishes("camera", camera),
            Size.of(size, dpi),
            flag("dark", dark),
            flag("transparent", transparent),
        )

    @property
    def paper(self) -> Paper:
        """The colours around the pictures."""
        paper = BLACK if self.is_dark else WHITE
        return replace(paper, page="none") if self.is_transparent else paper

    def background(self, said: str) -> tuple[float, float, float] | None:
        """Return what stands behind the atoms, in place of what a scene says."""
        return None if self.is_transparent else rgb(DARK if self.is_dark else said)


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
    """Choose the frames of every trajectory and from where they are seen, a row for each camera."""
    overview = Overview(trajectories)
    return [row for trajectory in trajectories for row in _rows_of(trajectory, wish, overview, every=every)]


def _rows_of(trajectory: Trajectory, wish: _Wish, overview: Overview, *, every: bool) -> Iterator[Row]:
    """Yield the rows of one trajectory."""
    scene = laid_out_inside(trajectory.header, trajectory.path).scene
    rounds, places = _frames(trajectory, wish.rounds, scene.render.rounds, overview, every=every)
    color = _color(scene, trajectory)
    for asked in wish.cameras:
        camera = camera_with(scene, asked.keys) if asked.keys else scene.render.camera
        yield Row(
            title=" — ".join(filter(None, (title_of(trajectory), asked.name))),
            frames=Frames(trajectory, places.tolist()),
            rounds=tuple(rounds.tolist()),
            paint=lambda frame: color,
            view=view_of(camera, overview.azimuth),
            background=wish.background(scene.render.background),
            start=trajectory[0].position,
            scenery=None if camera.width else overview.scenery(trajectory),
            followed=_selected(scene, camera, "follow", trajectory),
            filling=_selected(scene, camera, "close_up", trajectory),
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


def _selected(scene: Scene, camera: Camera, key: str, trajectory: Trajectory) -> Indices | None:
    """Return the atoms that a key of a camera selects."""
    selection = getattr(camera, key)
    try:
        return None if selection is None else atoms_named(scene, selection)
    except SelectionError as error:
        raise InputError(f"{trajectory.path}: camera.{key}: {error}") from None


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
