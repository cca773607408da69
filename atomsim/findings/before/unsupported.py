"""Bodies that a lasting force carries away, past everything that they may touch."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.diagnosis.flight import Drive, Flight, Mover
from atomsim.core.diagnosis.outlook import CONTACT, Outlook
from atomsim.core.model import Floats, OscillateForce, PushForce, TetherForce, TorqueForce, TowardsForce
from atomsim.findings.finding import Remedy, Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import direction_in_words, listed, verb
from atomsim.scene.language.forces import Gravity

FARTHEST_OUT = 2.0
"""A body that may touch nothing may fall so far out of the scene [length]."""

UPRIGHT = 0.5
"""Gravity whose direction has less than this part of its length along the way down is not what falls are like."""


def unsupported(subject: Subject) -> Iterator[Symptom]:
    """Find bodies that a lasting force carries past all they may touch, however far, or out of the scene."""
    for ahead in subject.outlooks:
        lasting = ahead.mover.flight.lasting
        drive = _strongest(ahead.mover.flight, lasting)
        if drive is None or drive.from_round > 0.0 or (ahead.mover.is_turning and ahead.meetings):
            continue
        if not ahead.partners.size:
            if _is_gravity(subject, drive) and _leaves(subject, ahead.mover, lasting):
                yield _alone(subject, ahead, drive)
        elif not ahead.meetings and not _may_be_caught(subject, ahead):
            yield _missed(subject, ahead, drive)


def _strongest(flight: Flight, lasting: Floats) -> Drive | None:
    """Return the push that does most of what lasts, or None where nothing does."""
    drives = [drive for drive in flight.drives if np.isinf(drive.until_round)]
    if not drives or not lasting.any():
        return None
    return max(drives, key=lambda drive: float(drive.impulse @ lasting))


def _is_gravity(subject: Subject, drive: Drive) -> bool:
    return isinstance(subject.scene.forces[drive.force.origin.name], Gravity)


def _leaves(subject: Subject, mover: Mover, lasting: Floats) -> bool:
    """Return whether a body that may touch nothing is out of the scene by the end of the run."""
    along = lasting / np.sqrt(lasting @ lasting)
    height = subject.state.position @ along
    way = float(along @ mover.flight.at(float(subject.scene.rounds))[0])
    return bool(height[mover.atoms].min() + way > height.max() + FARTHEST_OUT)


def _may_be_caught(subject: Subject, ahead: Outlook) -> bool:
    """Return whether something that cannot be foreseen, such as a hand that closes, may catch the body."""
    driven = np.zeros(subject.model.n_atoms, dtype=bool)
    for force in subject.model.forces:
        is_push = isinstance(force, PushForce) and not isinstance(subject.scene.forces[force.origin.name], Gravity)
        if is_push or isinstance(force, (OscillateForce, TetherForce, TorqueForce, TowardsForce)):
            driven[force.atoms] = True
    driven &= ~subject.is_held
    bodies = subject.body[subject.surroundings.resting(ahead.partners)]
    return bool(np.isin(bodies, subject.body[driven]).any())


def _alone(subject: Subject, ahead: Outlook, drive: Drive) -> Symptom:
    """Nothing may touch the body at all."""
    groups = subject.groups_of(ahead.mover.atoms)
    return Symptom(
        at=("groups", groups[0]),
        names=(*subject.group_paths(ahead.mover.atoms), ("forces", drive.force.origin.name)),
        message=(
            f"{listed(groups)} may touch nothing, and forces.{drive.force.origin.name} carries "
            f"{verb(groups, 'it', 'them')} out of the scene"
        ),
        remedy=_collision(subject, groups),
    )


def _collision(subject: Subject, groups: list[str]) -> Remedy:
    """Let the body touch what is held, or else all others."""
    names = [span.name for span in subject.model.groups]
    held = [span.name for span in subject.model.groups if subject.is_held[span.start : span.stop].all()]
    others = held or [name for name in names if name not in groups]
    return {"collisions": {subject.new_name("collisions", "land"): {"between": [groups, others]}}} if others else {}


def _missed(subject: Subject, ahead: Outlook, drive: Drive) -> Symptom:
    """The body may touch something that is not on its way: a wrong direction, or a wrong place."""
    groups, partners = subject.groups_of(ahead.mover.atoms), subject.groups_of(ahead.partners)
    name = drive.force.origin.name
    better = _better_impulse(subject, ahead, drive)
    where = direction_in_words(ahead.mover.flight.lasting.tolist())
    if better is not None:
        return Symptom(
            at=("forces", name),
            names=(("forces", name), *subject.group_paths(ahead.mover.atoms)),
            message=(
                f"this carries {listed(groups)} towards {where}, where nothing is that it may touch; "
                f"towards {direction_in_words(better.tolist())} is {listed(partners)}"
            ),
            remedy={"forces": {name: {"impulse": [float(f"{part:g}") for part in better]}}},
        )
    return Symptom(
        at=("groups", groups[0]),
        names=(
            *subject.group_paths(ahead.mover.atoms),
            ("forces", name),
            *subject.group_paths(ahead.partners),
        ),
        message=(
            f"forces.{name} carries {listed(groups)} towards {where} past {listed(partners)}, which is all that "
            f"{verb(groups, 'it', 'they')} may touch: nothing ever stops {verb(groups, 'it', 'them')}"
        ),
        remedy={"groups": {groups[0]: {"centre": _over(subject, ahead)}}},
    )


def _better_impulse(subject: Subject, ahead: Outlook, drive: Drive) -> Floats | None:
    """Return the opposite impulse, or the same downwards where it is not upright, if that leads to a partner."""
    impulse = np.array(drive.force.impulse)
    size = float(np.sqrt(impulse @ impulse))
    down = np.array([-float(subject.scene.render.camera.up == axis) for axis in "xyz"]) * size
    tried = [-impulse] if abs(float(impulse @ down)) > UPRIGHT * size * size else [-impulse, down]
    resting = subject.surroundings.resting(ahead.partners)
    for better in tried if resting.size else ():
        pushed = Drive(drive.force, better, drive.from_round, drive.until_round)
        others = [pushed if other is drive else other for other in ahead.mover.flight.drives]
        if subject.surroundings.meets(ahead.mover, ahead.mover.flight.with_drives(others), resting):
            return better + 0.0  # no negative zeros
    return None


def _over(subject: Subject, ahead: Outlook) -> list[float]:
    """Return a place above the middle of the nearest partner group, as far from it as the body is now."""
    position, mover = subject.state.position, ahead.mover
    centre = position[mover.atoms].mean(axis=0)
    along = mover.flight.lasting / np.sqrt(mover.flight.lasting @ mover.flight.lasting)
    targets = [position[span.start : span.stop].mean(axis=0) for span in subject.model.groups
               if np.isin(np.arange(span.start, span.stop), ahead.partners).any()]  # fmt: skip
    target = min(targets, key=lambda place: float(np.square(place - centre).sum()))
    height = min(float((centre - target) @ along), -(mover.radius + 2.0 * CONTACT))
    return [round(part, 3) + 0.0 for part in (target + height * along).tolist()]
