"""The way from a scene, or from where a trajectory stopped, to a recorded trajectory."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from atomsim import arguments
from atomsim.compiler.colors import group_colors
from atomsim.core.backend import Backend
from atomsim.core.diagnosis.tunnelling import SpeedWatch
from atomsim.core.digest import state_digest
from atomsim.core.free_memory import readable_bytes
from atomsim.disk import behind
from atomsim.errors import BlowUpError, InputError, Remedy, RunError
from atomsim.findings.before.diagnose import examine
from atomsim.scene import LoadedScene
from atomsim.scene.difference import differences
from atomsim.tasks.prepare import Prepared, prepare, prepare_inside
from atomsim.tasks.recompute import scene_inside
from atomsim.trajectory import End, Header, Recorder, StoppedRun, check_target, later_version, trajectory_bytes

Report: TypeAlias = Callable[[int, int], object]
"""Called with the round reached and the round to reach, at the start and then several times a second.

Where its answer is true the run ends there, between two rounds; the frames so far are kept.
"""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a run.

    Attributes:
        path: the trajectory.
        rounds: the round that was to be reached.
        first_round: the round it began or went on from.
        last_round: the round of the last frame.
        digest: the state digest of the last frame.
        end: whether it finished or was interrupted.
        backend: what computed it, and why that; None if there was nothing left to compute.
        warning: what may have gone wrong unseen, or None.
    """

    path: Path
    rounds: int
    first_round: int
    last_round: int
    digest: str
    end: End
    backend: Backend | None
    warning: str | None


def run(
    scene: LoadedScene,
    path: str | os.PathLike[str],
    *,
    rounds: int | None = None,
    replace: bool = False,
    compress: bool = False,
    backend: str = "auto",
    threads: int | None = None,
    report: Report | None = None,
    warn: Callable[[str], None] | None = None,
) -> Outcome:
    """Simulate a loaded scene and record its trajectory.

    Args:
        scene: the scene, as `load` returns it.
        path: the trajectory to write.
        rounds: iteration rounds to run; as the scene says by default.
        replace: whether an older trajectory of that name may go.
        compress: whether to write a smaller file, slowly.
        backend: `auto`, `numpy` or `numba`; whichever it is, the trajectory has the same bits.
        threads: how many threads to use; by default as many as are worth it.
        report: hears how far the run is.
        warn: hears, before the run begins, what it is likely to do wrong.

    Raises:
        SceneError: the scene does not compile.
        InputError: the trajectory exists, or cannot be there.
        RunError: it cannot be written.
        BlowUpError: the numbers left the finite; the frames before are in the trajectory.
    """
    arguments.instance("scene", scene, LoadedScene, arguments.LOADED_SCENE)
    path = arguments.path("path", path)
    for name, value in (("replace", replace), ("compress", compress)):
        arguments.flag(name, value)
    for name, hearer in (("report", report), ("warn", warn)):
        arguments.function(name, hearer)
    rounds = scene.scene.rounds if rounds is None else arguments.whole("rounds", rounds)
    check_target(path, replace=replace)  # before anything that takes long
    prepared = prepare(scene, rounds)
    if warn is not None:
        for found in examine(scene, prepared.model, prepared.first).findings:
            if found.level == "warning":
                warn(str(found))
    header = Header.of(
        prepared.model,
        group_color=tuple(group_colors(scene.scene).values()),
        scene_text=scene.source.text,
        scene_name=scene.source.name,
        overrides=scene.source.overrides,
        rounds=prepared.rounds,
        record_every=prepared.record_every,
        compress=compress,
    )
    _require_disk(path, header)
    chosen = prepared.choose(backend, threads)
    with Recorder.begin(path, header, replace=replace) as recorder:
        return _record(recorder, prepared, chosen, report)


def resume(
    path: str | os.PathLike[str],
    *,
    rounds: int | None = None,
    scene: LoadedScene | None = None,
    replace: bool = False,
    backend: str = "auto",
    threads: int | None = None,
    report: Report | None = None,
    warn: Callable[[str], None] | None = None,
) -> Outcome:
    """Go on with a trajectory from its last frame; the scene is inside it.

    The finished file is the one that an uninterrupted run would have written, byte for byte, with the author's name
    that it has. One that has all its rounds stays as it is.

    Args:
        path: the trajectory, finished or stopped.
        rounds: total rounds to do; as planned before by default.
        scene: the scene that it is thought to be a run of.
        replace: whether what another program added to the finished file may go with it.
        backend: as for `run`; it may be another one than before.
        threads: how many threads to use.
        report: hears how far the run is.
        warn: hears, before the run goes on, what to know of the trajectory.

    Raises:
        InputError: there is no such trajectory, it is damaged, one of another scene, or holds what another program
            added to it.
        RunError: it cannot be written, or another run writes it.
        BlowUpError: the numbers left the finite; the frames before are in the trajectory.
    """
    path = arguments.path("path", path)
    if rounds is not None:
        rounds = arguments.whole("rounds", rounds)
    if scene is not None:
        arguments.instance("scene", scene, LoadedScene, arguments.LOADED_SCENE)
    arguments.flag("replace", replace)
    for name, hearer in (("report", report), ("warn", warn)):
        arguments.function(name, hearer)
    with StoppedRun(path, rounds, replace=replace) as stopped:
        header = stopped.header
        if stopped.is_complete:
            if scene is not None:
                _require_same(scene_inside(header, path), scene, path)
            return _nothing_to_do(stopped)
        prepared = prepare_inside(header, path, header.rounds)
        if warn is not None and header.is_later:
            warn(str(later_version(path, header)))
        if scene is not None:
            _require_same(prepared.loaded, scene, path)
        _require_disk(path, header)
        chosen = prepared.choose(backend, threads)
        with stopped.go_on() as recorder:
            return _record(recorder, prepared, chosen, report)


def _nothing_to_do(stopped: StoppedRun) -> Outcome:
    """Return what became of a run that was complete before."""
    state = stopped.state
    assert state is not None  # there is a finished file, and none without a frame
    digest = state_digest(state.position, state.velocity, state.memory)
    done = state.round_index
    return Outcome(stopped.path, stopped.header.rounds, done, done, digest, End("finished"), None, None)


def _require_same(inside: LoadedScene, scene: LoadedScene, path: Path) -> None:
    """Refuse to go on with a scene that was changed: the file would be the run of no scene."""
    changed = differences(inside.scene, scene.scene)
    if changed:
        raise InputError(
            f"{path} is a run of another scene than {scene.source.name} is now:\n"
            + "\n".join(f"  {line}" for line in changed),
            Remedy("go on", path),
            Remedy("new file", Path(scene.source.name)),
        )


def _require_disk(path: Path, header: Header) -> None:
    """Refuse a run whose frames do not fit on the disk; while the file is built they are there twice."""
    needed = 2 * trajectory_bytes(header.n_atoms, header.rounds, header.record_every, header.layout)
    folder = behind(path.absolute()).parent
    if not folder.is_dir():
        return  # the recorder says so better
    free = shutil.disk_usage(folder).free
    if needed > free:
        raise RunError(
            f"{path}: needs {readable_bytes(needed)} of disk while it is written, and {readable_bytes(free)} are free; "
            f"record fewer frames with a larger record_every"
        )


def _record(recorder: Recorder, prepared: Prepared, backend: Backend, report: Report | None) -> Outcome:
    """Compute and record the frames that are due, and finish the file, however the run ends.

    Args:
        recorder: knows where a resumed run goes on.
        prepared: the scene.
        backend: what computes it.
        report: hears how far the run is.
    """
    rounds, state = prepared.rounds, recorder.state or prepared.first
    first_round, digest, blow_up = state.round_index, "", None
    is_recorded = recorder.state is not None  # a resumed run begins with a frame that is there already
    watch = SpeedWatch(prepared.model)
    try:
        for frame in prepared.frames(backend, state, report and (lambda reached: report(reached, rounds))):
            if not is_recorded:
                recorder.append(frame)
            is_recorded = False
            watch.see(frame)
            state, digest = frame.state, frame.digest
        # A resumed run may have had nothing left to do but to build its file.
        end = End("finished" if state.round_index >= rounds else "interrupted")
    except BlowUpError as error:
        end, blow_up = End("blew up", str(error)), error
    recorder.finish(end)
    if blow_up is not None:
        raise BlowUpError(f"{blow_up}\n{recorder.path} keeps the frames up to round {state.round_index}")
    return Outcome(recorder.path, rounds, first_round, state.round_index, digest, end, backend, watch.warning())
