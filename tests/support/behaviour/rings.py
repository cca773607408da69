"""What `ring` does on `surface` in the three ring scenes, and it under it; knows no expected number."""

from __future__ import annotations

import numpy as np

from atomsim.core.model import Floats
from support.behaviour.runs import Run
from support.behaviour.surfaces import depth_below_rim


def on_ground(run: Run) -> slice:
    """Return the frames until the centre of the ring passes the last column of the surface."""
    is_past = run.centre("ring")[:, 0] > run.path("surface")[0, :, 0].max()
    return slice(0, int(np.argmax(is_past)) if is_past.any() else len(run.round))


def travelled(run: Run) -> float:
    """Return how far the ring has come in +x, downhill, while on the ground."""
    x = run.centre("ring")[on_ground(run), 0]
    return float(x[-1] - x[0])


def turned(run: Run) -> float:
    """Return the angle [radians] through which the ring has turned while on the ground, positive as in rolling to +x.

    From frame to frame it is the angle of the best rotation about z that takes the one shape into the other
    (Kabsch's problem in the plane); a ring that merely flexes or shifts does not turn.
    """
    shape = run.path("ring")[on_ground(run), :, :2] - run.centre("ring")[on_ground(run), None, :2]
    before, after = shape[:-1], shape[1:]
    cross = (before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]).sum(axis=1)
    dot = (before * after).sum(axis=(1, 2))
    return -float(np.arctan2(cross, dot).sum())


def share_of_slide(run: Run) -> float:
    """Return the way of the ring as a share of the way that it would slide in the same time without friction.

    On a slope of angle θ, with impulse g per round, a body slides x = ½ (g/τ) sin θ cos θ · t² along the horizontal.
    """
    surface = run.path("surface")[0]
    slope = np.ptp(surface[:, 1]) / np.ptp(surface[:, 0])
    weight = next(force for force in run.model.forces if force.origin.name == "weight")
    acceleration = -weight.impulse[1] / run.model.time_step * slope / (1 + slope**2)
    time = run.round[on_ground(run)][-1] * run.model.time_step
    return travelled(run) / (0.5 * acceleration * time**2)


def flex(run: Run) -> float:
    """Return the largest ellipticity (a − b) / (a + b) of the ring on the ground; a, b: its semi-axes."""
    shape = run.path("ring")[on_ground(run)] - run.centre("ring")[on_ground(run), None]
    axes = np.linalg.svd(shape, compute_uv=False)
    return float(((axes[:, 0] - axes[:, 1]) / (axes[:, 0] + axes[:, 1])).max())


def flex_bound(run: Run) -> float:
    """Return the ellipticity that the ring would have if all the energy of its descent went into flexing it.

    For small displacements u the bonds store ½ uᵀKu/τ ≥ ½ λ|u|²/τ, λ the smallest stiffness of K in the plane besides
    the three rigid motions, and a bond adds 2 êêᵀ to K. A descent by h frees n·g·h/τ. The squares of the semi-axes
    differ by at most 2R|u|√n · 2/n, which is an ellipticity of |u| / (R√n). Together: √(2gh/λ) / R.
    """
    ring = run.path("ring")[0]
    radius = np.linalg.norm(ring - ring.mean(axis=0), axis=1).max()
    weight = next(force for force in run.model.forces if force.origin.name == "weight")
    height = run.centre("ring")[on_ground(run), 1]
    freed = -weight.impulse[1] * (height[0] - height.min())
    return float(np.sqrt(2 * freed / _stiffness(run)[3]) / radius)


def _stiffness(run: Run) -> Floats:
    """Return the eigenvalues of the linearised stiffness of the ring in its plane, ascending."""
    ring, table = run.path("ring")[0, :, :2], run.bonds("ring")
    matrix = np.zeros((len(ring), 2, len(ring), 2))
    for first, second in zip(table.first, table.second, strict=True):
        along = ring[second] - ring[first]
        block = 2 * np.outer(along, along) / (along @ along)
        matrix[first, :, first] += block
        matrix[second, :, second] += block
        matrix[first, :, second] -= block
        matrix[second, :, first] -= block
    return np.linalg.eigvalsh(matrix.reshape(2 * len(ring), 2 * len(ring)))


def tilt(run: Run) -> Floats:
    """Return the angle of the plane of the ring to the vertical [degrees], (n_frames,): 0 stands, 90 lies."""
    shape = run.path("ring") - run.centre("ring")[:, None]
    normal = np.linalg.svd(shape, full_matrices=False)[2][:, 2]
    return np.degrees(np.arcsin(np.abs(normal[:, 1]).clip(0, 1)))


def cave(run: Run, round_index: int) -> float:
    """Return how far the deepest atom of the surface lies below the plane that fits its four rims best."""
    surface = run.path("surface")
    return float(depth_below_rim(surface[0], surface[run.frame(round_index)], up=1).max())
