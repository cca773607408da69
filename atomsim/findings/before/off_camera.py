"""Groups that move where the camera does not look."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.outlook import Outlook
from atomsim.core.model import Floats, GroupSpan, Indices
from atomsim.drawing.camera import Camera, View, direction_of, is_before_eye
from atomsim.errors import InputError
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import listed, verb

N_SHOWN = 6
"""So many rounds, evenly spread, stand for those that a strip shows by itself."""

SLACK = 1.2
"""A body that is held somewhere stretches by no more than this, times its extent."""


def off_camera(subject: Subject) -> Iterator[Symptom]:
    """Find moving groups that are in the picture in one of the rounds shown at most, where a camera is written.

    What cannot be foreseen, as after a first contact, is left to be judged after the run. The usual direction stands
    for one that the run will choose.
    """
    written = subject.scene.render.camera
    if written.look_at is None or written.width is None:
        return
    try:
        direction = direction_of(written.view, written.azimuth, written.elevation, written.up)
        view = View(*direction, written.up, written.look_at, written.width)
    except InputError:
        return  # who draws complains of numbers beyond all scenes
    camera = Camera.of(view, written.look_at, written.width)
    rounds = _shown(subject)
    missing = [span for span in subject.model.groups if _is_missing(subject, span, camera, rounds)]
    if missing and len(rounds) > 1:
        names = [span.name for span in missing]
        centre = np.concatenate([subject.state.position[span.start : span.stop] for span in missing]).mean(axis=0)
        yield Symptom(
            at=("render", "camera"),
            names=(("render", "camera"), *(("groups", name) for name in names)),
            message=(
                f"{listed(names)} {verb(names, 'moves', 'move')} where the camera does not look: it shows "
                f"{written.width:g} around {list(written.look_at)}, and {verb(names, 'it starts', 'they start')} "
                f"around {[round(x, 2) + 0.0 for x in centre.tolist()]}"
            ),
            remedy={"render": {"camera": {"look_at": None, "width": None}}},
            rounds=tuple(rounds),
        )


def _shown(subject: Subject) -> list[int]:
    """Return the rounds that the strip shows."""
    last = subject.scene.rounds
    chosen = subject.scene.render.rounds
    if chosen is not None:
        return [round_index for round_index in chosen if round_index <= last]
    return sorted({place * last // (N_SHOWN - 1) for place in range(N_SHOWN)})


def _is_missing(subject: Subject, span: GroupSpan, camera: Camera, rounds: list[int]) -> bool:
    """Return whether a group moves and is surely in at most one of the pictures."""
    atoms = np.arange(span.start, span.stop)
    position, velocity = subject.state.position[atoms], subject.state.velocity[atoms]
    if subject.is_held[atoms].all():
        ways = [subject.model.time_step * round_index * velocity for round_index in rounds]
        return bool(velocity.any()) and sum(_is_seen(camera, position + way) for way in ways) <= 1
    held = np.flatnonzero(subject.is_held & (subject.body == subject.body[atoms[0]]))
    if held.size:
        drift = subject.model.time_step * subject.state.velocity[held]
        is_known = bool((drift == drift[0]).all())  # else it is torn apart
        return is_known and not any(
            _may_be_seen(subject, camera, position, held, round_index * drift[0]) for round_index in rounds
        )
    ahead = [each for each in subject.outlooks if np.isin(each.mover.atoms, atoms).any()]
    if not ahead or any(not _is_foreseen(each, rounds[-1]) for each in ahead):
        return False
    if not any(each.mover.flight.at(float(rounds[-1]))[0].any() for each in ahead):
        return False
    seen = [any(_is_seen(camera, _at(subject, each, round_index)) for each in ahead) for round_index in rounds]
    return sum(seen) <= 1


def _is_foreseen(ahead: Outlook, last: int) -> bool:
    return not ahead.mover.is_turning and (ahead.first is None or ahead.first.round_index > last)


def _at(subject: Subject, ahead: Outlook, round_index: int) -> Floats:
    return np.asarray(subject.state.position[ahead.mover.atoms] + ahead.mover.flight.at(float(round_index))[0])


def _is_seen(camera: Camera, position: Floats) -> bool:
    """Return whether any ball is in the picture, taken to be as high as it is wide."""
    seen = camera.see(position)
    seen = seen[:, is_before_eye(seen, camera.convergence)]
    scale = 1.0 - camera.convergence * seen[2]
    half = 0.5 * camera.width + 1.0 / scale
    return bool(((np.abs(seen[0] / scale) < half) & (np.abs(seen[1] / scale) < half)).any())


def _may_be_seen(subject: Subject, camera: Camera, position: Floats, held: Indices, way: Floats) -> bool:
    """Return whether a group that hangs on held atoms can be in the picture when these have gone some way.

    It stays in a ball about them.
    """
    anchor = subject.state.position[held].mean(axis=0)
    reach = SLACK * math.sqrt(float(np.square(position - anchor).sum(axis=1).max())) + 1.0
    seen = camera.see((anchor + way)[None, :])[:, 0]
    nearness = max(1.0 - camera.convergence * (float(seen[2]) + reach), 1e-3)
    half = 0.5 * camera.width + reach / nearness
    return bool((np.abs(seen[:2] / max(1.0 - camera.convergence * float(seen[2]), 1e-3)) < half).all())
