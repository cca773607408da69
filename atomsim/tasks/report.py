"""The report of a run: what happened, what was expected, what is missing, gathered and written as a file."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from atomsim.disk import behind, write_whole
from atomsim.errors import InputError, Remedy
from atomsim.findings.finding import Finding
from atomsim.measures.events import Event
from atomsim.tasks.expect import Judged, judged
from atomsim.tasks.findings import findings, with_places
from atomsim.tasks.measure import events
from atomsim.tasks.pages import as_html, as_markdown
from atomsim.tasks.plot import plot
from atomsim.tasks.recompute import scene_inside
from atomsim.tasks.render import render
from atomsim.trajectory import Trajectory

FORMATS = (".html", ".md", ".json")

MARK = "reported by atomsim"
"""Stands in every report of ours."""


@dataclass(frozen=True, slots=True, eq=False)
class Report:
    """What there is to say of a run.

    Attributes:
        title: what the scene calls itself, or its file.
        facts: what was run, with what, and how it ended, by name.
        events: what happened, in order.
        judged: what was expected, and what became of it.
        findings: what is missing or wrong, before the run and after it.
    """

    title: str
    facts: dict[str, str]
    events: tuple[Event, ...]
    judged: tuple[Judged, ...]
    findings: tuple[Finding, ...]


def gather(trajectory: Trajectory) -> Report:
    """Find out all that there is to say of a run.

    Raises:
        InputError: the scene inside is not that of the frames.
    """
    header, rounds = trajectory.header, trajectory.rounds
    facts = {
        "scene": header.scene_name,
        "settings": ", ".join(header.overrides) or "none",
        "atoms": f"{header.n_atoms:,} in {len(header.groups)} groups",
        "frames": f"{len(trajectory):,}, to round {int(rounds[-1]):,} of {header.rounds:,}",
        "time step": f"{header.time_step:g}",
        "ended": trajectory.end.kind,
        "made with": f"atomsim {header.program_version}, NumPy {header.numpy_version}, Python {header.python_version}",
        "digest": trajectory.digests[-1],
    }
    loaded = with_places(header, scene_inside(header, trajectory.path))
    return Report(
        title=header.title or Path(header.scene_name).name,
        facts=facts,
        events=tuple(events(trajectory)),
        judged=judged(trajectory, loaded),
        findings=tuple(findings(trajectory)),
    )


def check_report(path: Path, *, replace: bool) -> None:
    """Refuse a name that cannot become a report, or that another file has, before any work is done for it.

    Raises:
        InputError: another extension, a folder, a folder that does not exist, or a file that is no report of ours.
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{path}: a report is written as {', '.join(FORMATS[:-1])} or {FORMATS[-1]}")
    if path.is_dir():
        raise InputError(f"{path}: this is a folder; give the name of a file")
    folder = behind(path).parent
    if not folder.is_dir():
        raise InputError(f"{path}: the folder {folder} does not exist")
    if path.exists() and not replace and not _is_ours(path):
        raise InputError(f"{path} exists and is no report of atomsim's", Remedy("replace"))


def _is_ours(path: Path) -> bool:
    """Tell whether a file is a report that atomsim wrote: it says so, or is a list of findings."""
    try:
        text = path.read_text(encoding="utf-8")
        if path.suffix.lower() != ".json":
            return MARK in text
        return all(isinstance(each, dict) and "code" in each for each in json.loads(text))
    except (OSError, ValueError, TypeError):
        return False


def write_report(trajectory: Trajectory, path: Path) -> Report:
    """Gather the report of a run and write it: as a page with pictures, as Markdown, or the findings as data.

    Args:
        trajectory: the run.
        path: the file; its extension tells the format.

    Raises:
        InputError: the scene inside is not that of the frames.
        RunError: the file cannot be written.
    """
    report = gather(trajectory)
    if path.suffix.lower() == ".html":
        with TemporaryDirectory(prefix="atomsim-") as folder:
            strip, chart = Path(folder) / "strip.png", Path(folder) / "chart.svg"
            render(trajectory.path, strip)
            plot(trajectory.path, chart)
            text = as_html(report, MARK, strip.read_bytes(), chart.read_bytes())
    elif path.suffix.lower() == ".md":
        text = as_markdown(report, MARK)
    else:
        text = json.dumps([each.as_data() for each in report.findings], ensure_ascii=False, indent=1) + "\n"
    write_whole(path, text.encode("utf-8"))
    return report
