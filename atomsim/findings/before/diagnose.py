"""The table of the diagnoses before a run, and what becomes of what they see."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from atomsim.core.model import Model, State
from atomsim.findings.before.declared_twice import declared_twice
from atomsim.findings.before.floating_support import floating_support
from atomsim.findings.before.floppy import floppy, loose_joint
from atomsim.findings.before.force_never_acts import force_never_acts
from atomsim.findings.before.ghost_contact import ghost_contact
from atomsim.findings.before.held import collision_of_held, force_on_held
from atomsim.findings.before.hole import hole
from atomsim.findings.before.idle import idle
from atomsim.findings.before.in_pieces import in_pieces
from atomsim.findings.before.no_such_round import no_such_round
from atomsim.findings.before.off_camera import off_camera
from atomsim.findings.before.over_damped import over_damped
from atomsim.findings.before.over_stiff import over_stiff
from atomsim.findings.before.overlap_at_start import overlap_at_start
from atomsim.findings.before.prestressed import prestressed
from atomsim.findings.before.rule_misses_group import rule_misses_group
from atomsim.findings.before.symmetric import symmetric
from atomsim.findings.before.too_late import too_late
from atomsim.findings.before.tunnelling import tunnelling
from atomsim.findings.before.unsupported import unsupported
from atomsim.findings.before.weld import weld
from atomsim.findings.finding import Finding, Symptom, finding, without_consequences
from atomsim.findings.silence import needless_silences, without_silenced
from atomsim.findings.subject import Subject, TooLargeError
from atomsim.scene.loader import LoadedScene

Diagnosis: TypeAlias = Callable[[Subject], Iterator[Symptom]]

DIAGNOSES: dict[str, Diagnosis] = {
    "tunnelling": tunnelling,
    "floppy": floppy,
    "loose-joint": loose_joint,
    "in-pieces": in_pieces,
    "rule-misses-group": rule_misses_group,
    "over-stiff": over_stiff,
    "weld": weld,
    "declared-twice": declared_twice,
    "idle": idle,
    "force-on-held": force_on_held,
    "force-never-acts": force_never_acts,
    "collision-of-held": collision_of_held,
    "overlap-at-start": overlap_at_start,
    "prestressed": prestressed,
    "floating-support": floating_support,
    "ghost-contact": ghost_contact,
    "hole": hole,
    "over-damped": over_damped,
    "symmetric": symmetric,
    "too-late": too_late,
    "unsupported": unsupported,
    "off-camera": off_camera,
    "no-such-round": no_such_round,
}
"""What looks for each kind of finding."""

ONLY_BEFORE = DIAGNOSES.keys() - {
    "ghost-contact",
    "tunnelling",
    "hole",
    "unsupported",
    "too-late",
    "symmetric",
    "off-camera",
}
"""Of these a run tells nothing new."""


@dataclass(frozen=True, slots=True)
class Examination:
    """What was found before a run.

    Attributes:
        findings: in the order of the file.
        skipped: the kinds that were not looked for, because the scene has too many atoms.
    """

    findings: tuple[Finding, ...]
    skipped: tuple[str, ...]


def examine(loaded: LoadedScene, model: Model, state: State) -> Examination:
    """Look for everything that can be found in a scene without running it.

    Args:
        loaded: the scene and where it was written.
        model: what it compiles to.
        state: where its run begins.
    """
    scene, source = loaded.scene, loaded.source
    subject = Subject(scene, source, model, state)
    found: list[Finding] = []
    skipped = []
    with np.errstate(all="ignore"):  # infinite is a fair answer to absurd numbers
        for code, diagnosis in DIAGNOSES.items():
            try:
                for symptom in diagnosis(subject):
                    found.append(finding(code, "before", symptom, source))  # noqa: PERF401  # what comes before a stop is kept
            except (TooLargeError, MemoryError):
                skipped.append(code)
    found = list(dict.fromkeys(found))  # of copies the same may be found again and again
    codes = ONLY_BEFORE - set(skipped)
    kept = without_consequences(without_silenced(found, scene))
    kept += needless_silences(found, scene, source, "before", codes)
    return Examination(tuple(sorted(kept, key=lambda each: (each.file, each.line))), tuple(skipped))
