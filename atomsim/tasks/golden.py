"""Golden trajectories: what a scene gave when it was last approved, to the last bit.

A golden is a small text file: the state digest of every recorded round, so that the first differing round is known,
and a few full frames, so that the differing atom is. Full frames grow sparser with the rounds, because a difference
spreads: what a changed law does to one atom in round 10 has reached all of them by round 4000.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from atomsim.core.model import Floats, Frame, GroupSpan, State
from atomsim.disk import check_regular, write_whole
from atomsim.errors import InputError, Remedy
from atomsim.tasks.compare import Difference, frame_difference

LAYOUT = 1
"""Version of the golden file."""

LOG = "LOG.md"
"""The file beside the goldens that says why each was recorded."""


FOLDER = "golden"
"""The folder beside a scene in which its golden lies, unless another is named."""


@dataclass(frozen=True, slots=True, eq=False)
class Golden:
    """An approved trajectory.

    Attributes:
        digests: the state digest of every recorded round.
        frames: position and velocity of a few rounds, each (2, n_atoms, 3) float64.
    """

    digests: dict[int, str]
    frames: dict[int, Floats]


def golden_path(scene: Path, folder: Path | None) -> Path:
    """Return where the golden of a scene lies: in a folder, by default in `golden` beside the scene."""
    return (scene.parent / FOLDER if folder is None else folder) / f"{scene.stem}.golden.json"


def record_golden(frames: Iterable[Frame]) -> Golden:
    """Make a golden of a run: all digests, and frames 0, 1, 4, 16, 64 … and the last in full."""
    digests: dict[int, str] = {}
    full: dict[int, Floats] = {}
    frame: Frame | None = None
    next_full = 0
    for number, frame in enumerate(frames):
        digests[frame.round_index] = frame.digest
        if number == next_full:
            next_full = max(1, 4 * number)
            full[frame.round_index] = np.stack((frame.position, frame.velocity))
    assert frame is not None  # a run has at least its first frame
    full[frame.round_index] = np.stack((frame.position, frame.velocity))
    return Golden(digests, full)


def check_golden(golden: Golden, frames: Iterable[Frame], groups: Sequence[GroupSpan]) -> str | None:
    """Compare a run with its golden, bit for bit, as far as needed to name the round and the atom.

    Returns:
        What differs, for people, or None.
    """
    first_wrong: int | None = None
    n_frames = 0
    for frame in frames:
        n_frames += 1
        if frame.round_index not in golden.digests:
            return f"round {frame.round_index} is not in the golden"
        if first_wrong is None and frame.digest != golden.digests[frame.round_index]:
            first_wrong = frame.round_index
        if first_wrong is not None and frame.round_index in golden.frames:
            return _describe(first_wrong, _difference(golden, frame, groups))
    if n_frames < len(golden.digests):
        return f"the run has {n_frames} frames, the golden {len(golden.digests)}"
    return None if first_wrong is None else _describe(first_wrong, None)


def _difference(golden: Golden, frame: Frame, groups: Sequence[GroupSpan]) -> Difference | None:
    position, velocity = golden.frames[frame.round_index]
    if position.shape != frame.position.shape:
        n_atoms = len(position), len(frame.position)
        return Difference(frame.round_index, f"the golden has {n_atoms[0]} atoms, the scene {n_atoms[1]}")
    approved = replace(frame, state=State(frame.round_index, position, velocity, frame.memory), digest="")
    difference = frame_difference(approved, frame, groups)
    if difference is None and frame.memory and frame.digest != golden.digests[frame.round_index]:
        what = "positions and velocities agree, what else is remembered does not"
        return Difference(frame.round_index, f"round {frame.round_index}: {what}")
    return difference


def _describe(first_wrong: int, difference: Difference | None) -> str:
    """Say which round differs first, and which atom in the next round that is known in full."""
    return f"differs from round {first_wrong} on" + (f"; {difference}" if difference else "")


def write_golden(golden: Golden, path: Path) -> None:
    """Write a golden as text, one round a line, whole or not at all.

    Raises:
        RunError: the disk does not take it; what stood under the name before is untouched.
    """
    document = {
        "golden": LAYOUT,
        "digests": {str(number): digest for number, digest in golden.digests.items()},
        "frames": {
            str(number): base64.b64encode(frame.astype("<f8").tobytes()).decode()
            for number, frame in golden.frames.items()
        },
    }
    write_whole(path, f"{json.dumps(document, indent=0)}\n".encode())


def read_golden(path: Path) -> Golden:
    """Read a golden.

    Raises:
        InputError: it is no golden.
    """
    check_regular(path)
    try:
        document: dict[str, Any] = json.loads(path.read_text())
        if document["golden"] != LAYOUT:
            raise ValueError
        return Golden(
            {int(number): digest for number, digest in document["digests"].items()},
            dict(_frames(document["frames"])),
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        raise InputError(f"{path}: is not a golden trajectory", Remedy("record golden")) from None


def _frames(encoded: dict[str, str]) -> Iterator[tuple[int, Floats]]:
    for number, text in encoded.items():
        yield int(number), np.frombuffer(base64.b64decode(text), dtype="<f8").reshape(2, -1, 3)
