"""A long run with small frames: memory stays flat, the file grows evenly; with ATOMSIM_LONG=1, a million rounds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from atomsim.cli.terminal.progress import progress_line
from atomsim.scene import loads
from atomsim.tasks.run import run
from atomsim.trajectory import Trajectory, journal_path, recorder, trajectory_bytes

ROUNDS = 1_000_000 if os.environ.get("ATOMSIM_LONG") == "1" else 20_000

SCENE = f"""\
atomsim: 1
time_step: 0.05
rounds: {ROUNDS}
record_every: 1
groups:
  chain: {{shape: string, count: 4, step: [1.5, 0, 0], velocity: [0, 0.1, 0]}}
  ball: {{shape: atoms, positions: [[0, 4, 0]], velocity: [0.01, -0.2, 0]}}
bonds: {{chain: {{within: chain, rule: neighbour}}}}
collisions: {{c: {{between: [chain, ball]}}}}
"""


def memory() -> int:
    """Return the memory that this process really uses [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="tells its memory in another way")
@pytest.mark.timeout(3600)
def test_memory_stays_flat_and_the_file_grows_evenly(tmp_path, monkeypatch):
    monkeypatch.setattr(recorder, "BLOCK_SECONDS", 0.05)
    path = tmp_path / "out.h5"
    seen: list[tuple[int, int, int]] = []

    def look(round_index: int, rounds: int) -> None:
        if round_index % (ROUNDS // 100) == 0:  # not always: what is kept here would grow too
            seen.append((round_index, memory(), journal_path(path).stat().st_size))
        assert progress_line("round", 0, round_index, rounds, 1.0).startswith(f"round {round_index:,} of {ROUNDS:,}  ")

    run(loads(SCENE), path, report=look)
    rounds, memories, sizes = zip(*seen, strict=True)
    assert list(rounds) == sorted(rounds)
    assert (rounds[0], rounds[-1]) == (0, ROUNDS)
    settled = [used for round_index, used in zip(rounds, memories, strict=True) if round_index > ROUNDS // 4]
    assert max(settled) - min(settled) < 6 << 20
    per_frame = [
        size / round_index for round_index, size in zip(rounds, sizes, strict=True) if round_index > ROUNDS // 4
    ]
    assert max(per_frame) < 1.2 * 440
    assert 0.7 < path.stat().st_size / trajectory_bytes(5, ROUNDS, 1) < 1.1
    with Trajectory(path) as trajectory:
        assert len(trajectory) == ROUNDS + 1
        assert trajectory[-1].round_index == ROUNDS
