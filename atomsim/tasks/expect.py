"""Whether a scene does what it says it should: run, judge every expectation, draw the rounds of those that fail."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from atomsim.errors import AtomsimError, BlowUpError, InputError
from atomsim.measures.robustness import Trace, Verdict, judge
from atomsim.measures.series import measured
from atomsim.scene import LoadedScene, load
from atomsim.scene.language import Expectation
from atomsim.scene.language.expectations import BOUNDS
from atomsim.scene.language.measures import parse_measure
from atomsim.tasks.measure import resolved
from atomsim.tasks.render import render
from atomsim.tasks.run import run
from atomsim.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class Judged:
    """What became of one expectation.

    Attributes:
        name: as it is called in the scene.
        file: where it is written.
        line: the line there, from 1.
        verdict: how far it is from failing, and what decides it.
        picture: the round that decides it, drawn; None if it is met or nobody asked for pictures.
    """

    name: str
    file: str
    line: int
    verdict: Verdict
    picture: Path | None = None

    def __str__(self) -> str:
        verdict, unit = self.verdict, _unit(self.verdict.claim)
        value = f"{verdict.claim.measure} is {verdict.value:.4g} in round {verdict.round_index}"
        if verdict.is_open:
            return f"{self.name}: not told before the run ended; last, {value}"
        if verdict.is_met:
            return f"{self.name}: met by {verdict.margin:.3g}{unit}; {value}"
        return f"{self.name}: fails by {-verdict.margin:.3g}{unit}; {value}, not {_bound(verdict.claim)}"


@dataclass(frozen=True, slots=True)
class Tried:
    """What became of one scene.

    Attributes:
        scene: its file.
        judged: every expectation that was asked about, in order.
        error: why it could not be run to its end, or empty.
        seconds: how long it took.
    """

    scene: Path
    judged: tuple[Judged, ...]
    error: str
    seconds: float

    @property
    def failed(self) -> tuple[Judged, ...]:
        """The expectations that are not met, or not told."""
        return tuple(each for each in self.judged if not each.verdict.is_met)

    @property
    def is_good(self) -> bool:
        """Whether it ran and met all that was expected."""
        return not (self.error or self.failed)


@dataclass(frozen=True, slots=True)
class Trial:
    """How scenes are tried.

    Attributes:
        word: only expectations whose `scene.name` has this in it.
        backend: what computes.
        pictures: the folder for pictures of failures; None for none.
    """

    word: str = ""
    backend: str = "auto"
    pictures: Path | None = None


def judged(trajectory: Trajectory, loaded: LoadedScene, names: Sequence[str] | None = None) -> tuple[Judged, ...]:
    """Judge what a scene expects by a run of it.

    Args:
        trajectory: the run.
        loaded: the scene, with the places of its expectations.
        names: which expectations; by default all.

    Raises:
        InputError: an expectation that makes no sense for these atoms.
    """
    scene = loaded.scene
    asked = {name: scene.expect[name] for name in (scene.expect if names is None else names)}
    texts = tuple(dict.fromkeys(text for expectation in asked.values() for text in expectation.measures))
    if not texts:
        return ()
    numbers = measured(trajectory, *resolved(trajectory, texts))
    rounds = max(trajectory.header.rounds, scene.rounds)
    trace = Trace(trajectory.rounds, rounds, {text: numbers[text] for text in texts})
    found = []
    for name, expectation in asked.items():
        mark = loaded.source.mark(("expect", name))
        found.append(Judged(name, mark.file, mark.line, judge(expectation, trace)))
    return tuple(found)


def scenes_in(paths: Sequence[Path]) -> list[Path]:
    """Return scene files: those named, and in folders, all that end in .yaml or .yml, however deep.

    Raises:
        InputError: there is no such file, or a folder has no scenes.
    """
    found: list[Path] = []
    for path in paths:
        if not path.is_dir():
            found.append(path)
            continue
        inside = sorted(each for each in path.rglob("*") if each.suffix in (".yaml", ".yml") and each.is_file())
        if not inside:
            raise InputError(f"{path}: there are no scenes in this folder")
        found += inside
    return list(dict.fromkeys(found))


def try_scenes(scenes: Sequence[Path], trial: Trial, n_processes: int) -> Iterator[Tried]:
    """Run scenes and judge what they expect, in order; several at a time, if asked for.

    Args:
        scenes: their files; one that expects nothing that was asked about is not run.
        trial: how.
        n_processes: how many run at a time.
    """
    if n_processes == 1 or len(scenes) == 1:
        yield from (try_scene(scene, trial) for scene in scenes)
        return
    with ProcessPoolExecutor(min(n_processes, len(scenes))) as pool:
        try:
            yield from pool.map(try_scene, scenes, [trial] * len(scenes))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def try_scene(scene: Path, trial: Trial) -> Tried:
    """Run a scene and judge what it expects; what goes wrong is part of the answer."""
    started = time.monotonic()
    found, error = _tried(scene, trial)
    return Tried(scene, found, error, time.monotonic() - started)


def _tried(path: Path, trial: Trial) -> tuple[tuple[Judged, ...], str]:
    try:
        loaded = load(path)
        names = [name for name in loaded.scene.expect if trial.word in f"{path.stem}.{name}"]
        if not names:
            return (), ""
        with TemporaryDirectory(prefix="atomsim-") as folder:
            return _run_and_judged(loaded, names, Path(folder) / f"{path.stem}.h5", trial)
    except AtomsimError as error:
        return (), str(error)


def _run_and_judged(
    loaded: LoadedScene, names: Sequence[str], file: Path, trial: Trial
) -> tuple[tuple[Judged, ...], str]:
    """Run a scene into a file and judge it there; a run that blows up is judged as far as it went."""
    error = ""
    try:
        run(loaded, file, backend=trial.backend)
    except BlowUpError as blow_up:
        error = str(blow_up).rpartition("\n")[0] or str(blow_up)
    with Trajectory(file) as trajectory:
        found = judged(trajectory, loaded, names)
    if trial.pictures is None:
        return found, error
    return tuple(_with_picture(each, file, trial.pictures) for each in found), error


def _with_picture(found: Judged, file: Path, folder: Path) -> Judged:
    """Draw the round that decides an expectation that is not met."""
    if found.verdict.is_met:
        return found
    folder.mkdir(parents=True, exist_ok=True)
    picture = folder / f"{file.stem}.{found.name}.png"
    render(file, picture, rounds=[found.verdict.round_index])
    return Judged(found.name, found.file, found.line, found.verdict, picture)


def _unit(claim: Expectation) -> str:
    assert claim.measure is not None  # by `judge`
    unit = parse_measure(claim.measure).unit
    return f" {unit}" if unit else ""


def _bound(claim: Expectation) -> str:
    """Write the bound of a claim: `above 3`."""
    (key,) = claim.said(BOUNDS)
    value = getattr(claim, key)
    return f"between {value[0]:g} and {value[1]:g}" if key == "between" else f"{key} {value:g}"
