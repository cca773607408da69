"""Runs whose energy grows though nothing puts any in: the time step is too large."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from atomsim.core.diagnosis.energy import total_energy
from atomsim.core.diagnosis.stiffness import largest_time_step
from atomsim.core.model import DampingForce, HoldForce, PushForce
from atomsim.findings.after.look import Look, Run
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import round_down

GROWTH = 0.2
"""The energy must grow by this part of the largest kinetic energy."""


class EnergyGrows:
    """Remembers by how much H, less what constant pushes give, grew over its least so far.

    Below the stability limit H swings by as much though nothing is wrong; so only runs at or beyond it are judged.
    """

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        model = subject.model
        self._limit = largest_time_step(model, subject.state)
        self._is_judged = model.time_step >= self._limit and all(map(_is_accounted_for, model.forces))
        self._is_judged &= not subject.state.velocity[subject.is_held].any()
        self._least = float("inf")
        self._growth = (0.0, 0)
        self._largest = 0.0

    def see(self, look: Look) -> None:
        """Look at a frame."""
        if not self._is_judged:
            return
        energy = total_energy(look.frame.observables) - self._given(look)
        self._least = min(self._least, energy)
        self._growth = max(self._growth, (energy - self._least, look.frame.round_index))
        self._largest = max(self._largest, look.frame.observables.kinetic_energy)

    def _given(self, look: Look) -> float:
        """Return g·c/τ: what constant pushes have given, but for a constant."""
        pushes = [force for force in self._subject.model.forces if isinstance(force, PushForce)]
        given = sum(float(look.frame.position[force.atoms].sum(axis=0) @ force.impulse) for force in pushes)
        return given / self._subject.model.time_step

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"energy-grows": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        growth, round_index = self._growth
        if self._is_judged and growth > GROWTH * self._largest > 0.0:
            tau = self._subject.model.time_step
            yield Symptom(
                at=("time_step",),
                names=(("time_step",),),
                message=(
                    f"the energy grows by {growth / self._largest:.0%} of the largest kinetic energy until round "
                    f"{round_index}, and nothing puts it in: τ = {tau:g} is beyond the limit {self._limit:.3g}"
                ),
                remedy={"time_step": round_down(0.9 * self._limit)},
                rounds=(round_index,),
            )


def _is_accounted_for(force: object) -> bool:
    if isinstance(force, PushForce):
        return force.from_round == 0 and force.until_round is None
    return isinstance(force, (DampingForce, HoldForce))
