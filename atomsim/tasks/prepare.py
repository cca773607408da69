"""A scene made ready to be simulated: compiled, its rounds settled."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from atomsim.compiler import compile_scene
from atomsim.core.backend import Backend, choose
from atomsim.core.model import Frame, Model, State
from atomsim.core.simulate import simulate
from atomsim.scene import LoadedScene
from atomsim.tasks.recompute import compile_inside
from atomsim.trajectory import Header


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """What it takes to simulate a scene.

    Attributes:
        loaded: the scene and where it came from.
        model: the compiled scene.
        first: where the scene begins.
        rounds: the round to run to.
        record_every: rounds between two frames.
    """

    loaded: LoadedScene
    model: Model
    first: State
    rounds: int
    record_every: int

    def choose(self, backend: str, threads: int | None) -> Backend:
        """Choose what computes it; last of all, since starting Numba takes a while.

        Args:
            backend: `auto`, `numpy` or `numba`; whichever it is, the frames have the same bits.
            threads: how many threads to use; None for as many as are worth it.

        Raises:
            InputError: an unknown backend, or an impossible number of threads.
        """
        return choose(backend, threads, self.model, self.rounds)

    def frames(
        self, backend: Backend, state: State | None = None, report: Callable[[int], object] | None = None
    ) -> Iterator[Frame]:
        """Yield the frames to the last round, from the beginning of the scene or from a later state; see `simulate`."""
        begin, maker = state or self.first, backend.make_stepper
        return simulate(self.model, begin, self.rounds, self.record_every, maker, report=report, first=self.first)


def prepare(loaded: LoadedScene, rounds: int | None = None) -> Prepared:
    """Make a scene ready.

    Args:
        loaded: the scene, as `load` returns it.
        rounds: the round to run to; as the scene says by default.

    Raises:
        SceneError: the scene does not compile.
    """
    model, first = compile_scene(loaded)
    scene = loaded.scene
    return Prepared(loaded, model, first, scene.rounds if rounds is None else rounds, scene.record_every)


def prepare_inside(header: Header, path: Path, rounds: int) -> Prepared:
    """Make the scene inside a trajectory ready to be computed again, or further.

    Args:
        header: what the trajectory says besides its frames.
        path: the trajectory, for messages.
        rounds: the round to run to.

    Raises:
        InputError: it is no valid scene, or not that of the frames.
    """
    loaded, model, first = compile_inside(header, path)
    return Prepared(loaded, model, first, rounds, header.record_every)
