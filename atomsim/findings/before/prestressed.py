"""Bonds that pull or push from the start, because the desired distance is not that of the drawn shape."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from atomsim.core.model import atom_name
from atomsim.core.pairs.near import pair_squares
from atomsim.findings.finding import Symptom
from atomsim.findings.subject import Subject
from atomsim.findings.words import counted

MOST_STRAIN = 0.1
"""A bond may be so much longer or shorter than it wants to be, of the larger of the two."""


def prestressed(subject: Subject) -> Iterator[Symptom]:
    """Find rules with bonds that are far from their rest; jitter, which rest distances leave out, does not count."""
    for table in subject.model.bonds:
        if subject.scene.bonds[table.origin.name].rest == "initial":
            continue
        distance = np.sqrt(pair_squares(subject.placed.T, table.first, table.second))
        rest = np.sqrt(table.rest_squared)
        strain = np.abs(distance - rest) / np.maximum(distance, rest)
        n_strained = int((strain > MOST_STRAIN).sum())
        if n_strained:
            worst = int(strain.argmax())
            ends = int(table.first[worst]), int(table.second[worst])
            one, other = (atom_name(atom, subject.model.groups) for atom in ends)
            yield Symptom(
                at=("bonds", table.origin.name),
                names=(("bonds", table.origin.name), *subject.group_paths(np.concatenate((table.first, table.second)))),
                message=(
                    f"{counted(n_strained, 'bond')} of {table.first.size:,} {'starts' if n_strained == 1 else 'start'} "
                    f"more than {MOST_STRAIN:.0%} off `rest`, most between {one} and {other}, which are "
                    f"{distance[worst]:.3g} apart and want {rest[worst]:.3g}"
                ),
                remedy={"bonds": {table.origin.name: {"rest": "initial"}}},
                rounds=(0,),
            )
