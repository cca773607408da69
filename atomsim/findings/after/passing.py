"""Atoms that were inside one another because nothing says that they may touch: of two groups, or of one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from atomsim.core.pairs.near import distinct, pair_squares
from atomsim.findings.after.look import Look, Near, Run
from atomsim.findings.before.declared import is_mentioned
from atomsim.findings.before.ghost_contact import lacking, may_pass
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Mask, Subject

INSIDE = 1.0
"""Nearer than this, the centre of each ball is inside the other [length]."""

APART = 4.0
"""Atoms of one part that were this far apart at the start were not made to overlap [length]."""

SLACK = 0.1
"""Jitter and bonds that stretch move atoms by less than this [length]."""


class Least(NamedTuple):
    """When a pair of groups came near first, and how near at most."""

    first_round: int
    round_index: int
    distance: float

    def and_then(self, round_index: int, distance: float) -> Least:
        """Return the same after another look."""
        return self._replace(round_index=round_index, distance=distance) if distance < self.distance else self


class _Watch:
    """Remembers of pairs of groups how near they came."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._seen: dict[tuple[int, int], Least] = {}

    def _remember(self, near: Near, round_index: int) -> None:
        """Note the least distance of every pair of groups."""
        n_groups = len(self._subject.model.groups)
        one, other = self._subject.group[near.first], self._subject.group[near.second]
        key = one * n_groups + other
        for pair in distinct([key]).tolist():
            distance = float(near.distance[key == pair].min())
            groups = divmod(pair, n_groups)
            known = self._seen.get(groups)
            fresh = Least(round_index, round_index, distance)
            self._seen[groups] = fresh if known is None else known.and_then(round_index, distance)

    def _name(self, number: int) -> str:
        return self._subject.model.groups[number].name


class GhostContact(_Watch):
    """Two groups that share no bond and may not touch, and were inside one another."""

    def see(self, look: Look) -> None:
        """Look at a frame."""
        near = look.near
        self._remember(near.only(may_pass(self._subject, near.first, near.second)), look.frame.round_index)

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"ghost-contact": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        for (one, other), least in self._seen.items():
            names = [self._name(one), self._name(other)]
            yield Symptom(
                at=("groups", names[lacking(self._subject, one, other)]),
                names=tuple(("groups", name) for name in names),
                message=(
                    f"{names[0]} and {names[1]} may not touch and passed through one another: nearer than 1.5 from "
                    f"round {least.first_round} on, {least.distance:.2f} in round {least.round_index} (contact is at 2)"
                ),
                remedy={"collisions": {self._subject.new_name("collisions", "_".join(names)): {"between": names}}},
                rounds=(least.first_round, least.round_index),
            )


class SelfPass(_Watch):
    """A body, or loose atoms of a group, of which some were inside others though they may not touch."""

    def see(self, look: Look) -> None:
        """Look at a frame."""
        near = look.near.only(look.near.distance < INSIDE)
        if near.first.size:
            self._remember(near.only(self._may_pass(near)), look.frame.round_index)

    def _may_pass(self, near: Near) -> Mask:
        """Return which pairs belong to one part, were apart, and are spoken of by no bond and no collision."""
        subject, first, second = self._subject, near.first, near.second
        is_loose = subject.is_loose[first] & subject.is_loose[second]
        is_one = np.where(
            is_loose, subject.group[first] == subject.group[second], subject.body[first] == subject.body[second]
        )
        chosen: Mask = is_one & ~(subject.is_held[first] & subject.is_held[second])
        start = pair_squares(np.ascontiguousarray(subject.state.position.T), first, second)
        chosen &= start >= (APART - SLACK) ** 2
        chosen &= ~subject.are_bound(first, second)
        for table in subject.model.collisions:
            chosen[chosen] = ~is_mentioned(table, first[chosen], second[chosen])
        return chosen

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"self-pass": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        for (one, other), least in self._seen.items():
            names = list(dict.fromkeys([self._name(one), self._name(other)]))
            whole = names[0] if len(names) == 1 else f"{names[0]} and {names[1]}"
            what = f"parts of {whole} may not touch one another and passed through one another"
            where = {"within": names[0], "min_gap": self._gap(one)} if len(names) == 1 else {"between": names}
            yield Symptom(
                at=("groups", names[0]),
                names=tuple(("groups", name) for name in names),
                message=(
                    f"{what}: from round {least.first_round} on, {least.distance:.2f} apart in round "
                    f"{least.round_index} (contact is at 2)"
                ),
                remedy={"collisions": {self._subject.new_name("collisions", f"{names[0]}_own"): where}},
                rounds=(least.first_round, least.round_index),
            )

    def _gap(self, number: int) -> int:
        """Return how far apart in a group atoms must be, so that none that are made to overlap collide."""
        span = self._subject.model.groups[number]
        position = self._subject.state.position[span.start : span.stop]
        gap = 1
        while gap < len(position) and float(np.square(position[gap:] - position[:-gap]).sum(axis=1).min()) < 4.0:
            gap += 1
        return gap
