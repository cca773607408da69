"""What a run shows to be missing or wrong, with the lines of the scene that a person wrote."""

from __future__ import annotations

from pathlib import Path

from atomsim.errors import AtomsimError, Mark
from atomsim.findings.after.diagnose import examine_run
from atomsim.findings.after.look import Run
from atomsim.findings.before.diagnose import examine
from atomsim.findings.finding import Finding
from atomsim.findings.subject import Subject
from atomsim.scene import LoadedScene, load
from atomsim.scene.source import KeyPath, Source
from atomsim.tasks.recompute import compile_inside
from atomsim.trajectory import Header, Trajectory


def findings(trajectory: Trajectory) -> list[Finding]:
    """Return what can be found in a scene and in a run of it, those before the run first.

    Args:
        trajectory: the run.

    Raises:
        InputError: the scene inside is not that of the frames.
    """
    header = trajectory.header
    loaded, model, state = compile_inside(header, trajectory.path)
    loaded = with_places(header, loaded)
    before = examine(loaded, model, state).findings
    run = Run(header.rounds, header.record_every, int(trajectory.rounds[-1]), trajectory.end)
    after = examine_run(Subject(loaded.scene, loaded.source, model, state), run, trajectory, before)
    return [*before, *after]


def with_places(header: Header, inside: LoadedScene) -> LoadedScene:
    """Return the scene inside a trajectory with the places where a person wrote it.

    They are in its file, if that still says the same, else as far as was recorded.
    """
    try:
        file = load(Path(header.scene_name), header.overrides)
        if file.source.text == header.scene:
            return file
    except AtomsimError:
        pass  # it is gone, or another one by now
    marks: dict[KeyPath, Mark] = {
        (origin.section, origin.name): Mark(origin.file, origin.line, 1) for origin in header.origins
    }
    return LoadedScene(inside.scene, Source(header.scene_name, inside.source.text, header.overrides, marks))
