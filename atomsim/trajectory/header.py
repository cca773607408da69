"""What a trajectory says besides its frames; knows neither the journal nor HDF5."""

from __future__ import annotations

import platform
import re
import sys
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.memory import Layout
from atomsim.core.model import GroupSpan, Model, Origin
from atomsim.version import __version__

AtomNumbers: TypeAlias = NDArray[np.int32]
"""Numbers of atoms as H5MD and VMD want them: 32 bits."""

BYTES_PER_ATOM = 48
"""Position and velocity in a frame: three float64 each."""

BYTES_PER_FRAME = 256
"""What a frame takes besides: round, digest, observables."""

EndKind: TypeAlias = Literal["finished", "interrupted", "blew up", "killed"]


@dataclass(frozen=True, slots=True)
class End:
    """How a run ended.

    Attributes:
        kind: `killed` is never written down: it is what a journal says that nobody ended.
        report: more about it, for the user; may be empty.
    """

    kind: EndKind
    report: str = ""


@dataclass(frozen=True, slots=True)
class Versions:
    """The programs and the kind of machine that a run used: what may explain a difference between two of them."""

    program: str
    numpy: str
    python: str
    platform: str

    @property
    def is_later(self) -> bool:
        """Whether the program is a later one than this, which may compute something else."""
        return _release(self.program) > _release(__version__)

    @classmethod
    def here(cls) -> Versions:
        """Return the versions in use now."""
        return cls(
            program=__version__,
            numpy=np.__version__,
            python=".".join(str(part) for part in sys.version_info[:3]),
            platform=f"{platform.system()} {platform.machine()}",
        )


def _release(version: str) -> list[int]:
    """Return the numbers of a version; of a text that is none, nothing, which is never later."""
    found = re.match(r"[0-9]{1,9}(\.[0-9]{1,9})*", version)
    return [int(number) for number in found[0].split(".")] if found else []


@dataclass(frozen=True, slots=True, eq=False)
class Header:
    """All that stays constant in a trajectory; the same for any two runs of a scene on one machine.

    Attributes:
        title: what the scene calls itself.
        scene_name: the scene's file as the user named it.
        scene: the resolved scene as YAML; reading it gives the same scene.
        overrides: the `PATH=VALUE` settings that the scene was run with.
        time_step: τ [time].
        n_atoms: number of atoms.
        rounds: iteration rounds that the run is to do.
        record_every: rounds between two frames.
        compress: whether the finished file is compressed.
        groups: spans of atoms, in order; together they hold every atom.
        origins: every declaration: those of the groups, then of bonds, collisions and forces, each in order.
        bond: the pairs that are bound, first < second, (n_bonds, 2) int32.
        bond_table: which of `origins` declared each pair, (n_bonds,) int32.
        versions: what the run was made with.
        memory: what the run remembers besides positions and velocities.
    """

    title: str
    scene_name: str
    scene: str
    overrides: tuple[str, ...]
    time_step: float
    n_atoms: int
    rounds: int
    record_every: int
    compress: bool
    groups: tuple[GroupSpan, ...]
    origins: tuple[Origin, ...]
    bond: AtomNumbers
    bond_table: AtomNumbers
    versions: Versions
    memory: Layout = ()

    @classmethod
    def of(
        cls,
        model: Model,
        *,
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
            scene_text: the resolved scene as YAML.
            scene_name: the scene's file as the user named it.
            overrides: the `PATH=VALUE` settings in effect, as written.
            rounds: iteration rounds to do.
            record_every: rounds between two frames.
            compress: whether to compress the finished file (shuffle and gzip 1: about 15 % smaller, far slower).
        """
        of_groups = tuple(group.origin for group in model.groups)
        of_bonds = tuple(table.origin for table in model.bonds)
        of_rest = tuple(entry.origin for entry in (*model.collisions, *model.forces))
        pairs = [np.column_stack((table.first, table.second)) for table in model.bonds]
        rows = [np.full(len(pair), len(of_groups) + i) for i, pair in enumerate(pairs)]
        return cls(
            title=model.title,
            scene_name=scene_name,
            scene=scene_text,
            overrides=overrides,
            time_step=model.time_step,
            n_atoms=model.n_atoms,
            rounds=rounds,
            record_every=record_every,
            compress=compress,
            groups=model.groups,
            origins=of_groups + of_bonds + of_rest,
            bond=np.concatenate([np.empty((0, 2), int), *pairs], dtype="<i4"),
            bond_table=np.concatenate([np.empty(0, int), *rows], dtype="<i4"),
            versions=Versions.here(),
            memory=model.memory,
        )

    def records(self, round_index: int) -> bool:
        """Tell whether a run that nothing stops keeps this round as a frame."""
        return round_index % self.record_every == 0 or round_index == self.rounds


def count_frames(rounds: int, record_every: int) -> int:
    """Return how many frames a run keeps that nothing stops: the first, those `record_every` rounds apart, the last."""
    return (rounds - 1) // record_every + 2


def trajectory_bytes(n_atoms: int, rounds: int, record_every: int, layout: Layout = ()) -> int:
    """Return about how large the trajectory of a run becomes, without compression."""
    n_bytes = n_atoms * BYTES_PER_ATOM + BYTES_PER_FRAME + sum(array.n_bytes for array in layout)
    return count_frames(rounds, record_every) * n_bytes
