"""From a scene to a recorded trajectory: what is refused at once, how a run stopped at an awkward moment ends."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from support.running import SCENES

from atomsim.compiler import compile_scene
from atomsim.core.simulate import simulate
from atomsim.errors import InputError, RunError, SceneError
from atomsim.scene import load
from atomsim.tasks.run import resume, run
from atomsim.trajectory import End, Header, Recorder


class Killed(BaseException):
    """Stands for a signal that no handler sees."""


def stop_at_once(round_index: int, rounds: int) -> bool:
    return True


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


def test_a_run_needs_rounds(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        run(load(SCENES / "threads.yaml"), tmp_path / "out.h5", rounds=0)
    assert str(caught.value) == "rounds: needs a whole number of 1 or more (got 0)"
    assert not list(tmp_path.iterdir())


def test_a_taken_name_is_told_before_the_scene_is_compiled(tmp_path: Path) -> None:
    nonsense = load(SCENES / "threads.yaml", ["bonds.left.within=left[999]"])
    path = tmp_path / "out.h5"
    run(load(SCENES / "threads.yaml"), path, rounds=10)
    with pytest.raises(InputError, match="exists"):
        run(nonsense, path)
    with pytest.raises(SceneError, match="is out of range"):
        run(nonsense, path, replace=True)


def test_a_run_that_goes_on_has_to_fit_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "out.h5"
    run(load(SCENES / "threads.yaml"), path, rounds=10)
    before = path.read_bytes()
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=10**6))
    with pytest.raises(RunError, match=r"of disk while it is written, and 1\.0 MB are free"):
        resume(path, rounds=100_000)
    assert [left.read_bytes() for left in tmp_path.iterdir()] == [before]


def written_by(version: str, path: Path, **changes: str) -> Path:
    """Record a run that says it was made by another version."""
    scene = load(SCENES / "threads.yaml")
    model, state = compile_scene(scene)
    header = Header.of(
        model,
        group_color=["#000000"] * len(model.groups),
        scene_text=changes.get("scene", scene.source.text),
        scene_name="threads.yaml",
        rounds=20,
        record_every=scene.scene.record_every,
    )
    header = replace(header, program_version=version)
    with Recorder.begin(path, header) as recorder:
        for frame in simulate(model, state, 20, scene.scene.record_every):
            recorder.append(frame)
        recorder.finish(End("finished"))
    return path


@pytest.mark.parametrize(("version", "n_warnings"), [("9.1.0", 1), ("0.1.0", 0)])
def test_going_on_with_the_run_of_a_later_version_is_told(tmp_path: Path, version: str, n_warnings: int) -> None:
    path = written_by(version, tmp_path / "out.h5")
    heard: list[str] = []
    assert resume(path, rounds=30, warn=heard.append).last_round == 30
    assert len(heard) == n_warnings
    assert all(f"{path}: written by atomsim 9.1.0, this is " in message for message in heard)


def test_a_scene_of_a_later_version_is_not_called_damage(tmp_path: Path) -> None:
    scene = load(SCENES / "threads.yaml").source.text + "wishes: {}\n"
    path = written_by("9.1.0", tmp_path / "out.h5", scene=scene)
    with pytest.raises(InputError) as caught:
        resume(path, rounds=30)
    assert f"{path}: written by atomsim 9.1.0, this is " in str(caught.value)
    assert "a later one is needed (the scene inside: " in str(caught.value)
