"""Scores of the diagnoses against folders of seeded faults: hits, misses, further warnings and false alarms.

    python tests/faults/score.py tests/faults/open tests/faults/own

A folder has `faults.json`: of each fault the codes that are right (`accept`), the paths that one finding must name, all
of them (`must_name`), and the line. A hit is one finding that has all three right. Lists of faults that only show in a
run are counted apart.
"""

from __future__ import annotations

import json
import statistics
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from atomsim.compiler import compile_scene
from atomsim.findings.before.diagnose import examine
from atomsim.findings.finding import Finding
from atomsim.scene.loader import load


@dataclass(frozen=True)
class Fault:
    """A scene with a fault, and what a right diagnosis says of it."""

    path: Path
    kind: str
    accept: tuple[str, ...]
    must_name: frozenset[str]
    line: int
    when: str

    def is_hit(self, found: Finding) -> bool:
        """Tell whether a finding is a right diagnosis."""
        return found.code in self.accept and self.must_name <= set(found.names) and found.line == self.line


@dataclass(frozen=True)
class Verdict:
    """What was found of a fault: the right diagnosis, or none, and the further warnings."""

    fault: Fault
    hit: Finding | None
    further: tuple[Finding, ...]


def faults_in(folder: Path) -> list[Fault]:
    """Read the faults of a folder."""
    return [
        Fault(
            folder / each["file"],
            each["kind"],
            tuple(each["accept"]),
            frozenset(each["must_name"]),
            each["line"],
            each["when"],
        )
        for each in json.loads((folder / "faults.json").read_text(encoding="utf-8"))["faults"]
    ]


def sound_in(folder: Path) -> list[Path]:
    """Return the sound scenes of a folder."""
    listed = json.loads((folder / "faults.json").read_text(encoding="utf-8"))["healthy"]
    return [folder / each["file"] for each in listed]


def before(path: Path, settings: Sequence[str] = ()) -> list[Finding]:
    """Return what is found in a scene before it runs."""
    loaded = load(path, settings)
    return list(examine(loaded, *compile_scene(loaded)).findings)


def judge(fault: Fault, diagnose: Callable[[Path], Sequence[Finding]] = before) -> Verdict:
    """Compare what is found in a scene with what is wrong with it."""
    found = diagnose(fault.path)
    hit = next((each for each in found if fault.is_hit(each)), None)
    further = tuple(each for each in found if each is not hit and each.level == "warning")
    return Verdict(fault, hit, further)


def table(verdicts: Sequence[Verdict]) -> str:
    """Return a Markdown table of hits, misses and further warnings."""
    lines = ["| fault | told as | further warnings |", "| --- | --- | --- |"]
    for verdict in verdicts:
        told = (
            f"`{verdict.hit.code}`" if verdict.hit else "after the run" if verdict.fault.when == "after" else "missed"
        )
        further = ", ".join(f"`{each.code}`" for each in verdict.further)
        name = f"{verdict.fault.path.parents[1].name}/{verdict.fault.path.stem}"
        lines.append(f"| {name} | {told} | {further} |")
    return "\n".join(lines)


def main(folders: Sequence[str]) -> None:
    """Print the table and the totals of some folders."""
    verdicts = [judge(fault) for folder in folders for fault in faults_in(Path(folder))]
    due = [verdict for verdict in verdicts if verdict.fault.when != "after"]
    print(table(verdicts))
    hits = sum(verdict.hit is not None for verdict in due)
    print(f"\n{hits} of {len(due)} faults that show before a run, {100 * hits / len(due):.0f} %")
    print(f"further warnings on a faulty scene: median {statistics.median(len(each.further) for each in verdicts):g}")
    for folder in folders:
        for path in sound_in(Path(folder)):
            for found in before(path):
                if found.level == "warning":
                    print(f"false alarm: {found}")


if __name__ == "__main__":
    main(sys.argv[1:])
