"""The Numba stepper: one state of one model, advanced by compiled rounds in one or more threads; knows no files."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import TypeVar

import numpy as np

from atomsim.core.forces import acting, held_atoms
from atomsim.core.free_memory import free_memory
from atomsim.core.model import Floats, Model, State
from atomsim.core.numba_backend.near_kernels import find_near, sort_into_buckets
from atomsim.core.numba_backend.round_kernels import MAKING_COST, advance_rounds
from atomsim.core.pairs.collisions import involved_atoms
from atomsim.core.pairs.near_list import SKIN, better_skin, widest_skin
from atomsim.core.plans.bond_plan import plan_bonds
from atomsim.core.plans.force_plan import Pushes, plan_forces, runs_of
from atomsim.core.plans.near_plan import empty_list, plan_grids, plan_queries
from atomsim.core.plans.records import LANES, Forces, Grids, Motion, Watch

CALL_ATOM_ROUNDS = 1 << 21
"""Atoms times rounds computed in one call of a kernel, which nothing can interrupt: some tenths of a second."""

_NONE = np.empty(0, dtype=np.int64)
_NOTHING = np.empty((3, 0))

Result = TypeVar("Result")


class NumbaStepper:
    """Advances one state of a model to the same bits as `NumpyStepper`.

    The atoms are shared out to threads, which meet after every round. One thread alone runs through many rounds.

    Args:
        model: what stays constant.
        state: where to begin; it is copied.
        threads: how many threads share the atoms.
        skin: how much further than contact the first lists of near pairs look [length]; it then adapts.
    """

    def __init__(self, model: Model, state: State, threads: int = 1, skin: float = SKIN) -> None:
        self._margin = LANES + max((int((table.second - table.first).max()) for table in model.bonds), default=0)
        self._n_atoms = model.n_atoms
        self._time_step = model.time_step
        self._round_index = state.round_index
        self._memory = state.memory
        here = self._padded(state.position)
        self._motion = Motion(here, here.copy(), self._padded(state.velocity), np.zeros_like(here))
        forces = acting(model.forces)
        self._forces = plan_forces(forces, held_atoms(model.forces), self._margin)
        self._pushes = Pushes(forces)
        self._outside = _NOTHING
        widest, n_rounds = widest_skin(model.collisions), np.zeros(1, dtype=np.int64)
        self._watch = Watch(_NONE, _NONE, np.zeros_like(here), np.array([skin]), widest, n_rounds)
        self._is_stale = bool(model.collisions)
        self._grids = plan_grids(model.collisions, self._margin)
        edges = [model.n_atoms * number // threads for number in range(threads + 1)]
        self._shares = [
            _Share(model, range(start, stop), self._margin, self._watch)
            for start, stop in pairwise(edges)
            if start < stop
        ]
        self._pool = ThreadPoolExecutor(len(self._shares) - 1) if len(self._shares) > 1 else None

    def advance(self, n_rounds: int) -> None:
        """Compute so many iteration rounds."""
        stop = self._round_index + n_rounds
        while self._round_index < stop:
            if self._is_stale:
                self._find_near_pairs()
            self._advance_at_most(stop - self._round_index)

    def set_forces(self, impulse: Floats | None) -> None:
        """Add an impulse to each atom in every round to come, (n_atoms, 3); None for nothing. It is copied."""
        self._outside = _NOTHING if impulse is None else self._padded(impulse)

    def state(self) -> State:
        """Return a copy of the present state."""
        atoms = slice(self._margin, self._margin + self._n_atoms)
        position, velocity = (
            np.ascontiguousarray(array[:, atoms].T) for array in (self._motion.here, self._motion.velocity)
        )
        return State(self._round_index, position, velocity, self._memory)

    def _padded(self, vectors: Floats) -> Floats:
        """Return (n_atoms, 3) as (3, n_slots)."""
        rows = np.zeros((3, self._n_atoms + 2 * self._margin))
        rows[:, self._margin : self._margin + self._n_atoms] = vectors.T
        return rows

    def _find_near_pairs(self) -> None:
        """Make all lists of near pairs anew, looking as far as the last ones make seem best."""
        skin, n_rounds = self._watch.skin, self._watch.n_rounds
        if n_rounds[0]:
            n_near = sum(share.n_near for share in self._shares)
            making = MAKING_COST * sum(share.search_cost for share in self._shares)
            skin[0] = better_skin(skin[0], self._watch.widest_skin, n_rounds[0], making, n_near)
            n_rounds[0] = 0
        position, cutoff = self._motion.here, 2.0 + float(skin[0])
        np.copyto(self._watch.made_at, position)
        sort_into_buckets(position, cutoff, self._grids)
        self._for_each_share(lambda share: share.find_near_pairs(position, cutoff, self._grids))

    def _advance_at_most(self, n_rounds: int) -> None:
        """Advance by some rounds; several threads meet after each of them."""
        is_alone = self._pool is None
        n_rounds = min(n_rounds, max(1, CALL_ATOM_ROUNDS // self._n_atoms)) if is_alone else 1
        pushes = self._pushes.ahead(self._round_index, n_rounds)
        done = self._for_each_share(
            lambda share: share.advance(
                self._time_step, self._motion, self._forces, pushes, self._outside, self._grids, is_alone
            )
        )
        self._is_stale = any(is_stale for _, is_stale in done)
        n_done = done[0][0]
        if n_done % 2:
            self._motion = self._motion._replace(here=self._motion.there, there=self._motion.here)
        if not is_alone:
            self._watch.n_rounds[0] += n_done
        self._round_index += n_done

    def _for_each_share(self, work: Callable[[_Share], Result]) -> list[Result]:
        """Do the same for every share, each in its thread, the first one in this."""
        first, *others = self._shares
        if self._pool is None:
            return [work(first)]
        futures = [self._pool.submit(work, share) for share in others]
        return [work(first), *(future.result() for future in futures)]


class _Share:
    """The atoms that one thread computes: whatever is written for them is written by it alone."""

    def __init__(self, model: Model, atoms: range, margin: int, watch: Watch) -> None:
        held = held_atoms(model.forces)
        self._start, self._stop = atoms.start + margin, atoms.stop + margin
        self._bonds = plan_bonds(model.bonds, atoms, held, margin)
        self._queries = plan_queries(model.collisions, atoms, held, margin)
        self._near = empty_list(self._queries, 16 * self._queries.slot.size)
        involved = involved_atoms(model.collisions, model.n_atoms)
        involved = involved[(involved >= atoms.start) & (involved < atoms.stop)]
        run_start, run_stop = runs_of(involved, margin)
        self._watch = watch._replace(run_start=run_start, run_stop=run_stop)
        self._workspace = np.zeros((2, 3, LANES))

    @property
    def search_cost(self) -> float:
        """What making the list takes, as a number of atoms that look into buckets."""
        return float(self._queries.cost[0])

    @property
    def n_near(self) -> int:
        """How many near partners its atoms have."""
        return int(self._near.row_first_entry[self._near.table_first_row[-1]])

    def find_near_pairs(self, position: Floats, cutoff: float, grids: Grids) -> None:
        """Make the list of near pairs anew, with more room if it needs more.

        Raises:
            MemoryError: so many pairs are near that they would not fit.
        """
        while not find_near(position, cutoff, self._queries, grids, self._near):
            n_entries = 2 * self._near.entry_partner.size
            if n_entries * self._near.entry_partner.itemsize > free_memory():
                raise MemoryError(f"more than {n_entries // 4:,} pairs are near each other, too many for memory")
            self._near = empty_list(self._queries, n_entries)

    def advance(
        self,
        time_step: float,
        motion: Motion,
        forces: Forces,
        pushes: Floats,
        outside: Floats,
        grids: Grids,
        is_alone: bool,
    ) -> tuple[int, bool]:
        """Advance by one or more rounds; see `advance_rounds`."""
        return advance_rounds(
            self._start,
            self._stop,
            time_step,
            motion,
            self._bonds,
            forces,
            pushes,
            outside,
            self._near,
            self._watch,
            self._queries,
            grids,
            is_alone,
            self._workspace,
        )
