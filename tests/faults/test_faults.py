"""Seeded faults are told with their code, names and line; sound scenes, and all that is shipped, give no warning."""

from __future__ import annotations

import statistics
from functools import cache
from pathlib import Path

import pytest
from faults.score import Fault, Verdict, before, faults_in, judge, sound_in, table

from atomsim.findings.before.diagnose import DIAGNOSES
from atomsim.scene.loader import load

ROOT = Path(__file__).parents[2]
OPEN, OWN = (ROOT / "tests" / "faults" / name for name in ("open", "own"))

FAULTS = [*faults_in(OPEN), *faults_in(OWN)]
SOUND = [*sound_in(OPEN), *sound_in(OWN)]
EXAMPLES = [path for path in sorted((ROOT / "docs" / "examples").glob("*.yaml")) if path.stem != "extends"]
SHIPPED = [*sorted((ROOT / "scenes").rglob("*.yaml")), *EXAMPLES]
"""All but the example that extends a scene of another folder."""

NOT_BEFORE = {"87-energy-grows"}
"""Faults that may show before a run and are left to the run."""

VARIANTS = {
    "as it is": [],
    "a trace of jitter": ["jitter={amplitude: 1.0e-9}"],
    "jitter": ["jitter={amplitude: 0.02}"],
    "much jitter": ["jitter={amplitude: 0.05}"],
}

DUE = [fault for fault in FAULTS if fault.when != "after" and fault.path.stem not in NOT_BEFORE]


def name_of(value: object) -> str:
    if isinstance(value, Fault):
        value = value.path
    return f"{value.parent.parent.name}-{value.stem}" if isinstance(value, Path) else str(value)


@cache
def judged(fault: Fault) -> Verdict:
    return judge(fault)


@pytest.mark.parametrize("fault", DUE, ids=name_of)
def test_a_fault_is_told_before_the_run(fault: Fault) -> None:
    verdict = judged(fault)
    assert verdict.hit is not None, [str(each) for each in verdict.further]
    assert verdict.hit.remedy or fault.kind in ("unsupported", "floating-support")


@pytest.mark.parametrize("fault", FAULTS, ids=name_of)
def test_little_else_is_said_of_a_faulty_scene(fault: Fault) -> None:
    assert len(judged(fault).further) <= 2


def test_nothing_else_is_said_of_most_faulty_scenes() -> None:
    assert statistics.median(len(judged(fault).further) for fault in FAULTS) == 0


def test_the_table_of_the_docs_is_fresh() -> None:
    page = (ROOT / "docs" / "faults.md").read_text(encoding="utf-8")
    assert table([judged(fault) for fault in FAULTS]) in page


def test_the_own_half_has_every_kind_that_shows_before_a_run() -> None:
    assert len(faults_in(OWN)) >= 20
    assert {fault.kind for fault in faults_in(OWN)} >= set(DIAGNOSES) - {"no-such-round"}


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("path", [*SOUND, *SHIPPED], ids=name_of)
def test_no_warning_on_what_is_sound(path: Path, variant: str) -> None:
    assert [str(each) for each in before(path, VARIANTS[variant]) if each.level == "warning"] == []


@pytest.mark.parametrize("path", [*SOUND, *SHIPPED], ids=name_of)
def test_no_warning_on_what_is_cut_short(path: Path) -> None:
    rounds = load(path).scene.rounds
    warnings = [str(each) for each in before(path, [f"rounds={max(1, rounds // 2)}"]) if each.level == "warning"]
    assert warnings == []
