"""The table of the diagnoses after a run, and one pass over its frames that serves them all."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from atomsim.core.model import Frame
from atomsim.findings.after.crossing import Crossings
from atomsim.findings.after.energy_grows import EnergyGrows
from atomsim.findings.after.look import Look, MakeWatch, Run
from atomsim.findings.after.moving import Hovers, LeftScene, Restless, RestsEarly
from atomsim.findings.after.passing import GhostContact, SelfPass
from atomsim.findings.after.strained import BlowUp, CoarseRecord, Overpowered
from atomsim.findings.after.symmetric import Symmetric
from atomsim.findings.after.touching import Touches
from atomsim.findings.finding import Finding, finding, without_consequences
from atomsim.findings.silence import without_silenced
from atomsim.findings.subject import Subject

WATCHES: tuple[MakeWatch, ...] = (
    GhostContact,
    SelfPass,
    Crossings,
    Hovers,
    Touches,
    Symmetric,
    CoarseRecord,
    Overpowered,
    EnergyGrows,
    BlowUp,
    LeftScene,
    Restless,
    RestsEarly,
)
"""What looks for findings in the frames of a run."""


def examine_run(subject: Subject, run: Run, frames: Iterable[Frame], before: Sequence[Finding]) -> list[Finding]:
    """Look for everything that the frames of a run show; memory does not grow with their number.

    Args:
        subject: the scene that was run.
        run: what is known of the run besides its frames.
        frames: its frames, in order.
        before: what was found before the run, which is not said again.

    Returns:
        What was found, in the order of the file.
    """
    watches = [make(subject, run) for make in WATCHES]
    last: Frame | None = None
    with np.errstate(all="ignore"):  # infinite is a fair answer to absurd numbers
        for frame in frames:
            look = Look(subject, frame, last)
            for watch in watches:
                watch.see(look)
            last = frame
        found = [
            finding(code, "after", symptom, subject.source)
            for watch in watches
            for code, symptoms in watch.diagnoses().items()
            for symptom in symptoms()
        ]
    told = {(each.code, each.names) for each in before}
    fresh = [each for each in found if (each.code, each.names) not in told]
    kept = without_consequences([*before, *without_silenced(fresh, subject.scene)])
    return sorted((each for each in kept if each.when == "after"), key=lambda each: (each.file, each.line))
