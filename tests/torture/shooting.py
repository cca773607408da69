"""Runs that are shot at random moments, gone on with, and shot again; a script, for its children are forked.

    python tests/torture/shooting.py N_KILLS SEED BACKEND...

A child is a whole `atomsim` command in a process of its own, forked from one that has loaded everything, so that
hundreds take minutes. After every shot, what the file holds must be the beginning of the uninterrupted run and no less
than before; in the end it must be that run, byte for byte. Prints what was done, as JSON.
"""

from __future__ import annotations

import json
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from atomsim.cli import main
from atomsim.errors import InputError
from atomsim.tasks.render import render
from atomsim.trajectory import Trajectory, journal_path, recorder

SCENE = Path(__file__).parents[2] / "scenes" / "rods.yaml"
ROUNDS, FEWER_ROUNDS = 2000, 1234
SIGNALS = [signal.SIGKILL] * 6 + [signal.SIGINT, signal.SIGTERM]


@dataclass
class Range:
    """What all targets share.

    Attributes:
        whole: the uninterrupted run.
        seconds: about how long a command lives; learnt, for other work may slow the machine.
        backends: to choose from.
        dice: chooses moments, signals and backends.
        counts: what has happened.
    """

    whole: Path
    seconds: float
    backends: list[str]
    dice: random.Random
    counts: Counter[str]


class Target:
    """One trajectory that is written under fire."""

    def __init__(self, path: Path, shared: Range) -> None:
        self._path = path
        self._shared = shared
        self._whole = shared.whole
        self._dice = shared.dice
        self._counts = shared.counts
        self._n_frames = 0
        with Trajectory(self._whole) as trajectory:
            self._digests = dict(zip(trajectory.rounds.tolist(), trajectory.digests, strict=True))

    def shoot(self) -> None:
        """Start, shoot, check and go on, until the file is the uninterrupted run."""
        while not self._is_whole():
            rounds = ROUNDS if self._n_frames else self._dice.choice([ROUNDS, FEWER_ROUNDS])
            child = start(
                *self._command(), "--rounds", str(rounds), "--backend", self._dice.choice(self._shared.backends)
            )
            arms = self._dice.choice(SIGNALS)
            # Half of the shots are meant for the end, when the file is built.
            time.sleep(
                self._shared.seconds * self._dice.choice([self._dice.uniform(0, 1.1), self._dice.uniform(0.8, 1.05)])
            )
            os.kill(child, arms)
            self._check_code(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), arms)
            self._check_frames()
        assert self._path.read_bytes() == self._whole.read_bytes()
        self._counts["files finished"] += 1

    def _command(self) -> list[str]:
        if self._path.exists() or journal_path(self._path).exists():
            self._counts["resumed"] += 1
            return ["run", "--resume", str(self._path)]
        return ["run", str(SCENE), "-o", str(self._path)]

    def _is_whole(self) -> bool:
        if journal_path(self._path).exists() or not self._path.exists():
            return False
        with Trajectory(self._path) as trajectory:
            return int(trajectory.rounds[-1]) == ROUNDS

    def _check_code(self, code: int, arms: signal.Signals) -> None:
        self._counts["ended before the shot" if code == 0 else f"ended by {arms.name}"] += 1
        self._shared.seconds *= 0.9 if code == 0 else 1.02
        # Before its handlers are there, a process dies of SIGTERM as the system has it.
        allowed = {signal.SIGKILL: {-9}, signal.SIGINT: {130}, signal.SIGTERM: {143, -15}}[arms]
        assert code in {0, *allowed}, (code, arms)

    def _check_frames(self) -> None:
        if not self._path.exists() and not journal_path(self._path).exists():
            assert self._n_frames == 0
            return
        try:
            trajectory = Trajectory(self._path)
        except InputError as error:
            if self._n_frames or "holds no frame yet" not in str(error):
                raise
            return
        with trajectory:
            digests = dict(zip(trajectory.rounds.tolist(), trajectory.digests, strict=True))
            trajectory.verify()
        digests.pop(FEWER_ROUNDS, None)  # the last frame of a shorter run, which a longer one does not record
        assert digests == {round_index: self._digests[round_index] for round_index in digests}
        assert list(digests) == list(self._digests)[: len(digests)]
        assert len(digests) >= self._n_frames
        self._n_frames = len(digests)
        self._counts["frames checked"] += len(digests)


def start(*arguments: str) -> int:
    """Start a command in a child and return its process id."""
    child = os.fork()
    if child:
        return child
    code = 1
    signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background, it would be ignored
    try:
        sys.stdout = sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115 - ends with the child
        sys.argv = ["atomsim", *arguments]
        main()
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        os._exit(code)


def shoot_at_many(n_kills: int, seed: int, backends: list[str], folder: Path) -> Counter[str]:
    """Write one file after the other under fire until there were so many shots."""
    recorder.BLOCK_SECONDS = 0.02  # kills come in fractions of a second here
    whole = folder / "whole.h5"
    began = time.monotonic()
    os.waitpid(start("run", str(SCENE), "-o", str(whole), "--rounds", str(ROUNDS), "--backend", backends[0]), 0)
    seconds = time.monotonic() - began
    render(whole, folder / "whole.png", size=(32, 24))
    counts: Counter[str] = Counter()
    shared = Range(whole, seconds, backends, random.Random(seed), counts)
    while sum(counts[f"ended by {arms.name}"] for arms in set(SIGNALS)) < n_kills:
        path = folder / f"{counts['files finished']}.h5"
        Target(path, shared).shoot()
        render(path, folder / "again.png", size=(32, 24))
        assert (folder / "again.png").read_bytes() == (folder / "whole.png").read_bytes()
        path.unlink()
        assert {left.name for left in folder.iterdir()} == {"whole.h5", "whole.png", "again.png"}
    return counts


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        print(json.dumps(shoot_at_many(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3:], Path(name))))
