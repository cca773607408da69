"""A scene mended: what was found in it, and a scene that extends it and takes that away."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from atomsim.compiler import compile_scene
from atomsim.disk import check_regular, write_whole
from atomsim.errors import InputError, Remedy
from atomsim.findings.before.diagnose import examine
from atomsim.findings.finding import Finding
from atomsim.findings.mending import Mending
from atomsim.scene import LoadedScene, load

MARK = "# Written by atomsim check --fix"
"""Begins every scene of ours, which may be written again."""

MOST_PASSES = 5
"""What is mended may bring other findings to light, but not for ever."""


@dataclass(frozen=True, slots=True)
class Mended:
    """What became of a scene.

    Attributes:
        path: the scene that was written, or None where nothing could be mended.
        gone: what was found before and no longer is.
        left: what is still found.
        new: what is found in the mended scene only.
    """

    path: Path | None
    gone: tuple[Finding, ...]
    left: tuple[Finding, ...]
    new: tuple[Finding, ...]


def mend(scene: Path, target: Path, *, replace: bool = False) -> Mended:
    """Write a scene that extends another one and applies every remedy of its findings that is mechanical.

    Args:
        scene: the scene, which stays as it is.
        target: the file to write, in the folder of the scene or in one above it.
        replace: whether a file of that name may go that is not of ours.

    Raises:
        SceneError: the scene has mistakes.
        InputError: a name that will not do.
        OSError: the file cannot be written.
    """
    _require_ours(scene, target, replace)
    extended = _seen_from(scene, target)
    loaded = load(scene)
    before = _examined(loaded)
    mending = Mending({section: set(getattr(loaded.scene, section)) for section in _SECTIONS})
    found, n_passes = before, 0
    while n_passes < MOST_PASSES and mending.add(found):
        found = _examined(load(scene, mending.settings()))
        n_passes += 1
    if not n_passes:
        return Mended(None, (), tuple(before), ())
    text = f"{MARK}; docs/findings.md explains the codes.\n{mending.text(extended)}"
    write_whole(target, text.encode())
    after = _examined(load(target))
    kinds_before, kinds_after = ({(each.code, each.names) for each in each_list} for each_list in (before, after))
    return Mended(
        target,
        gone=tuple(each for each in before if (each.code, each.names) not in kinds_after),
        left=tuple(each for each in after if (each.code, each.names) in kinds_before),
        new=tuple(each for each in after if (each.code, each.names) not in kinds_before),
    )


_SECTIONS = ("groups", "bonds", "collisions", "forces")


def _examined(loaded: LoadedScene) -> list[Finding]:
    return list(examine(loaded, *compile_scene(loaded)).findings)


def _seen_from(scene: Path, target: Path) -> str:
    """Return the scene as one beside the target names it."""
    folder = Path(os.path.realpath(target.parent))
    extended = Path(os.path.realpath(scene))
    if not extended.is_relative_to(folder):
        raise InputError(f"{target}: a scene extends only what is in its own folder; write it beside {scene}")
    return extended.relative_to(folder).as_posix()


def _require_ours(scene: Path, target: Path, replace: bool) -> None:
    """Refuse to write over a scene that somebody wrote, above all the given one."""
    if not target.parent.is_dir():
        raise InputError(f"{target}: the folder {target.parent} does not exist")
    check_regular(target)
    if target.is_dir():
        raise InputError(f"{target}: this is a folder; give the name of a file")
    if target.exists() and scene.exists() and target.samefile(scene):
        raise InputError(f"{target}: this is the scene itself, which stays as it is; give another name")
    if target.exists() and not replace and not target.read_bytes().startswith(MARK.encode()):
        raise InputError(f"{target} exists already; give another name", Remedy("replace"))
