"""Iteration rounds of a share of atoms, compiled (paper section 2.2); knows no threads."""

from __future__ import annotations

from atomsim.core.model import Floats
from atomsim.core.numba_backend.bond_kernels import add_rows, add_tiles
from atomsim.core.numba_backend.force_kernels import add_forces
from atomsim.core.numba_backend.jit import inner, kernel
from atomsim.core.numba_backend.near_kernels import find_near, sort_into_buckets
from atomsim.core.pairs import near_list
from atomsim.core.pairs.collisions import CONTACT_SQUARED
from atomsim.core.plans.records import Bonds, Forces, Grids, Motion, NearPairs, Queries, Watch

MAKING_COST = 100
"""Finding the partners of one atom takes a kernel about as long as one round of so many partners."""

better_skin, squared_reach = inner(near_list.better_skin), inner(near_list.squared_reach)


@kernel
def advance_rounds(
    start: int,
    stop: int,
    time_step: float,
    motion: Motion,
    bonds: Bonds,
    forces: Forces,
    pushes: Floats,
    outside: Floats,
    near: NearPairs,
    watch: Watch,
    queries: Queries,
    grids: Grids,
    is_alone: bool,
    workspace: Floats,
) -> tuple[int, bool]:
    """Advance the slots start ≤ slot < stop by as many rounds as `pushes` has, or until the near pairs are stale.

    A share that is alone renews its list of near pairs itself, as long as the list has room.

    j(n) = Σ forces;  v(n+1) = v(n) + j(n);  c(n+1) = c(n) + τ · v(n+1).

    Args:
        start: first slot of the share.
        stop: one past its last slot.
        time_step: τ [time].
        motion: the state of all atoms.
        bonds: the bonds of the share.
        forces: forces from outside.
        pushes: what they add uniformly, per round ahead, (n_rounds, n_forces, 3).
        outside: what is added to each atom besides, (3, n_slots), or (3, 0) for nothing.
        near: the near collision pairs of the share.
        watch: when and where they were found.
        queries: how to find them.
        grids: where to find them.
        is_alone: whether the share is all atoms.
        workspace: scratch, (2, 3, LANES).

    Returns:
        The number of rounds done, and whether the near pairs are stale. `motion.here` and `motion.there` change places
        in every round, so after an odd number of rounds the new positions are in `there`.
    """
    here, there, velocity, impulse = motion
    for number in range(pushes.shape[0]):
        for component in range(3):
            impulse[component, start:stop] = 0.0
        for table in range(bonds.table_first_tile.size - 1):
            add_tiles(table, bonds, here, impulse, workspace, stop)
            add_rows(table, bonds, here, impulse)
        for table in range(near.table_first_row.size - 1):
            _add_collisions(table, near, here, impulse)
        add_forces(forces, pushes[number], outside, here, velocity, impulse, start, stop)
        for component in range(3):
            _move(
                time_step,
                here[component, start:stop],
                there[component, start:stop],
                velocity[component, start:stop],
                impulse[component, start:stop],
            )
        here, there = there, here
        if is_alone:
            watch.n_rounds[0] += 1
        if _is_stale(watch, here) and not (is_alone and _renew(here, watch, queries, grids, near)):
            return number + 1, True
    return pushes.shape[0], False


@inner
def _add_collisions(table: int, near: NearPairs, position: Floats, impulse: Floats) -> None:
    """Add the subtotals of fc = (c_k − c_i) · min(0, 1 − 4/d²) (paper section 2.3) over a table's near pairs."""
    x, y, z = position[0], position[1], position[2]
    for row in range(near.table_first_row[table], near.table_first_row[table + 1]):
        atom = near.row_slot[row]
        total_x, total_y, total_z = 0.0, 0.0, 0.0
        for entry in range(near.row_first_entry[row], near.row_first_entry[row + 1]):
            partner = near.entry_partner[entry]
            dx, dy, dz = x[partner] - x[atom], y[partner] - y[atom], z[partner] - z[atom]
            weight = 1.0 - CONTACT_SQUARED * (1.0 / ((dx * dx + dy * dy) + dz * dz))
            if weight > 0.0:  # false for NaN, which stays
                weight = 0.0
            total_x += weight * dx
            total_y += weight * dy
            total_z += weight * dz
        impulse[0, atom] += total_x
        impulse[1, atom] += total_y
        impulse[2, atom] += total_z


@inner
def _move(time_step: float, here: Floats, there: Floats, velocity: Floats, impulse: Floats) -> None:
    """Integrate one component."""
    for number in range(here.size):
        velocity[number] += impulse[number]
        there[number] = here[number] + time_step * velocity[number]


@inner
def _is_stale(watch: Watch, position: Floats) -> bool:
    """Return whether any atom has moved as far as the lists of near pairs allow, or has no place any more."""
    limit, n_far = squared_reach(watch.skin[0]), 0
    for run in range(watch.run_start.size):
        start, stop = watch.run_start[run], watch.run_stop[run]
        x, y, z = position[0, start:stop], position[1, start:stop], position[2, start:stop]
        old_x = watch.made_at[0, start:stop]
        old_y = watch.made_at[1, start:stop]
        old_z = watch.made_at[2, start:stop]
        for number in range(stop - start):
            dx, dy, dz = x[number] - old_x[number], y[number] - old_y[number], z[number] - old_z[number]
            n_far += not (dx * dx + dy * dy) + dz * dz < limit
    return n_far > 0


@inner
def _renew(position: Floats, watch: Watch, queries: Queries, grids: Grids, near: NearPairs) -> bool:
    """Make the list of near pairs of all atoms anew; return whether it had room for them."""
    n_near = near.row_first_entry[near.table_first_row[-1]]
    making = MAKING_COST * queries.cost[0]
    watch.skin[0] = better_skin(watch.skin[0], watch.widest_skin, watch.n_rounds[0], making, n_near)
    watch.n_rounds[0] = 0
    for component in range(3):
        for slot in range(position.shape[1]):
            watch.made_at[component, slot] = position[component, slot]
    cutoff = 2.0 + watch.skin[0]
    sort_into_buckets(position, cutoff, grids)
    return find_near(position, cutoff, queries, grids, near)
