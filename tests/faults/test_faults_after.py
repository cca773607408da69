"""Faults that show in a run are told after it, with code, names and line; runs of what is sound give no warning."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from faults.score import Fault, faults_in, judge, sound_in

import atomsim
from atomsim.findings.finding import Finding
from atomsim.tasks.findings import findings

ROOT = Path(__file__).parents[2]
OPEN, OWN = (ROOT / "tests" / "faults" / name for name in ("open", "own"))

FAULTS = [fault for fault in (*faults_in(OPEN), *faults_in(OWN)) if fault.when != "before"]
SOUND = [
    *sound_in(OPEN),
    *sound_in(OWN),
    *sorted((ROOT / "scenes").rglob("*.yaml")),
    *(path for path in sorted((ROOT / "docs" / "examples").glob("*.yaml")) if path.stem != "extends"),
]


def after(path: Path, folder: Path, settings: list[str]) -> list[Finding]:
    """Run a scene and return what is found before it and after it."""
    out = folder / "out.h5"
    with contextlib.suppress(atomsim.BlowUpError):
        atomsim.run(atomsim.load(path, settings), out, backend="numpy")
    with atomsim.Trajectory(out) as run:
        return findings(run)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.path.stem)
def test_a_fault_is_told_after_the_run(fault: Fault, tmp_path: Path) -> None:
    verdict = judge(fault, lambda path: after(path, tmp_path, []))
    assert verdict.hit is not None, [str(each) for each in verdict.further]
    assert len(verdict.further) <= 3


@pytest.mark.parametrize("settings", [[], ["jitter={amplitude: 0.02}"]], ids=["as it is", "jitter"])
@pytest.mark.parametrize("path", SOUND, ids=lambda path: path.stem)
def test_no_warning_after_a_run_of_what_is_sound(path: Path, settings: list[str], tmp_path: Path) -> None:
    assert [str(each) for each in after(path, tmp_path, settings) if each.level == "warning"] == []
