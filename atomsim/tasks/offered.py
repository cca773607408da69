"""The scenes that come with atomsim, those of the paper and the recipes: listed, and copied to begin with."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from atomsim.disk import behind, check_regular, write_whole
from atomsim.errors import InputError, Remedy
from atomsim.scene import load
from atomsim.scene.mistakes.wording import meant
from atomsim.shipped import PACKAGE, shipped

KINDS = {"paper": ".", "recipe": "recipes"}
"""Kinds of scenes, with the folder of each below `scenes`."""

_EXTENDS = re.compile(r"^extends: *(\S+)", re.MULTILINE)
_SCHEMA = re.compile(r"(?<=\$schema=)\S+")


@dataclass(frozen=True, slots=True)
class Offer:
    """A scene at hand.

    Attributes:
        name: what it is called, its file without `.yaml`.
        kind: one of `KINDS`.
        path: the file.
    """

    name: str
    kind: str
    path: Path

    def title(self) -> str:
        """Return what the scene calls itself."""
        return load(self.path).scene.title


def offers() -> list[Offer]:
    """Return the scenes at hand, those of the paper first."""
    return [
        Offer(path.stem, kind, path)
        for kind, folder in KINDS.items()
        for path in sorted((shipped("scenes") / folder).glob("*.yaml"))
    ]


def begin(name: str, target: Path | None = None, *, replace: bool = False) -> list[Path]:
    """Copy a scene at hand, and what it extends beside it, to be changed.

    Args:
        name: the scene, one of `offers`.
        target: the file to write; by default the scene's own name in the current folder.
        replace: whether files of these names may be replaced.

    Returns:
        The files written, the scene first; what was there already, to the letter, is not written again.

    Raises:
        InputError: there is no such scene, or a file of that name exists, or a pipe.
    """
    found = {offer.name: offer for offer in offers()}
    offer = found.get(name.removesuffix(".yaml"))
    if offer is None:
        raise InputError(f"there is no scene `{name}` at hand; {meant(name, found, 'there are')}")
    target = target or Path(offer.path.name)
    texts = dict(_chain(offer.path, target))
    for path in texts:
        check_regular(path)
    written = {path: text for path, text in texts.items() if not _holds(path, text)}
    for path in written:
        if path.exists() and not replace:
            raise InputError(f"{path} exists already", Remedy("rename"), Remedy("replace"))
        if not behind(path).parent.is_dir():
            raise InputError(f"{path}: the folder {path.parent} does not exist")
    for path, text in written.items():
        write_whole(path, text.encode())
    return list(texts)


def _chain(source: Path, target: Path) -> Iterator[tuple[Path, str]]:
    """Yield the copy of a scene, and those of the scenes that it extends, which lie beside it."""
    text = source.read_text(encoding="utf-8")
    yield target, _SCHEMA.sub((PACKAGE / "scene" / "scene.schema.json").as_uri(), text)
    extended = _EXTENDS.search(text)
    if extended:
        yield from _chain(source.parent / extended[1], Path(os.path.normpath(target.parent / extended[1])))


def _holds(path: Path, text: str) -> bool:
    """Tell whether a file has just this text."""
    try:
        return path.read_bytes() == text.encode()
    except OSError:
        return False
