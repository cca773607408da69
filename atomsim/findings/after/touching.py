"""Groups and collisions that never touched anything in any round, not even between two frames."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from atomsim.core.model import Between, CollisionTable, Floats, Frame
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.core.pairs.near import pair_squares
from atomsim.findings.after.crossing import pushing
from atomsim.findings.after.look import Look, Run
from atomsim.findings.before.declared import sides
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Mask, Subject

CONTACT = 2.0
"""Two balls touch when their centres are less than this apart [length]."""

FARTHEST = 1e4
"""What is farther apart than this will not meet [length]."""

CREEP = 1e-6
"""What comes nearer more slowly than this does not come nearer [length per round]."""

SOON = 20.0
"""So many times the length of the run may pass until a meeting that it was too short for."""


class Touches:
    """Remembers which atoms of each table were in contact, and how near the others came.

    A contact may begin and end between two frames. So where atoms are so near and so fast that they could have met, the
    rounds between the frames are computed again, from the frame before: to the same bits, so nothing is guessed.
    """

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._run = run
        self._tables = subject.model.collisions
        self._ends: list[Look] = []
        self._everything = np.ones(subject.model.n_atoms, dtype=bool)
        self._met = [np.zeros(subject.model.n_atoms, dtype=bool) for _ in self._tables]

    def see(self, look: Look) -> None:
        """Look at a frame, and if need be at the rounds before it."""
        self._ends = [*self._ends[:1], *self._ends[1:][-1:], look]
        reach = 0.0 if look.before is None else self._reach(look.before, look.frame)
        open_tables = [index for index in range(len(self._tables)) if self._is_open(index)]
        again = False
        for index in open_tables:
            nearest = self._note(index, look.position, CONTACT + reach)
            again |= nearest >= CONTACT and nearest < CONTACT + reach
        if again and look.before is not None:
            self._between(look.before, look.frame.round_index, open_tables)

    def _is_open(self, index: int) -> bool:
        """Tell whether anything is left to find out about a table: some group of it has met nothing."""
        group = self._subject.group
        return any(not self._met[index][group == number].any() for number in self._groups(self._tables[index]))

    def _groups(self, table: CollisionTable) -> list[int]:
        atoms = np.concatenate([side for pair in sides(table) for side in pair])
        return sorted(set(self._subject.group[atoms].tolist()))

    def _reach(self, before: Frame, now: Frame) -> float:
        """Return how much nearer than in both frames two atoms can have been in between [length]."""
        fastest = max(float(np.square(frame.velocity).sum(axis=1).max()) for frame in (before, now))
        way = math.sqrt(fastest) * self._subject.model.time_step * (now.round_index - before.round_index)
        return 2.0 * way if math.isfinite(way) else 0.0

    def _note(self, index: int, position: Floats, cutoff: float) -> float:
        """Note contacts of a table in a round; return how near its nearest pair is, or infinity beyond the cutoff."""
        first, second = table_pairs_near(self._tables[index], position, cutoff)
        if not first.size:
            return math.inf
        distance = np.sqrt(pair_squares(position, first, second))
        touching = distance < CONTACT
        self._met[index][first[touching]] = self._met[index][second[touching]] = True
        return float(distance.min())

    def _between(self, before: Frame, until: int, tables: list[int]) -> None:
        """Compute the rounds between two frames again, and note what touches in them."""
        stepper = NumpyStepper(self._subject.model, before.state)
        for _ in range(before.round_index + 1, until):
            stepper.advance(1)
            position = np.ascontiguousarray(stepper.state().position.T)
            for index in tables:
                self._note(index, position, CONTACT)

    def has_met(self, index: int) -> bool:
        """Tell whether anything of a table touched."""
        return bool(self._met[index].any())

    def met(self) -> Mask:
        """Return which atoms touched anything, (n_atoms,)."""
        met: Mask = np.zeros(self._subject.model.n_atoms, dtype=bool)
        for each in self._met:
            met |= each
        return met

    def approach(self, index: int, is_asked: Mask) -> Approach:
        """Return how near the pairs of a table with a certain atom were in the first frame and in the last two.

        Args:
            index: the table.
            is_asked: which atoms, (n_atoms,).
        """
        first, before, last = self._ends[0], self._ends[max(0, len(self._ends) - 2)], self._ends[-1]
        distance = [_least_distance(self._tables[index], is_asked, each.position) for each in (first, before, last)]
        n_rounds = last.frame.round_index - before.frame.round_index
        return Approach(distance[0], distance[1], distance[2], max(1, n_rounds), last.frame.round_index)

    def names_of(self, index: int) -> list[str]:
        """Return the groups that a table is about."""
        return [self._subject.model.groups[number].name for number in self._groups(self._tables[index])]

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen, by kind."""
        return {
            "too-late": self._too_late,
            "never-touches": self._never_touches,
            "collision-never": self._collision_never,
        }

    def _too_late(self) -> Iterator[Symptom]:
        """Yield collisions of which no pair touched, but would have soon after the end."""
        if self._run.end.kind != "finished":
            return
        for index, table in enumerate(self._tables):
            names = self.names_of(index)
            if self.has_met(index) or not any(isinstance(block, Between) for block in table.blocks):
                continue
            approach = self.approach(index, self._everything)
            round_index = approach.meets_in
            if round_index is not None and round_index < SOON * approach.last_round:
                path = ("collisions", table.origin.name)
                yield Symptom(
                    at=("rounds",),
                    names=(path, *(("groups", name) for name in names), ("rounds",)),
                    message=(
                        f"the run ends before {' and '.join(names)} meet: they are still {approach.last:.3g} apart and "
                        f"come nearer, to touch about in round {round_index:.0f}"
                    ),
                    remedy={"rounds": int(1.2 * round_index)},
                    rounds=(int(round_index),),
                )

    def _never_touches(self) -> Iterator[Symptom]:
        """Yield groups that are not held, may touch others, and touched none."""
        subject = self._subject
        met = np.isin(subject.body, subject.body[self.met()])  # what is one body touches as one
        for number, span in enumerate(subject.model.groups):
            atoms = slice(span.start, span.stop)
            indices = [i for i, table in enumerate(self._tables) if number in self._groups(table)]
            others = [i for i in indices if any(each != number for each in self._groups(self._tables[i]))]
            if not others or met[atoms].any() or subject.is_held[atoms].all():
                continue
            is_own = subject.group == number
            approach = min((self.approach(i, is_own) for i in others), key=lambda each: each.last)
            names = [self._tables[i].origin.name for i in others]
            forces = pushing(subject, (span.name,)) if approach.last > approach.first else ()
            away = f"; it went from {approach.first:.3g} to {approach.last:.3g} apart" if forces else ""
            yield Symptom(
                at=forces[0] if forces else ("groups", span.name),
                names=(("groups", span.name), *(("collisions", name) for name in names), *forces[:1]),
                message=f"{span.name} may touch others and touched none in the whole run{away} (contact is at 2)",
            )

    def _collision_never(self) -> Iterator[Symptom]:
        """Yield collisions between groups of which no pair ever touched."""
        for index, table in enumerate(self._tables):
            names = self.names_of(index)
            if self.has_met(index) or len(names) < 2:
                continue
            path = ("collisions", table.origin.name)
            yield Symptom(
                at=path,
                names=(path, *(("groups", name) for name in names)),
                message=f"nothing of {table.origin.name} ever touched: {' and '.join(names)} did not meet",
            )


class Approach(NamedTuple):
    """How near the pairs of a table were [length]: in the first frame, in the last two, and when those were."""

    first: float
    before: float
    last: float
    n_rounds: int
    last_round: int

    @property
    def meets_in(self) -> float | None:
        """The round in which they would have met, had they gone on as at the end; None if they did not come nearer."""
        closing = (self.before - self.last) / self.n_rounds
        if not (self.last < self.first and closing > CREEP):
            return None
        return self.last_round + (self.last - CONTACT) / closing


def _least_distance(table: CollisionTable, is_asked: Mask, position: Floats) -> float:
    """Return how near the nearest pair of a table with a certain atom is [length]; infinity if that is very far."""
    cutoff = 2.0 * CONTACT
    while cutoff < FARTHEST:
        first, second = table_pairs_near(table, position, cutoff)
        chosen = is_asked[first] | is_asked[second]
        if chosen.any():
            return math.sqrt(float(pair_squares(position, first[chosen], second[chosen]).min()))
        cutoff *= 2.0
    return math.inf
