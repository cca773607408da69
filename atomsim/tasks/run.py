"""From a scene, or from where a trajectory stopped, to a recorded trajectory; knows no terminal."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from atomsim import arguments
from atomsim.compiler import compile_scene
from atomsim.core.backend import Backend, choose
from atomsim.core.diagnosis.tunnelling import SpeedWatch
from atomsim.core.free_memory import readable_bytes
from atomsim.core.model import Model, State
from atomsim.core.simulate import simulate
from atomsim.disk import behind
from atomsim.errors import BlowUpError, InputError, Remedy, RunError
from atomsim.findings.before.diagnose import examine
from atomsim.scene import LoadedScene
from atomsim.scene.difference import differences
from atomsim.tasks.recompute import compile_inside
from atomsim.trajectory import End, Header, Recorder, check_target, later_version, trajectory_bytes

Report: TypeAlias = Callable[[int, int], None]
"""Called with the round reached and the round to reach, at the start and then several times a second."""


class StopWishedError(Exception):
    """Raised by a report to end a run between two rounds; the frames so far are kept."""


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
        backend: what computed it, and why that.
        warning: what may have gone wrong unseen, or None.
    """

    path: Path
    rounds: int
    first_round: int
    last_round: int
    digest: str
    end: End
    backend: Backend
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
    rounds = scene.scene.rounds if rounds is None else arguments.whole("rounds", rounds)
    check_target(path, replace=replace)  # before anything that takes long
    model, state = compile_scene(scene)
    if warn is not None:
        for found in examine(scene, model, state).findings:
            if found.level == "warning":
                warn(str(found))
    header = Header.of(
        model,
        scene_text=scene.source.text,
        scene_name=scene.source.name,
        overrides=scene.source.overrides,
        rounds=rounds,
        record_every=scene.scene.record_every,
        compress=compress,
    )
    _require_disk(path, header)
    chosen = choose(backend, threads, model, header.rounds)
    with Recorder(path, header, replace=replace) as recorder:
        return _record(recorder, model, state, chosen, report)


def resume(
    path: str | os.PathLike[str],
    *,
    rounds: int | None = None,
    scene: LoadedScene | None = None,
    backend: str = "auto",
    threads: int | None = None,
    report: Report | None = None,
    warn: Callable[[str], None] | None = None,
) -> Outcome:
    """Go on with a trajectory from its last frame; the scene is inside it.

    The finished file is the one that an uninterrupted run would have written, byte for byte.

    Args:
        path: the trajectory, finished or stopped.
        rounds: total rounds to do; as planned before by default.
        scene: the scene that it is thought to be a run of.
        backend: as for `run`; it may be another one than before.
        threads: how many threads to use.
        report: hears how far the run is.
        warn: hears, before the run goes on, what to know of the trajectory.

    Raises:
        InputError: there is no such trajectory, it is damaged, it is one of another scene, or it has done these rounds
            already.
        RunError: it cannot be written, or another run writes it.
        BlowUpError: the numbers left the finite; the frames before are in the trajectory.
    """
    path = arguments.path("path", path)
    if rounds is not None:
        rounds = arguments.whole("rounds", rounds)
    if scene is not None:
        arguments.instance("scene", scene, LoadedScene, arguments.LOADED_SCENE)
    compiled: list[tuple[Model, State]] = []
    chosen: list[Backend] = []

    def accept(header: Header) -> None:
        inside, model, first = compile_inside(header, path)
        if warn is not None and header.versions.is_later:
            warn(str(later_version(path, header.versions)))
        if scene is not None:
            _require_same(inside, scene, path)
        _require_disk(path, header)
        compiled.append((model, first))
        chosen.append(choose(backend, threads, model, header.rounds))

    with Recorder.resume(path, rounds=rounds, accept=accept) as recorder:
        model, first = compiled[0]
        return _record(recorder, model, first, chosen[0], report)


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
    needed = 2 * trajectory_bytes(header.n_atoms, header.rounds, header.record_every, header.memory)
    folder = behind(path.absolute()).parent
    if not folder.is_dir():
        return  # the recorder says so better
    free = shutil.disk_usage(folder).free
    if needed > free:
        raise RunError(
            f"{path}: needs {readable_bytes(needed)} of disk while it is written, and {readable_bytes(free)} are free; "
            f"record fewer frames with a larger record_every"
        )


def _record(recorder: Recorder, model: Model, first: State, backend: Backend, report: Report | None) -> Outcome:
    """Compute and record the frames that are due, and finish the file, however the run ends.

    Args:
        recorder: knows where a resumed run goes on.
        model: the compiled scene.
        first: where the scene begins.
        backend: what computes it.
        report: hears how far the run is.
    """
    header = recorder.header
    is_recorded = recorder.state is not None  # a resumed run begins with a frame that is there already
    state = recorder.state or first
    first_round = state.round_index
    end, blow_up = End("finished"), None
    digest = ""
    watch = SpeedWatch(model)

    def report_round(round_index: int) -> None:
        if report is not None:
            report(round_index, header.rounds)

    try:
        for frame in simulate(
            model, state, header.rounds, header.record_every, backend.make_stepper, report=report_round, first=first
        ):
            if not is_recorded:
                recorder.append(frame)
            is_recorded = False
            watch.see(frame)
            state, digest = frame.state, frame.digest
    except StopWishedError:
        if state.round_index < header.rounds:  # else a resumed run had nothing left to do but to build its file
            end = End("interrupted")
    except BlowUpError as error:
        end, blow_up = End("blew up", str(error)), error
    recorder.finish(end)
    if blow_up is not None:
        raise BlowUpError(f"{blow_up}\n{recorder.path} keeps the frames up to round {state.round_index}")
    return Outcome(recorder.path, header.rounds, first_round, state.round_index, digest, end, backend, watch.warning())
