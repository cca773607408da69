"""The header: what a trajectory says besides its frames, as named plain values that are checked when they are read.

The fields of `Header` are the one list of these values: the journal writes those that are no arrays as JSON, the HDF5
file as one dataset each, under the names and in the order given here.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import platform
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.memory import Layout, MemoryArray
from atomsim.core.model import GroupSpan, Model, Origin
from atomsim.trajectory.guard import DamageError, odd
from atomsim.trajectory.rows import Series
from atomsim.version import __version__, is_later

PLAIN, REMEMBERING = 1, 2
"""Versions of the trajectory file; they rise when a file can no longer be read by the program before.

What remembers nothing but positions and velocities is still written in the first.
"""

AtomNumbers: TypeAlias = NDArray[np.int32]
"""Numbers of atoms as H5MD and VMD want them: 32 bits."""

Author: TypeAlias = str
"""A text that H5MD has a place for, so it is none of the values by name."""

EndKind: TypeAlias = Literal["finished", "interrupted", "blew up", "killed"]

_COPIED = re.compile(r"(.*?)(?: × ([1-9][0-9]{0,9}))?", re.DOTALL)
_LARGEST_TIME_STEP = 1e150  # times of rounds stay finite
_MOST_ATOMS = 2**31 - 1
_MOST_ROUNDS = 2**63 - 1
_MOST_MEMORY = 2**31 - 1  # bytes: a row has a NumPy type, which holds no more


@dataclass(frozen=True, slots=True)
class End:
    """How a run ended.

    Attributes:
        kind: `killed` is never written down: it is what a journal says that nobody ended.
        report: more about it, for the user; may be empty.
    """

    kind: EndKind
    report: str = ""


@dataclass(frozen=True, eq=False)
class Header:
    """All that stays constant in a trajectory; the same for any two runs of a scene on one machine.

    Attributes:
        schema_version: version of the form of the file.
        title: what the scene calls itself.
        scene_name: the scene's file as the user named it.
        scene: the resolved scene as YAML; reading it gives the same scene.
        overrides: the `PATH=VALUE` settings that the scene was run with.
        time_step: τ [time].
        n_atoms: number of atoms.
        rounds: iteration rounds that the run is to do.
        record_every: rounds between two frames.
        compress: whether the finished file is compressed.
        group_names: the groups, in order, a copied one as `finger × 3`; together they hold every atom.
        group_start: the first atom of each.
        group_color: `#rrggbb` of each, for whoever draws the file without its scene.
        rule_names: every declaration, as `bonds.left`: the groups, then bonds, collisions and forces, each in order.
        rule_files: the file in which each stands.
        rule_lines: the line on which each stands.
        program_version: the atomsim that made it.
        numpy_version: the NumPy that it used.
        python_version: the Python.
        platform: the kind of machine.
        memory: what the run remembers besides positions and velocities, as `controllers.gait.phase float64 3`.
        bond: the pairs that are bound, first < second, (n_bonds, 2) int32.
        bond_table: which declaration made each pair, (n_bonds,) int32.
        author: whom the file names; no part of its digest, so that anybody may write a name into a finished file.
    """

    schema_version: int
    title: str
    scene_name: str
    scene: str
    overrides: tuple[str, ...]
    time_step: float
    n_atoms: int
    rounds: int
    record_every: int
    compress: bool
    group_names: tuple[str, ...]
    group_start: tuple[int, ...]
    group_color: tuple[str, ...]
    rule_names: tuple[str, ...]
    rule_files: tuple[str, ...]
    rule_lines: tuple[int, ...]
    program_version: str
    numpy_version: str
    python_version: str
    platform: str
    memory: tuple[str, ...]
    bond: AtomNumbers
    bond_table: AtomNumbers
    author: Author = "unknown"

    @classmethod
    def of(
        cls,
        model: Model,
        *,
        group_color: Sequence[str],
        scene_text: str,
        scene_name: str,
        overrides: tuple[str, ...] = (),
        rounds: int,
        record_every: int,
        compress: bool = False,
    ) -> Header:
        """Return the header of the run that is about to begin.

        Args:
            model: the compiled scene.
            group_color: `#rrggbb` of each group.
            scene_text: the resolved scene as YAML.
            scene_name: the scene's file as the user named it.
            overrides: the `PATH=VALUE` settings in effect, as written.
            rounds: iteration rounds to do.
            record_every: rounds between two frames.
            compress: whether to compress the finished file (shuffle and gzip 1: about 15 % smaller, far slower).
        """
        origins = [entry.origin for entry in (*model.groups, *model.bonds, *model.collisions, *model.forces)]
        pairs = [np.column_stack((table.first, table.second)) for table in model.bonds]
        tables = [np.full(len(pair), len(model.groups) + i) for i, pair in enumerate(pairs)]
        return cls(
            schema_version=REMEMBERING if model.memory else PLAIN,
            title=model.title,
            scene_name=scene_name,
            scene=scene_text,
            overrides=overrides,
            time_step=model.time_step,
            n_atoms=model.n_atoms,
            rounds=rounds,
            record_every=record_every,
            compress=compress,
            group_names=tuple(_with_copies(group) for group in model.groups),
            group_start=tuple(group.start for group in model.groups),
            group_color=tuple(group_color),
            rule_names=tuple(f"{origin.section}.{origin.name}" for origin in origins),
            rule_files=tuple(origin.file for origin in origins),
            rule_lines=tuple(origin.line for origin in origins),
            program_version=__version__,
            numpy_version=np.__version__,
            python_version=".".join(str(part) for part in sys.version_info[:3]),
            platform=f"{platform.system()} {platform.machine()}",
            memory=tuple(" ".join((array.name, array.number, *map(str, array.shape))) for array in model.memory),
            bond=np.concatenate([np.empty((0, 2), int), *pairs], dtype="<i4"),
            bond_table=np.concatenate([np.empty(0, int), *tables], dtype="<i4"),
        )

    @cached_property
    def origins(self) -> tuple[Origin, ...]:
        """Every declaration: those of the groups, then of bonds, collisions and forces."""
        sections = [name.partition(".") for name in self.rule_names]
        rows = zip(sections, self.rule_files, self.rule_lines, strict=True)
        return tuple(Origin(section, name, file, line) for (section, _, name), file, line in rows)

    @cached_property
    def groups(self) -> tuple[GroupSpan, ...]:
        """Spans of atoms, in order."""
        names = [_COPIED.fullmatch(name) for name in self.group_names]
        spans = zip(names, pairwise((*self.group_start, self.n_atoms)), self.origins, strict=False)
        return tuple(
            GroupSpan(name[1], start, stop, origin, int(name[2] or 1)) for name, (start, stop), origin in spans if name
        )

    @cached_property
    def layout(self) -> Layout:
        """The arrays that the run remembers."""
        parts = [text.split(" ") for text in self.memory]
        return tuple(MemoryArray(name, number, tuple(map(int, shape))) for name, number, *shape in parts)  # type: ignore[arg-type]

    @property
    def is_later(self) -> bool:
        """Whether a later version of the program made it, which may compute something else."""
        return is_later(self.program_version)

    def records(self, round_index: int) -> bool:
        """Tell whether a run that nothing stops keeps this round as a frame."""
        return round_index % self.record_every == 0 or round_index == self.rounds


def _with_copies(group: GroupSpan) -> str:
    """Return a group's name, and its number of copies if it has any: `finger × 3`."""
    return group.name if group.n_copies == 1 else f"{group.name} × {group.n_copies}"


Kind: TypeAlias = Literal["text", "texts", "whole", "wholes", "real", "flag"]
Document: TypeAlias = dict[str, Any]
"""The plain values of a header by name."""

_KINDS: Mapping[str, Kind] = {
    "str": "text",
    "tuple[str, ...]": "texts",
    "int": "whole",
    "tuple[int, ...]": "wholes",
    "float": "real",
    "bool": "flag",
}
_PYTHON_TYPE: Mapping[Kind, Any] = {"text": str, "texts": str, "whole": int, "wholes": int, "real": float, "flag": bool}

_FIELDS: Mapping[str, Kind] = {
    field.name: _KINDS[str(field.type)] for field in dataclasses.fields(Header) if field.type in _KINDS
}


def fields(version: int) -> Mapping[str, Kind]:
    """Return the names and kinds of the plain values that a version of the file has."""
    return {name: kind for name, kind in _FIELDS.items() if version > PLAIN or name != "memory"}


def document(header: Header) -> Document:
    """Return everything of a header but its bonds, which are arrays, as plain values."""
    return {name: _plain(getattr(header, name), kind) for name, kind in fields(header.schema_version).items()}


def _plain(value: Any, kind: Kind) -> Any:
    """Return a value as Python's own type, for NumPy's numbers and odd file names must not make a file unreadable."""
    if isinstance(value, tuple):
        return [_plain(part, kind) for part in value]
    return storable(value) if _PYTHON_TYPE[kind] is str else _PYTHON_TYPE[kind](value)


def storable(text: str) -> str:
    """Replace what UTF-8 cannot write and what would end a C string."""
    return text.replace("\0", "\\0").encode("utf-8", "backslashreplace").decode("utf-8")


def contents_digest(header: Header, end: End, series: Series) -> str:
    """Return SHA-256 over all of a trajectory but positions and velocities, which the state digests in it cover."""
    texts = {**document(header), "end": end.kind, "end_report": storable(end.report)}
    digest = hashlib.sha256(json.dumps(texts).encode())
    for array in (header.bond, header.bond_table, series):
        digest.update(array.tobytes())
    return digest.hexdigest()


def check_version(values: Mapping[str, Any]) -> None:
    """Refuse a file that a later program wrote in a form unknown to this one."""
    written = values.get("schema_version")
    if type(written) is int and written > REMEMBERING:
        raise DamageError(
            f"written in version {written} of the trajectory file; this atomsim reads version {REMEMBERING}: "
            "a newer atomsim is needed"
        )
    _require(type(written) is int and written in (PLAIN, REMEMBERING), "schema_version")


def header_from(
    values: Mapping[str, Any], bond: AtomNumbers, bond_table: AtomNumbers, author: object = "unknown"
) -> Header:
    """Return the header that a document describes.

    Args:
        values: by name, as `document` returns them.
        bond: (n_bonds, 2) int32.
        bond_table: (n_bonds,) int32.
        author: whom the file names.

    Raises:
        DamageError: a value is missing, of another kind, or makes no sense.
    """
    check_version(values)
    found: Document = {"memory": ()}
    for name, kind in fields(values["schema_version"]).items():
        value = values.get(name)
        _require(_is_kind(value, kind), name)
        found[name] = tuple(value) if isinstance(value, list) else value
    _require(isinstance(author, str), "author")
    header = Header(**found, bond=bond, bond_table=bond_table, author=storable(str(author)))
    _check(header)
    return header


def end_from(values: Mapping[str, Any]) -> End:
    """Return the end that the plain values `end` and `end_report` describe."""
    kind, report = values.get("end"), values.get("end_report")
    if kind in ("finished", "interrupted", "blew up", "killed") and isinstance(report, str):
        return End(kind, report)
    raise odd("`end` makes no sense")


def _is_kind(value: Any, kind: Kind) -> bool:
    parts = value if isinstance(value, list) else [value]
    is_list = kind in ("texts", "wholes")
    return isinstance(value, list) == is_list and all(type(part) is _PYTHON_TYPE[kind] for part in parts)


def _check(header: Header) -> None:
    """Refuse values that make no sense, or none beside the others."""
    _require(0 < header.time_step <= _LARGEST_TIME_STEP, "time_step")
    _require(0 < header.n_atoms <= _MOST_ATOMS, "n_atoms")
    _require(0 <= header.rounds <= _MOST_ROUNDS, "rounds")
    _require(0 < header.record_every <= _MOST_ROUNDS, "record_every")
    _require(len(header.rule_names) == len(header.rule_files) == len(header.rule_lines), "rule_lines")
    _require(all("." in name for name in header.rule_names), "rule_names")
    n_groups, n_rules = len(header.group_names), len(header.rule_names)
    _require(0 < n_groups == len(header.group_start) == len(header.group_color) <= n_rules, "group_names")
    limits = (*header.group_start, header.n_atoms)
    _require(limits[0] == 0 and all(start < stop for start, stop in pairwise(limits)), "group_start")
    _require(all(re.fullmatch("#[0-9a-fA-F]{6}", color) for color in header.group_color), "group_color")
    _require(all((group.stop - group.start) % group.n_copies == 0 for group in header.groups), "group_names")
    if header.schema_version > PLAIN:
        _check_memory(header)
    first, second = header.bond.T
    _require(len(header.bond) == len(header.bond_table), "bond_table")
    _require(bool(np.all((first >= 0) & (first < second) & (second < header.n_atoms))), "bonds")
    _require(bool(np.all((header.bond_table >= 0) & (header.bond_table < n_rules))), "bond_table")


def _check_memory(header: Header) -> None:
    form = r"([A-Za-z][\w.-]*) (float64|int64|bool)((?: \d{1,10})*)"
    _require(len(header.memory) > 0 and all(re.fullmatch(form, text, re.ASCII) for text in header.memory), "memory")
    _require(len({array.name for array in header.layout}) == len(header.layout), "memory")
    _require(sum(array.n_bytes for array in header.layout) <= _MOST_MEMORY, "memory")


def _require(holds: bool, name: str) -> None:
    if not holds:
        raise odd(f"`{name}` makes no sense")
