"""Real kills: a writer that is shot at any moment loses nothing that it had written."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path

from sample_run import digest_of, go_on, header, holds, record, resume
from support.process import finish, python

from atomsim.trajectory import Trajectory, journal_path, recover
from atomsim.trajectory.journal.read import Journal

N_KILLS = 400 if os.environ.get("ATOMSIM_LONG") else 12

SHOOTING = """
import json, os, random, signal, sys, time
from pathlib import Path
import h5py
from sample_run import go_on, header
from atomsim.trajectory import Recorder, recorder

recorder.BLOCK_SECONDS = 0.0
folder, n_kills = Path(sys.argv[1]), int(sys.argv[2])

def write(path, counter):
    with Recorder.begin(path, header(400)) as recording:
        append = recording.append
        def counted(frame):
            append(frame)
            os.write(counter, b".")
        recording.append = counted
        go_on(recording)

def start(path):
    read, counter = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read)
        write(path, counter)
        os._exit(0)
    os.close(counter)
    return child, read

began = time.monotonic()
child, read = start(folder / "timed.h5")
os.waitpid(child, 0)
whole = time.monotonic() - began
random.seed(1)
counts = []
for i in range(n_kills):
    child, read = start(folder / f"{i}.h5")
    time.sleep(random.uniform(0, 1.1 * whole))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    counts.append(len(os.read(read, 1000)))
    os.close(read)
print(json.dumps(counts))
"""


def test_a_killed_writer_loses_nothing(tmp_path: Path) -> None:
    """A process forks writers and kills each at a random moment of its life, building included."""
    whole = record(tmp_path / "whole.h5", header(400))
    path = str(Path(__file__).parent)
    shooting = finish(
        tmp_path, str(N_KILLS), program=python(SHOOTING), timeout=1800, PYTHONPATH=path, OPENBLAS_NUM_THREADS="1"
    )
    n_written = json.loads(shooting.stdout)
    assert len(n_written) == N_KILLS
    for i, count in enumerate(n_written):
        path = tmp_path / f"{i}.h5"
        if not path.exists() and not journal_path(path).exists():
            assert count == 0
            continue
        _check_frames(path, count)
        _go_on_after_the_kill(path)
        assert digest_of(path) == digest_of(whole)
        assert not journal_path(path).exists()


def _check_frames(path: Path, count: int) -> None:
    if count == 0:
        with contextlib.closing(Journal(os.open(journal_path(path), os.O_RDONLY))) as journal:
            if len(journal.series) == 0:
                return
    with Trajectory(path) as trajectory:
        assert len(trajectory) >= count
        assert holds(trajectory, list(range(0, 10 * len(trajectory), 10)))


def _go_on_after_the_kill(path: Path) -> None:
    if journal_path(path).exists():
        with contextlib.closing(Journal(os.open(journal_path(path), os.O_RDONLY))) as journal:
            is_ended = journal.end.kind == "finished"
        if is_ended:
            recover(path)
        else:
            with resume(path) as recording:
                go_on(recording)
