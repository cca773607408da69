"""The header as named plain values, and back with every one checked; knows neither the journal nor HDF5.

The journal writes the values as JSON, the HDF5 file as one dataset each, both under the names given here.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from itertools import pairwise
from typing import Any, Literal, TypeAlias

import numpy as np

from atomsim.core.memory import Layout, MemoryArray
from atomsim.core.model import GroupSpan, Origin
from atomsim.trajectory.guard import DamageError, odd
from atomsim.trajectory.header import AtomNumbers, End, Header, Versions
from atomsim.trajectory.rows import Series

PLAIN, REMEMBERING = 1, 2
"""Versions of the trajectory file; they rise when a file can no longer be read by the program before.

What remembers nothing but positions and velocities is still written in the first.
"""

Kind: TypeAlias = Literal["text", "texts", "whole", "wholes", "real", "flag"]
Document: TypeAlias = dict[str, Any]
"""Plain values by name, each of the kind that `FIELDS` gives it."""

FIELDS: Mapping[str, Kind] = {
    "schema_version": "whole",
    "title": "text",
    "scene_name": "text",
    "scene": "text",
    "overrides": "texts",
    "time_step": "real",
    "n_atoms": "whole",
    "rounds": "whole",
    "record_every": "whole",
    "compress": "flag",
    "group_names": "texts",
    "group_start": "wholes",
    "group_color": "texts",
    "rule_names": "texts",
    "rule_files": "texts",
    "rule_lines": "wholes",
    "program_version": "text",
    "numpy_version": "text",
    "python_version": "text",
    "platform": "text",
}

_PYTHON_TYPE: Mapping[Kind, Any] = {"text": str, "texts": str, "whole": int, "wholes": int, "real": float, "flag": bool}
_LARGEST_TIME_STEP = 1e150  # times of rounds stay finite
_MOST_ATOMS = 2**31 - 1
_MOST_ROUNDS = 2**63 - 1
_MOST_MEMORY = 2**31 - 1  # bytes: a row has a NumPy type, which holds no more


def fields(version: int) -> Mapping[str, Kind]:
    """Return the names and kinds of the plain values that a version of the file has."""
    return FIELDS if version == PLAIN else {**FIELDS, "memory": "texts"}


def document(header: Header) -> Document:
    """Return everything of a header but its bonds, which are arrays, as plain values."""
    version = REMEMBERING if header.memory else PLAIN
    values: Document = {
        "schema_version": version,
        "title": header.title,
        "scene_name": header.scene_name,
        "scene": header.scene,
        "overrides": list(header.overrides),
        "time_step": header.time_step,
        "n_atoms": header.n_atoms,
        "rounds": header.rounds,
        "record_every": header.record_every,
        "compress": header.compress,
        "group_names": [_group_name(group) for group in header.groups],
        "group_start": [group.start for group in header.groups],
        "group_color": [group.color for group in header.groups],
        "rule_names": [f"{origin.section}.{origin.name}" for origin in header.origins],
        "rule_files": [origin.file for origin in header.origins],
        "rule_lines": [origin.line for origin in header.origins],
        "program_version": header.versions.program,
        "numpy_version": header.versions.numpy,
        "python_version": header.versions.python,
        "platform": header.versions.platform,
        "memory": [" ".join((array.name, array.number, *map(str, array.shape))) for array in header.memory],
    }
    return {name: _plain(values[name], kind) for name, kind in fields(version).items()}


def _plain(value: Any, kind: Kind) -> Any:
    """Return a value as Python's own type, for NumPy's numbers and odd file names must not make a file unreadable."""
    if isinstance(value, list):
        return [_plain(part, kind) for part in value]
    return storable(value) if _PYTHON_TYPE[kind] is str else _PYTHON_TYPE[kind](value)


def storable(text: str) -> str:
    """Replace what UTF-8 cannot write and what would end a C string."""
    return text.replace("\0", "\\0").encode("utf-8", "backslashreplace").decode("utf-8")


def check_version(values: Mapping[str, Any]) -> None:
    """Refuse a file that a later program wrote in a form unknown to this one."""
    written = values.get("schema_version")
    if type(written) is int and written > REMEMBERING:
        raise DamageError(
            f"written in version {written} of the trajectory file; this atomsim reads version {REMEMBERING}: "
            "a newer atomsim is needed"
        )
    _require(type(written) is int and written in (PLAIN, REMEMBERING), "schema_version")


def header_from(values: Mapping[str, Any], bond: AtomNumbers, bond_table: AtomNumbers) -> Header:
    """Return the header that a document describes.

    Args:
        values: by name, as in `FIELDS`.
        bond: (n_bonds, 2) int32.
        bond_table: (n_bonds,) int32.

    Raises:
        DamageError: a value is missing, of another kind, or makes no sense.
    """
    check_version(values)
    for name, kind in fields(values["schema_version"]).items():
        _require(_is_kind(values.get(name), kind), name)
    _require(0 < values["time_step"] <= _LARGEST_TIME_STEP, "time_step")
    _require(0 < values["n_atoms"] <= _MOST_ATOMS, "n_atoms")
    _require(0 <= values["rounds"] <= _MOST_ROUNDS, "rounds")
    _require(0 < values["record_every"] <= _MOST_ROUNDS, "record_every")
    origins = _origins(values)
    _check_bonds(bond, bond_table, values["n_atoms"], len(origins))
    return Header(
        title=values["title"],
        scene_name=values["scene_name"],
        scene=values["scene"],
        overrides=tuple(values["overrides"]),
        time_step=values["time_step"],
        n_atoms=values["n_atoms"],
        rounds=values["rounds"],
        record_every=values["record_every"],
        compress=values["compress"],
        groups=_groups(values, origins),
        origins=origins,
        bond=bond,
        bond_table=bond_table,
        versions=Versions(
            values["program_version"], values["numpy_version"], values["python_version"], values["platform"]
        ),
        memory=() if values["schema_version"] == PLAIN else _layout(values["memory"]),
    )


def end_from(values: Mapping[str, Any]) -> End:
    """Return the end that the plain values `end` and `end_report` describe."""
    kind, report = values.get("end"), values.get("end_report")
    if kind in ("finished", "interrupted", "blew up", "killed") and isinstance(report, str):
        return End(kind, report)
    raise odd("`end` makes no sense")


def contents_digest(header: Header, end: End, series: Series) -> str:
    """Return SHA-256 over all of a trajectory but positions and velocities, which the state digests in it cover."""
    texts = {**document(header), "end": end.kind, "end_report": storable(end.report)}
    digest = hashlib.sha256(json.dumps(texts).encode())
    for array in (header.bond, header.bond_table, series):
        digest.update(array.tobytes())
    return digest.hexdigest()


def _is_kind(value: Any, kind: Kind) -> bool:
    parts = value if isinstance(value, list) else [value]
    is_list = kind in ("texts", "wholes")
    return isinstance(value, list) == is_list and all(type(part) is _PYTHON_TYPE[kind] for part in parts)


def _origins(values: Mapping[str, Any]) -> tuple[Origin, ...]:
    names, files, lines = values["rule_names"], values["rule_files"], values["rule_lines"]
    _require(len(names) == len(files) == len(lines), "rule_lines")
    _require(all("." in name for name in names), "rule_names")
    sections = [name.partition(".") for name in names]
    rows = zip(sections, files, lines, strict=True)
    return tuple(Origin(section, name, file, line) for (section, _, name), file, line in rows)


def _groups(values: Mapping[str, Any], origins: tuple[Origin, ...]) -> tuple[GroupSpan, ...]:
    names, starts, colors = values["group_names"], values["group_start"], values["group_color"]
    _require(0 < len(names) == len(starts) == len(colors) <= len(origins), "group_names")
    limits = [*starts, values["n_atoms"]]
    _require(starts[0] == 0 and all(start < stop for start, stop in pairwise(limits)), "group_start")
    _require(all(re.fullmatch("#[0-9a-fA-F]{6}", color) for color in colors), "group_color")
    found = [re.fullmatch(r"(.*?)(?: × ([1-9][0-9]{0,9}))?", name, re.DOTALL | re.ASCII) for name in names]
    copies = [(match[1], int(match[2] or 1)) for match in found if match]
    _require(
        all((stop - start) % n == 0 for (start, stop), (_, n) in zip(pairwise(limits), copies, strict=True)),
        "group_names",
    )
    spans = zip(copies, pairwise(limits), colors, origins[: len(names)], strict=True)
    return tuple(GroupSpan(name, start, stop, color, origin, n) for (name, n), (start, stop), color, origin in spans)


def _group_name(group: GroupSpan) -> str:
    """Return a group's name, and its number of copies if it has any: `finger × 3`."""
    return group.name if group.n_copies == 1 else f"{group.name} × {group.n_copies}"


def _layout(texts: list[str]) -> Layout:
    """Read arrays written as `controllers.gait.phase float64 3`; there is one at least."""
    found = [re.fullmatch(r"([A-Za-z][\w.-]*) (float64|int64|bool)((?: \d{1,10})*)", text, re.ASCII) for text in texts]
    layout = [MemoryArray(m[1], m[2], tuple(map(int, m[3].split()))) for m in found if m]  # type: ignore[arg-type]
    _require(0 < len(layout) == len(texts) == len({array.name for array in layout}), "memory")
    _require(sum(array.n_bytes for array in layout) <= _MOST_MEMORY, "memory")
    return tuple(layout)


def _check_bonds(bond: AtomNumbers, bond_table: AtomNumbers, n_atoms: int, n_origins: int) -> None:
    first, second = bond.T
    _require(len(bond) == len(bond_table), "bond_table")
    _require(bool(np.all((first >= 0) & (first < second) & (second < n_atoms))), "bonds")
    _require(bool(np.all((bond_table >= 0) & (bond_table < n_origins))), "bond_table")


def _require(holds: bool, name: str) -> None:
    if not holds:
        raise odd(f"`{name}` makes no sense")
