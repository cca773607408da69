"""Scene files and the files they extend, read into one tree; knows `extends` and no other word of the language."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import BinaryIO

from atomsim.errors import Mark, Problem, Remedy, SceneError
from atomsim.scene.mistakes.wording import printable, shown, suggestion
from atomsim.scene.yaml.strict_yaml import MAX_CHARACTERS, read_yaml
from atomsim.scene.yaml.tree import Node, merge

MAX_FILES = 16

_HDF5 = b"\x89HDF\r\n\x1a\n"

_OTHERS = (
    (b"\x1f\x8b", "a gzip archive"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"BZh", "a bzip2 archive"),
    (b"\xfd7zXZ\0", "an xz archive"),
    (b"\x28\xb5\x2f\xfd", "a zstd archive"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"%PDF-", "a PDF document"),
)
"""How other files begin that somebody may take for a scene."""

_ENCODINGS = (
    (rb"\xff\xfe\0\0|\0\0\xfe\xff|[^\0]\0\0\0|\0\0\0[^\0]", "UTF-32"),
    (rb"\xff\xfe|\xfe\xff|[^\0]\0|\0[^\0]", "UTF-16"),
)
"""How a text begins in other encodings than UTF-8: with a mark, or with zeros beside its first letter."""


def read_scene_file(name: str) -> Node:
    """Read a scene file and lay it over the files it extends.

    Args:
        name: the file as the user named it.

    Returns:
        The merged tree, without `extends`.

    Raises:
        SceneError: a file that cannot be read or is no strict YAML mapping; an `extends` that leads outside the folder
            of the first file, in a circle or through more than 16 files.
    """
    return _read_chain(_read_text(name), name, os.path.realpath(Path(name).parent), [])


def read_scene_stream(stream: BinaryIO, name: str) -> Node:
    """Read a scene from a stream and lay it over the files it extends, which lie in the current folder.

    Args:
        stream: the scene as bytes.
        name: what to call it in messages.

    Raises:
        SceneError: as `read_scene_file` does.
    """
    try:
        data = stream.read(MAX_CHARACTERS + 1)
    except OSError as error:
        raise _unreadable(name, f"the scene cannot be read ({error.strerror})") from None
    return _read_chain(_decoded(data, name), name, os.path.realpath("."), [])


def read_scene_text(text: str, name: str) -> Node:
    """Read a scene that is no file, and so extends none.

    Args:
        text: the scene.
        name: what to call it in messages.

    Raises:
        SceneError: no strict YAML mapping, or one that extends a file.
    """
    root = _mapping(text, name)
    if "extends" in _entries(root):
        mark = _entries(root)["extends"].mark
        raise SceneError([Problem(mark, "extends", "only a scene file can extend another")])
    return root


def _read_chain(text: str, name: str, folder: str, chain: list[str]) -> Node:
    """Lay a scene over what it extends; `chain` names the files that led here."""
    root = _mapping(text, name)
    entries = dict(_entries(root))
    extends = entries.pop("extends", None)
    root = Node(dict(entries), root.mark)
    if extends is None or (extends.value is None and extends.blank is None):
        return root
    chain = [*chain, name]
    base = _base_name(extends, folder, chain)
    return merge(_read_chain(_read_text(base), base, folder, chain), root)


def _base_name(extends: Node, folder: str, chain: list[str]) -> str:
    """Return the name of the extended file, having made sure that it may be read."""

    def refused(message: str) -> SceneError:
        return SceneError([Problem(extends.mark, "extends", message)])

    if not isinstance(extends.value, str):
        raise refused(f"needs the path of a scene file (got {shown(extends.plain())})")
    if not extends.value or Path(extends.value).is_absolute():
        raise refused(f"needs a path relative to this file (got {shown(extends.plain())})")
    base = os.path.normpath(Path(chain[-1]).parent / extends.value)
    target = Path(os.path.realpath(base))
    if not target.is_relative_to(folder):
        raise refused(f"leads outside the folder of {printable(chain[0])} (got {shown(extends.plain())})")
    if str(target) in [os.path.realpath(name) for name in chain]:
        raise refused(f"goes round in a circle: {' → '.join(printable(name) for name in [*chain, base])}")
    if len(chain) == MAX_FILES:
        raise refused(f"goes through more than {MAX_FILES} files")
    if not target.exists():
        raise refused(_no_such_file(base, extends.value, f" (got {shown(extends.value)})"))
    if not target.is_file():
        raise refused(f"leads to something that is no file (got {shown(extends.plain())})")
    return base


def _mapping(text: str, name: str) -> Node:
    file = printable(name)
    if re.match(r"\s*<[!?a-zA-Z]", text):
        raise SceneError([Problem(Mark(file, 1, 1), "", "this is HTML or XML; a scene is YAML")])
    root = read_yaml(text, lambda line, column: Mark(file, line, column))
    if root.value is None:
        raise SceneError([Problem(root.mark, "", "the scene is empty; it begins with `atomsim: 1`")])
    if not isinstance(root.value, dict):
        message = f"a scene is a mapping of keys such as `groups:` (got {shown(root.plain())})"
        raise SceneError([Problem(root.mark, "", message)])
    return Node({key: node for key, node in root.value.items() if not _is_for_editors(key, node)}, root.mark)


def _is_for_editors(key: str, node: Node) -> bool:
    """Tell whether a key only tells an editor which schema a file of JSON has, which cannot say so in a comment."""
    return key == "$schema" and isinstance(node.value, str)


def _entries(root: Node) -> dict[str, Node]:
    assert isinstance(root.value, dict)  # by `_mapping`
    return root.value


def _read_text(name: str) -> str:
    """Read a file, never more of it than a scene may have; nor is a pipe opened, whose writer may never come."""
    path = Path(name)
    try:
        if not (path.is_file() or path.is_dir() or _is_open(path)) and path.exists():
            raise _unreadable(name, "this is not a regular file", Remedy("standard input", path))
        with path.open("rb") as file:
            data = file.read(MAX_CHARACTERS + 1)
    except (OSError, ValueError) as error:
        raise _unreadable(name, _reason(error, name)) from None
    return _decoded(data, name)


def _is_open(path: Path) -> bool:
    """Tell whether a path stands for a stream that this process was given, as `/dev/stdin` or `<(…)` of a shell."""
    return path.parent.name == "fd" or path == Path("/dev/stdin")


def _decoded(data: bytes, name: str) -> str:
    """Return the text of a file, which is UTF-8."""
    if data.startswith(_HDF5):
        raise _unreadable(name, "this is a trajectory, not a scene", Remedy("show scene", Path(name)))
    other = next((what for start, what in _OTHERS if data.startswith(start)), None)
    if other is not None:
        raise _unreadable(name, f"this is {other}, not a scene")
    encoding = next((encoding for start, encoding in _ENCODINGS if re.match(start, data, re.DOTALL)), None)
    if encoding is not None:
        raise _unreadable(name, f"the file is {encoding}; save it as UTF-8")
    if len(data) > MAX_CHARACTERS:
        raise _unreadable(name, "the file is larger than 16 MiB")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        lines = re.split(b"\r\n|\r|\n", error.object[: error.start])
        mark = Mark(printable(name), len(lines), len(lines[-1].decode("utf-8", "replace")) + 1)
        message = f"the byte 0x{error.object[error.start]:02x} is not UTF-8; save the file as UTF-8"
        raise SceneError([Problem(mark, "", message)]) from None


def _reason(error: OSError | ValueError, name: str) -> str:
    """Say why a file cannot be opened."""
    if isinstance(error, IsADirectoryError):
        return "this is a folder, not a scene file"
    if isinstance(error, PermissionError):
        return "the file may not be read (permission denied)"
    if isinstance(error, (FileNotFoundError, ValueError)):
        return _no_such_file(name, name)
    return f"the file cannot be read ({error.strerror})"


def _no_such_file(name: str, written: str, got: str = "") -> str:
    """Say that there is no such file, and which one may have been meant, the way it was written."""
    path = Path(name)
    otherwise = [other for other in (name.replace("\\", "/"), _expanded(name)) if other != name]
    for other in otherwise:  # a path of Windows, or a `~` in quotes, which shells leave alone
        if not got and Path(other).is_file():
            return f"there is no such file; did you mean `{printable(other)}`?"
    try:
        neighbours = {
            entry.stem: entry.name for entry in path.parent.iterdir() if entry.suffix in (".yaml", ".yml", ".json")
        }
    except (OSError, ValueError):
        neighbours = {}
    close = suggestion(path.stem, neighbours)
    remedy = f"; did you mean `{printable(str(Path(written).with_name(neighbours[close])))}`?" if close else ""
    return f"there is no such file{got}{remedy}"


def _expanded(name: str) -> str:
    return os.path.expanduser(name)  # noqa: PTH111 - unlike that of Path, it has no error


def _unreadable(name: str, message: str, *remedies: Remedy) -> SceneError:
    return SceneError([Problem(Mark(printable(name), 0, 0), "", message)], *remedies)
