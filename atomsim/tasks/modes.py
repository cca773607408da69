"""Pictures of the motions that floppy bodies and loose joints allow."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from atomsim.compiler import compile_scene
from atomsim.compiler.colors import atom_color
from atomsim.drawing import View, direction_of
from atomsim.drawing.files import is_our_picture
from atomsim.drawing.mode import draw_mode
from atomsim.errors import InputError, Remedy
from atomsim.findings.before.floppy import Loose, loose_bodies
from atomsim.findings.subject import Subject, TooLargeError
from atomsim.scene import LoadedScene

WORDS = {False: "floppy", True: "loose-joint"}


def draw_modes(loaded: LoadedScene, folder: Path, *, replace: bool = False) -> list[Path]:
    """Draw the smoothest free motion of every body that is floppy, or loosely joined, each into a file of its own.

    Args:
        loaded: the scene.
        folder: where the pictures go; it is made if need be.
        replace: whether files of these names may go that are no pictures of ours.

    Returns:
        The pictures, in order; none where every body is stiff, or too large for its motions to be computed.

    Raises:
        SceneError: the scene does not compile.
        InputError: a file of that name exists, or the folder is a file.
        RunError: a picture cannot be written.
    """
    model, state = compile_scene(loaded)
    subject = Subject(loaded.scene, loaded.source, model, state)
    color = atom_color(loaded.scene)
    camera = loaded.scene.render.camera
    view = View(*direction_of(camera.view, camera.azimuth, camera.elevation, camera.up), camera.up)
    drawn = []
    for kind, loose in _all_loose(subject):
        if loose.found.mode is None:
            continue
        names = [model.groups[number].name for number in loose.groups]
        path = folder / f"{kind}-{'-'.join(names)}.png"
        _require_ours(path, folder, replace)
        title = f"{kind}: {', '.join(names)}"
        draw_mode(subject.placed[loose.atoms], loose.found.mode, color[loose.atoms], view, title, path)
        drawn.append(path)
    return drawn


def _all_loose(subject: Subject) -> Iterator[tuple[str, Loose]]:
    """Yield the loose bodies of both kinds, as far as they are not too large."""
    for joints, kind in WORDS.items():
        try:
            for loose in loose_bodies(subject, joints=joints, with_mode=True):
                yield kind, loose
        except TooLargeError:
            pass


def _require_ours(path: Path, folder: Path, replace: bool) -> None:
    """Make the folder, and refuse to replace what atomsim did not draw."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: this is a file; give the name of a folder")
    folder.mkdir(parents=True, exist_ok=True)
    if path.exists() and not replace and not is_our_picture(path):
        raise InputError(f"{path} exists and atomsim did not draw it", Remedy("replace"))
