"""Forces that are too strong for what they act on, and runs that blew up or were recorded too seldom."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from atomsim.core.pairs.collisions import table_pairs_near
from atomsim.core.pairs.near import distinct, pair_squares
from atomsim.findings.after.crossing import pushing
from atomsim.findings.after.look import Look, Run
from atomsim.findings.before.declared import is_declared
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.scene.source import KeyPath

FACTOR = 2.0
"""A bond that is longer or shorter than its rest by this factor is no longer what was drawn."""

PRESSED = 1.0
"""Colliding atoms nearer than this have been pressed into one another [length]."""

CLOSE = 1.9
"""Colliding atoms that were nearer than this at the start were made to overlap [length]."""

JUMP = 2.0
"""An atom that moves more than this between two frames may have touched something unseen [length]."""


class Overpowered:
    """Bonds stretched or pressed by a factor of two, and colliding atoms pressed into one another."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._bonds: dict[str, tuple[float, float, int]] = {}
        self._pressed: dict[tuple[int, int], tuple[float, int]] = {}

    def see(self, look: Look) -> None:
        """Look at a frame; where a scene begins is not its forces' doing."""
        if look.before is None:
            return
        for table in self._subject.model.bonds:
            is_real = table.rest_squared > 0.0
            squared = pair_squares(look.position, table.first[is_real], table.second[is_real])
            ratio = squared / table.rest_squared[is_real]
            if ratio.size:
                self._note_bond(table.origin.name, float(ratio.max()), float(ratio.min()), look.frame.round_index)
        near = look.near.only(look.near.distance < PRESSED)
        for collisions in self._subject.model.collisions if near.first.size else ():
            chosen = near.only(is_declared(collisions, near.first, near.second))
            for number in range(chosen.first.size):
                self._note_pressed(
                    int(chosen.first[number]), int(chosen.second[number]), float(chosen.distance[number]), look
                )

    def _note_bond(self, name: str, most: float, least: float, round_index: int) -> None:
        """Remember the largest factor by which a bond of a declaration is off, and when."""
        worst = max(math.sqrt(most), 1.0 / math.sqrt(least) if least > 0.0 else math.inf)
        ratio = math.sqrt(most) if worst == math.sqrt(most) else math.sqrt(least)
        if worst >= FACTOR and worst > self._bonds.get(name, (0.0, 0.0, 0))[0]:
            self._bonds[name] = (worst, ratio, round_index)

    def _note_pressed(self, first: int, second: int, distance: float, look: Look) -> None:
        start = look.subject.state.position
        if float(np.square(start[first] - start[second]).sum()) < CLOSE**2:
            return  # they were made to overlap
        groups = (int(self._subject.group[first]), int(self._subject.group[second]))
        if distance < self._pressed.get(groups, (math.inf, 0))[0]:
            self._pressed[groups] = (distance, look.frame.round_index)

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"overpowered": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        for name, (_, ratio, round_index) in self._bonds.items():
            table = self._subject.bonds(name)
            groups = self._subject.group_paths(np.concatenate((table.first, table.second)))
            yield Symptom(
                at=("bonds", name),
                names=(("bonds", name), *groups, *pushing(self._subject, tuple(str(path[-1]) for path in groups))),
                message=(
                    f"a bond of {name} is {ratio:.2g} times as long as it should be in round {round_index}: the forces "
                    "on it are too strong for it"
                ),
                rounds=(round_index,),
            )
        for (one, other), (distance, round_index) in self._pressed.items():
            names = list(dict.fromkeys(self._subject.model.groups[number].name for number in (one, other)))
            paths: tuple[KeyPath, ...] = tuple(("groups", name) for name in names)
            forces = pushing(self._subject, tuple(names))
            yield Symptom(
                at=forces[0] if forces else paths[0],
                names=(*paths, *forces),
                message=(
                    f"{' and '.join(names)} are pressed into one another: {distance:.2f} apart in round {round_index} "
                    "(contact is at 2); the forces that press them are too strong"
                ),
                rounds=(round_index,),
            )


class CoarseRecord:
    """Runs recorded so seldom that an atom near a partner moved past it between two frames."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._run = run
        self._worst: tuple[float, int, int] | None = None

    def see(self, look: Look) -> None:
        """Look at a frame."""
        if look.before is None:
            return
        step = np.sqrt(np.square(look.frame.position - look.before.position).sum(axis=1))
        furthest = float(step.max())
        if furthest <= JUMP or not math.isfinite(furthest) or (self._worst and furthest <= self._worst[0]):
            return
        near = [table_pairs_near(table, look.position, 2.0 + JUMP) for table in self._subject.model.collisions]
        atoms = distinct([side for pair in near for side in pair])
        fast = atoms[step[atoms] > JUMP]
        if fast.size:
            fastest = int(fast[step[fast].argmax()])
            if self._worst is None or step[fastest] > self._worst[0]:
                self._worst = (float(step[fastest]), fastest, look.frame.round_index)

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"coarse-record": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what was seen."""
        if self._worst is None:
            return
        way, atom, round_index = self._worst
        name = self._subject.groups_of(np.array([atom]))[0]
        every = self._run.record_every
        yield Symptom(
            at=("record_every",),
            names=(("record_every",), ("groups", name)),
            message=(
                f"{name} moves by {way:.2g} between two frames, near something that it may touch (contact is at 2): "
                f"what happens there is not recorded, only every {every}th round is"
            ),
            remedy={"record_every": max(1, int(every * JUMP / way))},
            rounds=(round_index,),
        )


class BlowUp:
    """Runs that blew up."""

    def __init__(self, subject: Subject, run: Run) -> None:
        self._subject = subject
        self._run = run

    def see(self, look: Look) -> None:
        """Look at a frame; how the run ended says enough."""

    def diagnoses(self) -> dict[str, Callable[[], Iterator[Symptom]]]:
        """Return what was seen."""
        return {"blow-up": self._symptoms}

    def _symptoms(self) -> Iterator[Symptom]:
        """Yield what the run said when it ended."""
        if self._run.end.kind != "blew up":
            return
        report = " ".join(self._run.end.report.split())
        model = self._subject.model
        tables = (*model.bonds, *model.collisions, *model.forces)
        named = [table.origin for table in tables if f"{table.origin.section}.{table.origin.name}" in report]
        groups = [span for span in model.groups if f"{span.name}[" in report]
        paths: list[KeyPath] = [(origin.section, origin.name) for origin in named]
        paths += [("groups", span.name) for span in groups]
        yield Symptom(
            at=("time_step",),
            names=(("time_step",), *paths),
            message=f"the run blew up: {report}",
            rounds=(self._run.last_round,),
        )
