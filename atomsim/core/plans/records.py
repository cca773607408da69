"""The arrays that kernels read and write, as plain records; knows no algorithm.

Atoms are addressed by *slot*: slot = margin + atom. The margin lets a tile of consecutive slots, shifted by the offset
of a bond, reach over either end of the atoms without leaving the arrays. Positions, velocities and impulses are
(3, n_slots), one row per component. An array `x_first` of n + 1 entries says that the y of x number m are
x_first[m] … x_first[m + 1] − 1.
"""

from __future__ import annotations

from typing import NamedTuple

from atomsim.core.model import Floats, Indices

LANES = 72
"""Atoms in a tile; a compile-time constant, which lets the compiler lay the whole tile out in vector registers."""

UNBOUND = -1.0
"""Stands for the squared desired distance where a tile has no bond."""


class Motion(NamedTuple):
    """The state of all atoms at one round: every thread reads all of `here` and writes its own atoms of the others.

    Attributes:
        here: positions [length].
        there: receives the next positions.
        velocity: v [length per unit of time].
        impulse: receives j.
    """

    here: Floats
    there: Floats
    velocity: Floats
    impulse: Floats


class Bonds(NamedTuple):
    """The bonds of all tables, from the side of the atoms of one share.

    A tile is LANES consecutive slots. Each of its passes adds one partner to every lane: in an ordinary tile the same
    atom to all of them, in a banded tile the atom at the same offset from each. Atoms for which this would mostly
    compute nothing have rows of entries instead, one entry per partner.

    Attributes:
        table_first_tile: (n_tables + 1,).
        tile_slot: first slot of each tile.
        tile_is_banded: whether passes name offsets.
        tile_first_pass: (n_tiles + 1,).
        pass_partner: the partner's slot, or its offset; increasing within a tile.
        pass_rest_squared: r² per lane or UNBOUND [length²], (n_passes, LANES).
        table_first_row: (n_tables + 1,).
        row_slot: the atom of each row.
        row_first_entry: (n_rows + 1,).
        entry_partner: the partner's slot; increasing within a row.
        entry_rest_squared: r² [length²].
    """

    table_first_tile: Indices
    tile_slot: Indices
    tile_is_banded: Indices
    tile_first_pass: Indices
    pass_partner: Indices
    pass_rest_squared: Floats
    table_first_row: Indices
    row_slot: Indices
    row_first_entry: Indices
    entry_partner: Indices
    entry_rest_squared: Floats


class Queries(NamedTuple):
    """Which atoms of one share look for collision partners, and where; an atom's queries of a table follow one another.

    Attributes:
        table_first_query: (n_tables + 1,).
        slot: the atom that asks; increasing within a table.
        grid: the grid of the atoms it may collide with.
        tag: see `Grids.target_tag`.
        cost: what all of them take, as a number of queries that look into buckets, (1,).
    """

    table_first_query: Indices
    slot: Indices
    grid: Indices
    tag: Indices
    cost: Floats


class Bound(NamedTuple):
    """Which atoms are too few bonds apart to collide, by sets of twins; see `BoundPairs`.

    Attributes:
        table_row: which row of `twins` a collision table goes by, or −1 where bonds make no difference, (n_tables,).
        twins: the set of each slot's atom, (n_rows, n_slots).
        first_near: (n_sets + 1,); sets are numbered through all rows.
        near: the sets near each set, ascending.
    """

    table_row: Indices
    twins: Indices
    first_near: Indices
    near: Indices


class Grids(NamedTuple):
    """Sets of atoms that are looked for by place: each is sorted into buckets by the cell of space an atom is in.

    Attributes:
        first_target: (n_grids + 1,).
        target_slot: the atoms of each grid.
        target_tag: a query finds a target only if their tags differ by `gap` at least: the place inside the set
            for collisions within it, else the atom's number, so that no atom finds itself.
        gap: (n_grids,).
        mask: number of buckets − 1, a power of two less one; 0 where looking at all targets is cheaper, (n_grids,).
        first_bucket: (n_grids + 1,); a grid of B buckets has B + 1 entries in `bucket_first_item`.
        target_bucket: the bucket of each target; made by `sort_into_buckets`, as all that follow.
        bucket_first_item: see `first_bucket`.
        item_slot: the targets of each grid in order of buckets.
        item_tag: their tags.
        item_position: their positions [length], (3, n_targets).
        bound: which of the pairs that are found do not collide.
    """

    first_target: Indices
    target_slot: Indices
    target_tag: Indices
    gap: Indices
    mask: Indices
    first_bucket: Indices
    target_bucket: Indices
    bucket_first_item: Indices
    item_slot: Indices
    item_tag: Indices
    item_position: Floats
    bound: Bound


class NearPairs(NamedTuple):
    """The partners near each atom of one share: rows as in `Bonds`, with room to spare at the end.

    Attributes:
        table_first_row: (n_tables + 1,).
        row_slot: the atom of each row; only atoms that have a partner have one.
        row_first_entry: one more than rows.
        entry_partner: the partner's slot; increasing within a row.
    """

    table_first_row: Indices
    row_slot: Indices
    row_first_entry: Indices
    entry_partner: Indices


class Forces(NamedTuple):
    """Forces from outside in the order they are applied in.

    Attributes:
        kind: which law, one of the constants of `force_plan.py`, (n_forces,).
        number: its constants, (n_forces, 4); see the laws.
        first_run: (n_forces + 1,).
        run_start: runs of consecutive slots that are acted on; increasing within a force.
        run_stop: one past the end of each run.
        first_about_run: (n_forces + 1,).
        about_start: runs of the atoms whose centroid is the centre.
        about_stop: one past the end of each run.
        n_about: how many these atoms are, (n_forces,).
        rest_squared: r² per atom acted on, for tethers [length²].
        target: the fixed point of each of these atoms [length], (3, n).
        first_rest: where in both each run begins.
        held_start: runs of the slots that are held after all forces.
        held_stop: one past the end of each run.
    """

    kind: Indices
    number: Floats
    first_run: Indices
    run_start: Indices
    run_stop: Indices
    first_about_run: Indices
    about_start: Indices
    about_stop: Indices
    n_about: Floats
    rest_squared: Floats
    target: Floats
    first_rest: Indices
    held_start: Indices
    held_stop: Indices


class Watch(NamedTuple):
    """Tells when the lists of near pairs end to be valid.

    Attributes:
        run_start: runs of consecutive slots of one share that may collide at all.
        run_stop: one past the end of each run.
        made_at: positions when the lists were made [length], (3, n_slots).
        skin: how much further than contact they look [length], (1,).
        widest_skin: how much further they may look [length].
        n_rounds: rounds since then, (1,).
    """

    run_start: Indices
    run_stop: Indices
    made_at: Floats
    skin: Floats
    widest_skin: float
    n_rounds: Indices
