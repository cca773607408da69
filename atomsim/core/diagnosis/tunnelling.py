"""Atoms that grow so fast during a run that they may pass through each other unseen; knows no stepper and no files."""

from __future__ import annotations

import math

from atomsim.core.model import Frame, Model
from atomsim.core.pairs.collisions import as_index, involved_atoms


class SpeedWatch:
    """Remembers the fastest of the atoms that may collide.

    Args:
        model: the compiled scene.
    """

    def __init__(self, model: Model) -> None:
        self._model = model
        self._atoms = as_index(involved_atoms(model.collisions, model.n_atoms))
        self._is_idle = not model.collisions
        self._first_round: int | None = None
        self._furthest = 1.0  # two atoms that approach each other by 2 in a round can swap places

    def see(self, frame: Frame) -> None:
        """Look at a recorded round."""
        at_most = self._model.time_step * math.sqrt(2.0 * frame.observables.kinetic_energy)  # if one had all of it
        if self._is_idle or at_most < 0.999 * self._furthest:
            return
        velocity = frame.velocity[self._atoms]
        step = self._model.time_step * math.sqrt(float((velocity * velocity).sum(axis=1).max()))
        if step >= self._furthest:
            self._furthest = step
            if self._first_round is None:
                self._first_round = frame.round_index

    def warning(self) -> str | None:
        """Return what to say of the run so far, or None if no atom was too fast."""
        if self._first_round is None:
            return None
        return (
            f"from round {self._first_round} on atoms that may collide moved up to {self._furthest:.3g} per round, so "
            "some may have passed through others unseen (contact is at distance 2); use a smaller time_step or weaker "
            "impulses"
        )
