"""From a scene to a recorded trajectory: how a run that is stopped at an awkward moment ends."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.running import SCENES

from atomsim.record import StopWishedError, resume, run
from atomsim.scene import load
from atomsim.trajectory import End, Recorder


class Killed(BaseException):
    """Stands for a signal that no handler sees."""


def stop_at_once(round_index: int, rounds: int) -> None:
    raise StopWishedError


def be_killed(recorder: Recorder, end: End) -> None:
    raise Killed


def test_a_wish_to_stop_when_all_is_computed_comes_too_late(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All frames are in the journal and only the file is missing: it is that of a run without a stop."""
    scene = load(SCENES / "threads.yaml")
    whole, path = tmp_path / "whole.h5", tmp_path / "out.h5"
    run(scene, whole, rounds=30)
    with monkeypatch.context() as patch:
        patch.setattr(Recorder, "finish", be_killed)
        with pytest.raises(Killed):
            run(scene, path, rounds=30)
    assert resume(path, report=stop_at_once).end.kind == "finished"
    assert path.read_bytes() == whole.read_bytes()


def test_a_wish_to_stop_before_keeps_what_there_is(tmp_path: Path) -> None:
    path = tmp_path / "out.h5"
    outcome = run(load(SCENES / "threads.yaml"), path, rounds=30, report=stop_at_once)
    assert (outcome.end.kind, outcome.last_round) == ("interrupted", 0)
    assert resume(path).end.kind == "finished"
