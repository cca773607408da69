"""`atomsim test`: run scenes and say which of their expectations are not met."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atomsim.cli.options import Backend, file_name, output, whole_number
from atomsim.cli.scenes import STANDARD_INPUT
from atomsim.cli.terminal.output import say, tell
from atomsim.cli.voice import explained
from atomsim.errors import InputError

if TYPE_CHECKING:
    from atomsim.tasks.expect import Tried

PICTURES = Path("failures")


@explained(
    """
    Run scenes and say which of their expectations are not met, by how much, and in which round.

    A folder stands for all scenes in it. Exit code 1 if anything that is expected does not happen.

    Example:

    atomsim test scenes/ -j 2
    """
)
def try_out(
    scenes: Annotated[list[Path], typer.Argument(metavar="SCENE", help="Scenes, YAML files, or folders of them.")],
    word: Annotated[
        str, typer.Option("-k", metavar="WORD", help="Only expectations with this in their `scene.name`.")
    ] = "",
    n_processes: Annotated[
        int, typer.Option("-j", metavar="N", parser=whole_number("-j", 1), help="How many scenes run at a time.")
    ] = 1,
    pictures: Annotated[
        Path,
        typer.Option(
            metavar="FOLDER",
            parser=file_name("--pictures"),
            help="Where pictures of the failing rounds go; made when needed.",
        ),
    ] = PICTURES,
    junit: Annotated[Path | None, output("XML", "Write the results as JUnit XML, for continuous integration.")] = None,
    backend: Backend = "auto",
) -> None:
    from atomsim.cli.terminal.progress import Progress
    from atomsim.tasks.expect import Trial, scenes_in, try_scenes
    from atomsim.tasks.junit import check_junit, write_junit

    if junit is not None:
        check_junit(junit)
    if STANDARD_INPUT in scenes:
        raise InputError("expectations are named after the file of their scene, and standard input has no name")
    files = scenes_in(scenes)
    tried: list[Tried] = []
    with Progress("scene") as progress:
        progress.report(0, len(files))
        for each in try_scenes(files, Trial(word, backend, pictures), n_processes):
            progress.clear()
            _tell(each)
            tried.append(each)
            progress.report(len(tried), len(files))
    if junit is not None:
        write_junit(tried, junit)
    _sum_up(tried)
    if not all(each.is_good for each in tried):
        raise typer.Exit(1)


def _tell(tried: Tried) -> None:
    """Say what became of a scene: in one line if all is well, else with every expectation that is not met."""
    n_met = len(tried.judged) - len(tried.failed)
    verdict = f"{n_met} met, {len(tried.failed)} not" if tried.judged else "nothing expected"
    say(f"{tried.scene}: {'error' if tried.error else verdict} ({tried.seconds:.1f} s)")
    if tried.error:
        say("".join(f"  {line}\n" for line in tried.error.splitlines()).rstrip())
    for each in tried.failed:
        say(f"  {each.file}:{each.line}: {each}")
        if each.picture is not None:
            say(f"    {each.picture}")


def _sum_up(tried: list[Tried]) -> None:
    """Say how many scenes and expectations there were."""
    n_expected, n_failed = sum(len(each.judged) for each in tried), sum(len(each.failed) for each in tried)
    n_broken = sum(bool(each.error) for each in tried)
    broken = f"; {_counted(n_broken, 'scene')} did not run to the end" if n_broken else ""
    counts = f"{_counted(len(tried), 'scene')}, {_counted(n_expected, 'expectation')}"
    say(f"{counts}: {n_expected - n_failed} met, {n_failed} not{broken}")
    if not n_expected and not n_broken:
        tell("nothing that was asked about is expected of these scenes")


def _counted(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
