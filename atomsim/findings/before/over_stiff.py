"""Time steps that the stiffness of a scene does not allow, and rules that make it needlessly stiff."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from atomsim.core.diagnosis.stiffness import is_damped_too_much, is_surely_stable, largest_stiffness
from atomsim.core.model import BondTable, Model
from atomsim.core.pairs.near import pair_squares
from atomsim.findings.finding import Remedy, Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import round_down, round_up
from atomsim.scene.language import DistanceThresholdBonds
from atomsim.scene.source import KeyPath

SQUEEZE = 4.0
"""What an atom that is pressed between two others adds to the stiffness: 2 for each contact."""

FAR_BEYOND = 2.5
"""A time step that is so many times too large has slipped, however stiff one of the rules is."""

MANY_ATOMS, MANY_SPACINGS = 20, 3.0
"""A rule by distance that binds over half of the pairs of so many atoms, because its threshold is so many times their
smallest distance, was probably meant to bind neighbours."""


def over_stiff(subject: Subject) -> Iterator[Symptom]:
    """Find a time step that leaves no room for a squeezed contact, and thresholds that bind nearly everything."""
    squeeze = SQUEEZE if subject.model.collisions else 0.0
    if not is_surely_stable(subject.model, subject.state, squeeze):
        stiffness = largest_stiffness(subject.model, subject.state)
        if subject.model.time_step * (stiffness + squeeze) >= 4.0:
            yield _unstable(subject, stiffness, squeeze)
            return
    yield from _far_thresholds(subject)


def _unstable(subject: Subject, stiffness: float, squeeze: float) -> Symptom:
    """Blame the rule without which the time step would do; where there is none, or it is far off, the time step."""
    model = subject.model
    limit = 4.0 / stiffness if stiffness > 0.0 else math.inf
    left = [(largest_stiffness(_without(model, table), subject.state), table) for table in model.bonds]
    rest, stiffest = min(left, key=lambda item: item[0]) if left else (math.inf, None)
    at: KeyPath = ("time_step",)
    blamed: list[BondTable] = []
    is_far_beyond = model.time_step >= FAR_BEYOND * limit
    if stiffest is not None and model.time_step * (rest + squeeze) < 4.0 and not is_far_beyond:
        at, blamed = ("bonds", stiffest.origin.name), [stiffest]
    else:
        blamed = [
            table
            for table in model.bonds
            if model.time_step * (largest_stiffness(replace(model, bonds=(table,)), subject.state) + squeeze) >= 4.0
        ] or ([stiffest] if stiffest is not None else [])
    return Symptom(
        at=at,
        names=(
            *(("bonds", table.origin.name) for table in blamed),
            ("time_step",),
            *(path for table in blamed for path in subject.group_paths(np.concatenate((table.first, table.second)))),
        ),
        message=_message(subject, limit, squeeze, [f"bonds.{table.origin.name}" for table in blamed]),
        remedy=_smaller(limit),
    )


def _without(model: Model, table: BondTable) -> Model:
    return replace(model, bonds=tuple(other for other in model.bonds if other is not table))


def _message(subject: Subject, limit: float, squeeze: float, rules: list[str]) -> str:
    time_step = subject.model.time_step
    damping = " with its damping" if is_damped_too_much(subject.model, subject.state) else ""
    stiff = f"; what makes it stiff: {', '.join(rules)}" if rules else ""
    if time_step >= limit:
        return (
            f"time_step {time_step:g} is at or above {limit:.3g}, the largest that the stiffness of this scene "
            f"allows{damping}; expect it to blow up{stiff}{_advice(0.5 * limit)}"
        )
    squeezed = 4.0 / (4.0 / limit + squeeze)
    return (
        f"time_step {time_step:g} is a hair below {limit:.3g}, the largest that the stiffness of this scene "
        f"allows{damping}; an atom pressed between two others needs less than {squeezed:.3g}{stiff}"
        f"{_advice(0.5 * limit)}"
    )


def _advice(limit: float) -> str:
    """Advise a time step of one digit, not above the limit; none for an absurd limit."""
    return f"; try time_step {round_down(limit):g}" if 1e-300 < limit < math.inf else ""


def _smaller(limit: float) -> Remedy:
    return {"time_step": round_down(0.5 * limit)} if 1e-300 < limit < math.inf else {}


def _far_thresholds(subject: Subject) -> Iterator[Symptom]:
    for name, rule in subject.scene.bonds.items():
        if not isinstance(rule, DistanceThresholdBonds) or rule.metric != "space":
            continue
        table = subject.bonds(name)
        for expression in rule.within or ():
            atoms = subject.selections.atoms((expression,))
            inside = np.isin(table.first, atoms) & np.isin(table.second, atoms)
            n_bound, n_pairs = int(inside.sum()), math.comb(atoms.size, 2)
            if atoms.size < MANY_ATOMS or 2 * n_bound <= n_pairs:
                continue
            spacing = math.sqrt(pair_squares(subject.placed.T, table.first[inside], table.second[inside]).min())
            if rule.threshold >= MANY_SPACINGS * spacing:
                yield Symptom(
                    at=("bonds", name),
                    names=(("bonds", name), *subject.group_paths(atoms)),
                    message=(
                        f"`threshold: {rule.threshold:g}` binds {n_bound:,} of the {n_pairs:,} pairs of {expression}, "
                        f"whose nearest atoms are {spacing:.3g} apart: stiff and slow, as if all pairs were meant"
                    ),
                    remedy={"bonds": {name: {"threshold": round_up(1.8 * spacing)}}},
                )
