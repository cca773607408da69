"""The rounds in OpenMM, on its Reference platform, the one in float64; knows no other engine.

The laws are custom forces, given as energies: −∇U is the impulse per round. Bonds and collisions are both bonds to
OpenMM, which was two to ten times faster than nonbonded forces with interaction groups.
"""

from __future__ import annotations

import numpy as np
import openmm

from atomsim.core.model import Model, State
from benchmarks.pairs import PairTable, pair_table

BOND = "0.5*(r^2 - r2 - r2*log(r^2/r2))"
"""U = ½(d² − r² − 2 r² ln(d/r)), so that −dU/dd = −d · (1 − r²/d²) (paper section 2.3)."""

COLLISION = f"step(2 - r)*({BOND})"
"""The same with r = 2, and nothing beyond: there U and its derivative are zero."""


class OpenMMStepper:
    """Advances one state of a model."""

    def __init__(self, model: Model, state: State) -> None:
        integrator = openmm.CustomIntegrator(model.time_step)
        integrator.addComputePerDof("v", "v + f")  # the mass is one
        integrator.addComputePerDof("x", "x + dt*v")
        self._integrator = integrator
        self._context = openmm.Context(
            _system(pair_table(model)), integrator, openmm.Platform.getPlatformByName("Reference")
        )
        self._context.setPositions(state.position)
        self._context.setVelocities(state.velocity)
        self._round_index = state.round_index

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        self._integrator.step(n_rounds)
        self._round_index += n_rounds

    def state(self) -> State:
        """Return a copy of the present state."""
        state = self._context.getState(positions=True, velocities=True)
        position, velocity = state.getPositions(asNumpy=True), state.getVelocities(asNumpy=True)
        return State(self._round_index, np.array(position._value), np.array(velocity._value))


def _system(pairs: PairTable) -> openmm.System:
    system = openmm.System()
    for _ in range(pairs.n_atoms):
        system.addParticle(1.0)
    is_bond = pairs.ceiling > 0.0
    for energy, chosen in ((BOND, is_bond), (COLLISION, ~is_bond)):
        force = openmm.CustomBondForce(energy)
        force.addPerBondParameter("r2")
        for pair in np.flatnonzero(chosen).tolist():
            force.addBond(int(pairs.first[pair]), int(pairs.second[pair]), [float(pairs.rest_squared[pair])])
        system.addForce(force)
    if pairs.push.any():
        system.addForce(_pushes(pairs))
    return system


def _pushes(pairs: PairTable) -> openmm.CustomExternalForce:
    force = openmm.CustomExternalForce("-(px*x + py*y + pz*z)")
    for component in "xyz":
        force.addPerParticleParameter(f"p{component}")
    for atom in np.flatnonzero(pairs.push.any(axis=1)).tolist():
        force.addParticle(atom, pairs.push[atom].tolist())
    return force
