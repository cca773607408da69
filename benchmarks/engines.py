"""Everything that can compute rounds here, each loaded only if it is installed; knows no scene and no clock."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec

from atomsim.core.backend import MakeStepper


@dataclass(frozen=True, slots=True)
class Engine:
    """What computes rounds: its name in tables, the package it needs, where its stepper is."""

    name: str
    package: str
    module: str
    stepper: str

    def load(self) -> MakeStepper | None:
        """Return what makes its stepper, or None if its package is not installed."""
        if find_spec(self.package) is None:
            return None
        make: MakeStepper = getattr(import_module(self.module), self.stepper)
        return make


NUMBA = Engine("atomsim, Numba", "numba", "atomsim.core.numba_backend.stepper", "NumbaStepper")
NUMPY = Engine("atomsim, NumPy", "numpy", "atomsim.core.numpy_backend.stepper", "NumpyStepper")
PLAIN = Engine("plain NumPy loop", "numpy", "benchmarks.plain", "PlainStepper")
PEERS = (
    Engine("Warp, CPU", "warp", "benchmarks.peers.warp", "WarpStepper"),
    Engine("JAX jit, CPU", "jax", "benchmarks.peers.jax", "JaxStepper"),
    Engine("OpenMM Reference", "openmm", "benchmarks.peers.openmm", "OpenMMStepper"),
)
ENGINES = (NUMBA, NUMPY, PLAIN, *PEERS)
