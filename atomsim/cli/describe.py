"""Compiled scenes and trajectories in a few lines for people; decides nothing."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from atomsim.cli.remedies import with_remedies
from atomsim.compiler.room import BYTES_PER_ATOM, BYTES_PER_PAIR
from atomsim.core.diagnosis.stiffness import largest_time_step
from atomsim.core.forces import held_atoms
from atomsim.core.free_memory import readable_bytes
from atomsim.core.model import BondTable, CollisionTable, GroupSpan, Indices, Model, State
from atomsim.core.numpy_backend.bonds import bond_forms
from atomsim.core.pairs.collisions import n_collision_pairs
from atomsim.scene.mistakes.wording import printable
from atomsim.trajectory import count_frames, trajectory_bytes

if TYPE_CHECKING:
    from atomsim.findings.before.diagnose import Examination
    from atomsim.findings.finding import Finding
    from atomsim.trajectory import Trajectory

BYTES_OF_PROGRAM = 60_000_000
"""What Python and the packages take, whatever the scene."""


def describe_model(model: Model, state: State, rounds: int, record_every: int) -> list[str]:
    """Return what a scene holds and what running it takes.

    Args:
        model: the compiled scene.
        state: its first state.
        rounds: iteration rounds to run.
        record_every: rounds between two frames.
    """
    n_frames = count_frames(rounds, record_every)
    size = trajectory_bytes(model.n_atoms, rounds, record_every, model.memory)
    limit = largest_time_step(model, state)
    stable = [] if limit == math.inf else [f"stable below {limit:.3g}"]
    n_bonds = sum(table.first.size for table in model.bonds)
    n_pairs = sum(n_collision_pairs(table) for table in model.collisions)
    held = held_atoms(model.forces)
    on: Counter[str] = Counter()
    for force in model.forces:
        on[force.origin.name] += force.atoms.size
    return [
        _line("atoms", f"{model.n_atoms:,}", (_group(group) for group in model.groups)),
        _line("bonds", f"{n_bonds:,}", (_bonds(table, held) for table in model.bonds)),
        _line("collisions", f"{n_pairs:,} pairs", (_collisions(table) for table in model.collisions)),
        _line("forces", f"{len(on)}", (f"{name} on {n_atoms:,}" for name, n_atoms in on.items())),
        _line("run", f"{rounds:,} rounds of τ = {model.time_step:g}", stable),
        _line("record", f"{n_frames:,} frames, {readable_bytes(size)}", ()),
        _line("memory", f"about {readable_bytes(_memory(model))}", ()),
    ]


def describe_findings(examination: Examination) -> Iterator[str]:
    """Yield what was found in a scene, each with the YAML that takes it away, and what was not looked for."""
    for found in examination.findings:
        yield from finding_lines(found)
    if examination.skipped:
        yield f"  skipped    for so many atoms: {', '.join(examination.skipped)}"


def finding_lines(found: Finding) -> Iterator[str]:
    """Yield a finding, and the YAML that takes it away."""
    yield printable(str(found))
    if found.remedy:
        yield "  remedy:"
        yield from (f"    {line}" for line in found.remedy.splitlines())


def describe_trajectory(trajectory: Trajectory) -> list[str]:
    """Return what a trajectory holds, where it came from and how it ended."""
    header, rounds = trajectory.header, trajectory.rounds
    overrides = (f"--set {override}" for override in header.overrides)
    lines = [
        f"{trajectory.path}: {header.title}" if header.title else str(trajectory.path),
        _line("scene", header.scene_name, overrides),
        _line("atoms", f"{header.n_atoms:,}", (_group(group) for group in header.groups)),
        _line("bonds", f"{len(header.bond):,}", ()),
        _line("frames", f"{len(trajectory):,}, round {rounds[0]} to {rounds[-1]} of {header.rounds}", ()),
        _line("time step", f"τ = {header.time_step:g}", ()),
        _line("ended", trajectory.end.kind, trajectory.end.report.splitlines()),
        _line(
            "made with",
            f"atomsim {header.program_version}, NumPy {header.numpy_version}, Python {header.python_version}",
            (),
        ),
        _line("digest", f"{trajectory.digests[-1]} (round {rounds[-1]})", ()),
        "",
        f"  {'':<28}{'first frame':>14}{'last frame':>14}",
    ]
    for name, series in trajectory.observables.items():
        if series.ndim == 1:
            lines.append(f"  {name.replace('_', ' '):<28}{series[0]:>14.6g}{series[-1]:>14.6g}")
        else:
            length = [math.hypot(*row) for row in (series[0], series[-1])]
            lines.append(f"  {'|' + name.replace('_', ' ') + '|':<28}{length[0]:>14.6g}{length[1]:>14.6g}")
    return [printable(line) for line in (*lines, *map(with_remedies, trajectory.notices()))]


def _line(label: str, value: str, details: Iterable[str]) -> str:
    """Write one line: what, how much, and its parts."""
    parts = ", ".join(details)
    return f"  {label:<11}{value}" + (f": {parts}" if parts else "")


def _group(group: GroupSpan) -> str:
    return f"{group.name} {group.stop - group.start:,}"


def _bonds(table: BondTable, held: Indices) -> str:
    """Name a table, its size and the forms it is computed in."""
    forms = dict.fromkeys(form.name for form in bond_forms(table, held))
    return f"{table.origin.name} {table.first.size:,} ({', '.join(forms) or 'held, not computed'})"


def _collisions(table: CollisionTable) -> str:
    return f"{table.origin.name} {n_collision_pairs(table):,}"


def _memory(model: Model) -> int:
    """Estimate what a run holds at once: arrays of the state, tables in their forms, waiting frames."""
    n_bonds = sum(table.first.size for table in model.bonds)
    return BYTES_OF_PROGRAM + BYTES_PER_ATOM * model.n_atoms + BYTES_PER_PAIR * n_bonds
