"""The rounds in JAX, compiled for the CPU in float64; knows no other engine.

Scattering is slow there, so every atom sums over its partners: over all atoms where most are, else over a row of them.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from atomsim.core.model import Model, State
from benchmarks.pairs import PairTable, pair_table

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_platforms", "cpu")


FULL = 0.5
"""From this share of all pairs on, computing all of them is faster than fetching partners one by one."""


class Rows(NamedTuple):
    """Atoms with about as many partners each; a row that is short is filled with pairs of weight min(0, 1).

    `atom` is (n_rows,), the others (n_rows, longest).
    """

    atom: jax.Array
    partner: jax.Array
    rest_squared: jax.Array
    ceiling: jax.Array


class Square(NamedTuple):
    """All atoms with all others as partners, first bonds, then collisions; a pair that is none has weight min(0, 1).

    Both are (2, n_atoms, n_atoms).
    """

    rest_squared: jax.Array
    ceiling: jax.Array


Part = Rows | Square


class JaxStepper:
    """Advances one state of a model."""

    def __init__(self, model: Model, state: State) -> None:
        pairs = pair_table(model)
        self._parts: list[Part] = [_square(pairs)] if _is_full(pairs) else _rows(pairs)
        self._push = jnp.asarray(pairs.push.T)
        self._time_step = model.time_step
        self._position = jnp.asarray(state.position.T)
        self._velocity = jnp.asarray(state.velocity.T)
        self._round_index = state.round_index

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        self._position, self._velocity = _advance(
            n_rounds, self._position, self._velocity, self._parts, self._push, self._time_step
        )
        self._position.block_until_ready()
        self._round_index += n_rounds

    def state(self) -> State:
        """Return a copy of the present state."""
        return State(self._round_index, np.array(self._position.T), np.array(self._velocity.T))


@jax.jit
def _advance(
    n_rounds: int, position: jax.Array, velocity: jax.Array, parts: list[Part], push: jax.Array, time_step: float
) -> tuple[jax.Array, jax.Array]:
    """Advance (3, n_atoms) position and velocity in one compiled loop."""

    def advance_one_round(_: int, moving: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        position, velocity = moving
        impulse = push
        for part in parts:
            if isinstance(part, Square):
                impulse = impulse + _square_subtotal(position, part)
            else:
                impulse = impulse.at[:, part.atom].add(_row_subtotal(position, part), unique_indices=True)
        velocity = velocity + impulse
        return position + time_step * velocity, velocity

    return jax.lax.fori_loop(0, n_rounds, advance_one_round, (position, velocity))


def _row_subtotal(position: jax.Array, rows: Rows) -> jax.Array:
    """Return the impulse of each row's atom, (3, n_rows)."""
    difference = [each[rows.partner] - each[rows.atom, None] for each in position]
    return _total(difference, jnp.minimum(1.0 - rows.rest_squared / _squared(difference), rows.ceiling))


def _square_subtotal(position: jax.Array, square: Square) -> jax.Array:
    """Return the impulse of each atom, (3, n_atoms)."""
    difference = [each[None, :] - each[:, None] for each in position]
    distance_squared = _squared(difference) + jnp.eye(position.shape[1])  # no atom is its own partner
    bond, collision = jnp.minimum(1.0 - square.rest_squared / distance_squared, square.ceiling)
    return _total(difference, bond + collision)


def _squared(difference: list[jax.Array]) -> jax.Array:
    """Return d²; component by component is ten times faster than a sum over an axis."""
    dx, dy, dz = difference
    return dx * dx + dy * dy + dz * dz


def _total(difference: list[jax.Array], weight: jax.Array) -> jax.Array:
    """Sum over partners."""
    return jnp.stack([(weight * each).sum(axis=1) for each in difference])


def _is_full(pairs: PairTable) -> bool:
    return pairs.first.size > FULL * pairs.n_atoms * (pairs.n_atoms - 1) / 2


def _square(pairs: PairTable) -> Square:
    """Lay the pairs out; no two bonds may be of the same atoms, and no two collisions."""
    layer = np.where(pairs.ceiling > 0.0, 0, 1)
    rest_squared, ceiling = np.zeros((2, 2, pairs.n_atoms, pairs.n_atoms))
    for atom, partner in ((pairs.first, pairs.second), (pairs.second, pairs.first)):
        rest_squared[layer, atom, partner] = pairs.rest_squared
        ceiling[layer, atom, partner] = pairs.ceiling
    return Square(jnp.asarray(rest_squared), jnp.asarray(ceiling))


def _rows(pairs: PairTable) -> list[Part]:
    """Sort atoms by how many partners they have, to the next power of two, so that little is computed in vain."""
    atom, partner, rest_squared, ceiling = pairs.seen_from_every_atom()
    count = np.bincount(atom, minlength=pairs.n_atoms)
    first_entry = np.cumsum(count) - count
    size = np.ceil(np.log2(np.maximum(count, 1)))
    parts: list[Part] = []
    for each in np.unique(size[count > 0]):
        chosen = np.flatnonzero((size == each) & (count > 0))
        place = np.arange(count[chosen].max())
        is_pair = place < count[chosen, None]
        entry = np.where(is_pair, first_entry[chosen, None] + place, first_entry[chosen, None])
        rows = partner[entry], np.where(is_pair, rest_squared[entry], 0.0), np.where(is_pair, ceiling[entry], 0.0)
        parts.append(Rows(jnp.asarray(chosen), *map(jnp.asarray, rows)))
    return parts
