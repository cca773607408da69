"""Scenes that are their own mirror image, and runs that are not: what broke the symmetry was a rounding error."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from atomsim.core.model import BondTable, Floats, Indices
from atomsim.findings.after.look import Look, Run
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject

EXACT = 1e-9
"""Positions and velocities that differ by less are mirror images [length]."""

DEPARTED = 1.0
"""An atom that is farther than this from its mirror image's mirror image is seen to be [length]: one radius."""

MOST_ATOMS = 20_000
"""In larger scenes no mirror is looked for."""


@dataclass(frozen=True, slots=True, eq=False)
class _Mirror:
    """A plane that maps a scene onto itself.

    Attributes:
        axis: 0, 1 or 2, across the plane.
        middle: where the plane is on that axis [length].
        image: the mirror image of every atom, (n_atoms,).
    """

    axis: int
    middle: float
    image: Indices

    def departure(self, position: Floats) -> Floats:
        """Return how far each atom is from the mirror image of its image [length], (n_atoms,)."""
        mirrored = position[self.image].copy()
        mirrored[:, self.axis] = 2.0 * self.middle - mirrored[:, self.axis]
        return np.asarray(np.sqrt(np.square(mirrored - position).sum(axis=1)))


class Symmetric:
    """Runs that depart from a mirror symmetry of their scene."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        jitter = subject.scene.jitter
        is_jittered = jitter is not None and jitter.amplitude > 0.0
        self._mirrors = [] if is_jittered or subject.model.n_atoms > MOST_ATOMS else list(_mirrors(subject))
        self._seen: dict[int, tuple[int, str, float]] = {}

    def see(self, look: Look) -> None:
        """Look at a frame."""
        for mirror in self._mirrors:
            if mirror.axis in self._seen:
                continue
            departure = mirror.departure(look.frame.position)
            furthest = int(departure.argmax())
            if departure[furthest] > DEPARTED:
                name = self._subject.groups_of(np.array([furthest]))[0]
                self._seen[mirror.axis] = (look.frame.round_index, name, float(departure[furthest]))

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"symmetric": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        for axis, (round_index, name, departure) in self._seen.items():
            yield Symptom(
                at=("groups", name),
                names=(("groups", name),),
                message=(
                    f"the scene is its own mirror image along {'xyz'[axis]}, and {name} departs from that by "
                    f"{departure:.2g} in round {round_index}: only rounding errors decide to which side"
                ),
                remedy={"jitter": {"amplitude": 1e-9, "seed": 1}},
                rounds=(round_index,),
            )


def _mirrors(subject: Subject) -> Iterator[_Mirror]:
    """Yield the planes across x, y or z that map a scene onto itself: places, velocities, bonds and forces."""
    position, velocity = subject.state.position, subject.state.velocity
    for axis in range(3):
        middle = 0.5 * float(position[:, axis].min() + position[:, axis].max())
        image = _image(subject, axis, middle)
        if image is None:
            continue
        turned = velocity[image].copy()
        turned[:, axis] *= -1.0
        if np.abs(turned - velocity).max() > EXACT or not _acts_alike(subject, axis, image):
            continue
        if all(_is_own_image(table, image, subject.model.n_atoms) for table in subject.model.bonds):
            yield _Mirror(axis, middle, image)


def _image(subject: Subject, axis: int, middle: float) -> Indices | None:
    """Return the mirror image of every atom in its own group, or None if some have none."""
    mirrored = subject.state.position.copy()
    mirrored[:, axis] = 2.0 * middle - mirrored[:, axis]
    image = np.empty(subject.model.n_atoms, dtype=np.int64)
    for span in subject.model.groups:
        atoms = np.arange(span.start, span.stop)
        here, there = (np.round(places[atoms] / (10 * EXACT)) for places in (subject.state.position, mirrored))
        order, order_there = (np.lexsort(places.T) for places in (here, there))
        image[atoms[order_there]] = atoms[order]
        if np.abs(subject.state.position[image[atoms]] - mirrored[atoms]).max() > 100 * EXACT:
            return None
    return image


def _acts_alike(subject: Subject, axis: int, image: Indices) -> bool:
    """Tell whether forces act on images as on what they are images of."""
    for force in subject.model.forces:
        if not np.array_equal(np.sort(image[force.atoms]), np.sort(force.atoms)):
            return False
        impulse = getattr(force, "impulse", None)
        if impulse is not None and impulse[axis] != 0.0:
            return False
        turning = getattr(force, "axis", None)
        if turning is not None and any(part != 0.0 for k, part in enumerate(turning) if k != axis):
            return False
        target = getattr(force, "target", None)
        if target is not None:
            return False
    return True


def _is_own_image(table: BondTable, image: Indices, n_atoms: int) -> bool:
    """Tell whether the images of bound pairs are bound alike."""
    first, second = image[table.first], image[table.second]
    low, high = np.minimum(first, second), np.maximum(first, second)
    order = np.argsort(low * n_atoms + high)
    same = np.array_equal(low[order], table.first) and np.array_equal(high[order], table.second)
    return same and bool(np.abs(table.rest_squared[order] - table.rest_squared).max(initial=0.0) < 1e-6)
