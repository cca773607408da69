"""What did not move when it was meant to, or moved out of sight: hovers, rests early, left the scene."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from atomsim.core.model import DampingForce, Floats, PushForce
from atomsim.findings.after.look import Look, Run
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Mask, Subject

STILL = 0.05
"""Who moves by less than this does not move [length]."""


class Hovers:
    """Free groups that no force acts on and that nothing moved, while gravity acts on others."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._way = np.zeros(subject.model.n_atoms)

    def see(self, look: Look) -> None:
        """Look at a frame."""
        np.maximum(self._way, look.way, out=self._way)

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"hovers": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        subject = self._subject
        weights = [force for force in subject.model.forces if _is_weight(force)]
        if not weights:
            return
        is_driven = subject.is_held.copy()
        for force in subject.model.forces:
            if not isinstance(force, DampingForce):
                is_driven[force.atoms] = True
        bodies_driven = np.isin(subject.body, subject.body[is_driven])
        for span in subject.model.groups:
            atoms = slice(span.start, span.stop)
            if bodies_driven[atoms].any() or float(self._way[atoms].max()) >= STILL:
                continue
            weight = weights[0].origin.name
            acts_on = list(subject.scene.forces[weight].acts_on)
            yield Symptom(
                at=("groups", span.name),
                names=(("groups", span.name), ("forces", weight)),
                message=(
                    f"{span.name} hangs in the air: nothing holds it, no force acts on it, and it did not move, while "
                    f"{weight} pulls on {', '.join(acts_on)}"
                ),
                remedy={"forces": {weight: {"acts_on": [*acts_on, span.name]}}},
            )


def _is_weight(force: object) -> bool:
    return isinstance(force, PushForce) and force.from_round == 0 and force.until_round is None and any(force.impulse)


class RestsEarly:
    """Runs in whose second half, at least, nothing moves any more."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._run = run
        self._still_since = 0
        self._at: Floats | None = None

    def see(self, look: Look) -> None:
        """Look at a frame: whoever has moved since the last time something did is moving."""
        position = look.frame.position
        if self._at is None or float(np.square(position - self._at).sum(axis=1).max()) >= STILL**2:
            self._still_since, self._at = look.frame.round_index, position

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"rests-early": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        last = self._run.last_round
        if self._run.end.kind == "finished" and 0 < self._still_since < last / 2:
            yield Symptom(
                at=("rounds",),
                names=(("rounds",),),
                message=f"nothing moves any more from round {self._still_since} on; the run goes on to {last}",
                remedy={"rounds": int(self._still_since * 1.2) + 1},
                rounds=(self._still_since,),
            )


class LeftScene:
    """Groups that ended far outside the box in which the scene begins."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._last: Look | None = None

    def see(self, look: Look) -> None:
        """Look at a frame; the last one counts."""
        self._last = look

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"left-scene": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        assert self._last is not None  # a run has a first frame
        start = self._subject.state.position
        low, high = start.min(axis=0), start.max(axis=0)
        reach = 0.5 * float((high - low).max())
        position = self._last.frame.position
        is_outside: Mask = ((position < low - reach) | (position > high + reach)).any(axis=1)
        for span in self._subject.model.groups:
            atoms = slice(span.start, span.stop)
            if is_outside[atoms].all() and not self._subject.is_held[atoms].any():
                yield Symptom(
                    at=("groups", span.name),
                    names=(("groups", span.name),),
                    message=f"{span.name} has left the scene: it ends far outside the box in which everything began",
                    rounds=(self._last.frame.round_index,),
                )


class Restless:
    """Scenes with gravity and without damping that are about as lively at their end as ever."""

    SHARE = 0.2
    """With more than this part of the largest kinetic energy nothing has come to rest."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._run = run
        self._largest = 0.0
        self._late = 0.0

    def see(self, look: Look) -> None:
        """Look at a frame."""
        energy = look.frame.observables.kinetic_energy
        self._largest = max(self._largest, energy)
        if look.frame.round_index >= 0.9 * self._run.last_round:
            self._late = max(self._late, energy)

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"restless": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        forces = self._subject.model.forces
        weights = [force for force in forces if _is_weight(force)]
        is_damped = any(isinstance(force, DampingForce) and force.coefficient > 0 for force in forces)
        if not weights or is_damped or self._late <= self.SHARE * self._largest:
            return
        atoms = np.concatenate([force.atoms for force in weights])
        names = self._subject.groups_of(atoms[~self._subject.is_held[atoms]])
        if names:
            yield Symptom(
                at=("forces",),
                names=tuple(("groups", name) for name in names),
                message=(
                    f"{' and '.join(names)} did not come to rest: in the last tenth of the run the kinetic energy is "
                    f"still {self._late / self._largest:.0%} of its largest, and nothing takes it away"
                ),
                remedy={"forces": {self._subject.new_name("forces", "drag"): _drag(names)}},
            )


def _drag(names: list[str]) -> dict[str, object]:
    return {"kind": "damping", "acts_on": names, "coefficient": 0.01}
