"""A frame as one row of a fixed number of bytes, little-endian; knows no file."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from atomsim.core.digest import state_digest
from atomsim.core.model import Floats, Frame, Observables
from atomsim.trajectory.guard import DamageError

SERIES = np.dtype(
    [
        ("round", "<i8"),
        ("digest", "S64"),
        ("kinetic_energy", "<f8"),
        ("potential_energy_bonds", "<f8"),
        ("potential_energy_collisions", "<f8"),
        ("momentum", "<f8", (3,)),
        ("angular_momentum", "<f8", (3,)),
        ("contacts", "<f8"),
    ]
)
"""What is known of a frame besides its atoms."""

OBSERVABLES: tuple[str, ...] = SERIES.names[2:]  # type: ignore[index]
"""The names of the observables, as in `Observables`."""

Series: TypeAlias = NDArray[np.void]
"""An array of dtype `SERIES`, (n_frames,)."""
Rows: TypeAlias = NDArray[np.void]
"""An array of dtype `row_dtype(n_atoms)`, (n_frames,)."""


def row_dtype(n_atoms: int) -> np.dtype[np.void]:
    """Return the layout of one frame: its series, then positions, then velocities."""
    return np.dtype([("series", SERIES), ("position", "<f8", (n_atoms, 3)), ("velocity", "<f8", (n_atoms, 3))])


def fill(row: Any, frame: Frame) -> None:
    """Copy a frame into a row.

    Raises:
        ValueError: the frame has another number of atoms.
    """
    if not frame.position.shape == frame.velocity.shape == row["position"].shape:
        raise ValueError(f"a frame of shape {frame.position.shape} in a trajectory of {row['position'].shape}")
    row["series"] = (frame.round_index, frame.digest, *(getattr(frame.observables, name) for name in OBSERVABLES))
    row["position"] = frame.position
    row["velocity"] = frame.velocity


def frame_of(series: Any, position: Floats, velocity: Floats, time_step: float) -> Frame:
    """Return the frame that its parts describe, after checking that they are what was once written.

    Args:
        series: one element of an array of dtype `SERIES`.
        position: atom centres [length], (n_atoms, 3) float64; becomes the frame's.
        velocity: [length per unit of time], (n_atoms, 3) float64; becomes the frame's.
        time_step: τ [time].

    Raises:
        DamageError: position and velocity do not have the digest in the series.
    """
    round_index = int(series["round"])
    digest = state_digest(position, velocity)
    if series["digest"] != digest.encode():
        raise DamageError(f"damaged: the state at round {round_index} does not match its digest")
    return Frame(
        round_index=round_index,
        time=round_index * time_step,
        position=position,
        velocity=velocity,
        digest=digest,
        observables=Observables(
            kinetic_energy=float(series["kinetic_energy"]),
            potential_energy_bonds=float(series["potential_energy_bonds"]),
            potential_energy_collisions=float(series["potential_energy_collisions"]),
            momentum=series["momentum"].copy(),
            angular_momentum=series["angular_momentum"].copy(),
            contacts=int(series["contacts"]),
        ),
    )


def check_rounds(series: Series) -> None:
    """Refuse frames that do not follow each other in time.

    Raises:
        DamageError: a round is negative, or not later than the one before.
    """
    rounds = series["round"]
    if np.any(rounds[:1] < 0) or np.any(rounds[1:] <= rounds[:-1]):
        raise DamageError("damaged: the rounds of its frames do not increase")
