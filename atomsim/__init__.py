"""atomsim: previsualization in robotics with unit balls that are bound and collide.

In a notebook:

    loaded = atomsim.load("scenes/rods.yaml")            # a scene and where it came from
    model, state = atomsim.compile(loaded)               # flat force tables and the first state
    for frame in atomsim.simulate(model, state, 1000):   # frame by frame
        ...
    simulation = atomsim.Simulation(loaded)              # or step by step
    simulation.step(10)
    atomsim.run(loaded, "out.h5")                        # or record a whole run
    with atomsim.Trajectory("out.h5") as trajectory:     # a sequence of frames
        trajectory[-1].position
    atomsim.measure("out.h5", "height of left")          # numbers over its frames
    atomsim.events("out.h5")                             # what happened
    atomsim.render("out.h5", "out.png")                  # the strip

Names are loaded when they are first used, so that `import atomsim` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from atomsim.version import __version__ as __version__

if TYPE_CHECKING:
    from atomsim.core.model import Frame, Model, State
    from atomsim.core.simulate import simulate
    from atomsim.errors import AtomsimError, BlowUpError, InputError, RunError, SceneError
    from atomsim.scene.loader import LoadedScene, load, loads
    from atomsim.tasks.measure import events, measure
    from atomsim.tasks.plot import plot
    from atomsim.tasks.render import render, render_frames
    from atomsim.tasks.run import resume, run
    from atomsim.tasks.simulation import SceneSimulation as Simulation
    from atomsim.trajectory import Trajectory

_HOMES = {
    "AtomsimError": "atomsim.errors",
    "BlowUpError": "atomsim.errors",
    "Frame": "atomsim.core.model",
    "InputError": "atomsim.errors",
    "LoadedScene": "atomsim.scene.loader",
    "Model": "atomsim.core.model",
    "RunError": "atomsim.errors",
    "SceneError": "atomsim.errors",
    "Simulation": "atomsim.tasks.simulation:SceneSimulation",
    "State": "atomsim.core.model",
    "Trajectory": "atomsim.trajectory",
    "events": "atomsim.tasks.measure",
    "load": "atomsim.scene.loader",
    "loads": "atomsim.scene.loader",
    "measure": "atomsim.tasks.measure",
    "plot": "atomsim.tasks.plot",
    "render": "atomsim.tasks.render",
    "render_frames": "atomsim.tasks.render",
    "resume": "atomsim.tasks.run",
    "run": "atomsim.tasks.run",
    "simulate": "atomsim.core.simulate",
}

__all__ = [
    "AtomsimError",
    "BlowUpError",
    "Frame",
    "InputError",
    "LoadedScene",
    "Model",
    "RunError",
    "SceneError",
    "Simulation",
    "State",
    "Trajectory",
    "compile",
    "events",
    "load",
    "loads",
    "measure",
    "plot",
    "render",
    "render_frames",
    "resume",
    "run",
    "simulate",
]


def compile(loaded: LoadedScene) -> tuple[Model, State]:
    """Compile a loaded scene to flat force tables and its first state; see `atomsim.compiler.compile_scene`."""
    from atomsim import arguments
    from atomsim.compiler import compile_scene
    from atomsim.scene.loader import LoadedScene

    arguments.instance("loaded", loaded, LoadedScene, arguments.LOADED_SCENE)
    return compile_scene(loaded)


def __dir__() -> list[str]:
    """List what is public, whether or not it has been used yet: notebooks complete these names."""
    return [*__all__, "__version__"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'atomsim' has no attribute '{name}'")
    module, _, its_name = _HOMES[name].partition(":")
    return getattr(import_module(module), its_name or name)
