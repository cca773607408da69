"""The backends there are, a row each: where its stepper is, what it needs, what it costs; imports none of them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Cost:
    """About how long a backend takes, in seconds.

    Attributes:
        load: to start, with what it keeps from one process to the next.
        compile: to start without that.
        round: for a round at all.
        bond: for a bond in a round.
        colliding_atom: for an atom that may collide, in a round.
        crowded_atom: for each of these from `CROWD` on, when the cache does not hold them.
    """

    load: float
    compile: float
    round: float
    bond: float
    colliding_atom: float
    crowded_atom: float

    def of(self, n_rounds: int, n_bonds: int, n_colliding: int, *, is_kept: bool = True) -> float:
        """Return what a run takes [s].

        >>> round(BACKENDS[0].cost.of(4000, 4830, 140), 2)
        0.31
        """
        atom = self.colliding_atom if n_colliding < CROWD else self.crowded_atom
        start = self.load if is_kept else self.compile
        return start + n_rounds * (self.round + self.bond * n_bonds + atom * n_colliding)


CROWD = 20_000
"""From so many atoms on that may collide, each takes longer."""


@dataclass(frozen=True, slots=True)
class BackendKind:
    """A backend: one row of the table.

    Attributes:
        name: as users choose it.
        title: as its makers write it.
        stepper: module and class of its stepper.
        cost: how long it takes.
        package: what has to be importable for it, if anything.
        extra: the extra of atomsim that brings that.
        keeper: the module that knows of compiled kernels which are kept (`has_kernels`, `clear`), if there are any.
        has_threads: whether its stepper takes `threads`.
    """

    name: str
    title: str
    stepper: tuple[str, str]
    cost: Cost
    package: str | None = None
    extra: str | None = None
    keeper: str | None = None
    has_threads: bool = False


BACKENDS = (
    BackendKind(
        name="numpy",
        title="NumPy",
        stepper=("atomsim.core.numpy_backend.stepper", "NumpyStepper"),
        cost=Cost(load=0.0, compile=0.0, round=3e-5, bond=7e-9, colliding_atom=1e-7, crowded_atom=3e-7),
    ),
    BackendKind(
        name="numba",
        title="Numba",
        stepper=("atomsim.core.numba_backend.stepper", "NumbaStepper"),
        cost=Cost(load=0.8, compile=12.0, round=6e-6, bond=1.4e-9, colliding_atom=2e-8, crowded_atom=6e-8),
        package="numba",
        extra="fast",
        keeper="atomsim.core.numba_backend.cache",
        has_threads=True,
    ),
)
"""The reference first: it is always there, and every other one is proved to give its bits before it is used."""

NAMES = ("auto", *(kind.name for kind in BACKENDS))
"""What users may choose."""
