"""Bonds and collisions: what holds together and what may touch; knows no atoms, only selections."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from atomsim.scene.language.base import Begin, Count, Declaration, Pair, Positive, Rest, Round, Selection, require_one

AtomPair = Annotated[tuple[Round, Round], Field(strict=False, title="[i, k]")]
"""Two places in selections, counted from 0."""


class BondBase(Declaration):
    """What every bond declaration has besides its rule."""

    within: Selection | None = None
    """A group (or a list of groups): the rule applies inside each."""
    rest: Rest = "initial"
    """The desired distance of each pair: `initial` (its distance at the start) or a number [length]."""


class BondBetweenBase(BondBase):
    """A bond declaration that may also join two groups."""

    between: Pair | None = None
    """Two groups: the rule applies to pairs with one atom in each."""

    @model_validator(mode="after")
    def _check_where(self) -> BondBetweenBase:
        require_one(self, "within", "between")
        return self


class AllPairsBonds(BondBetweenBase):
    """Every pair: rigid bodies."""

    rule: Literal["all-pairs"]
    """Every pair is bound."""


class NeighbourBonds(BondBase):
    """Atoms next to each other along a string: threads and rings."""

    rule: Literal["neighbour"]
    """Pairs at most `reach` places apart in the selection."""
    within: Selection
    """A group (or a list of groups): the rule applies inside each."""
    reach: Count = 1
    """How many places apart in the selection atoms are bound at most: in `a[::2]`, `a[0]` and `a[2]` are neighbours."""
    closed: bool | None = None
    """Whether the last atom is next to the first; by default true for a whole ring or polygon, else false."""


class DistanceThresholdBonds(BondBetweenBase):
    """Atoms near each other: surfaces and solids."""

    rule: Literal["distance-threshold"]
    """Pairs with 0 < distance < `threshold`."""
    threshold: Annotated[Positive, Begin(1.5)]
    """The distance from which on nothing is bound [length, or grid steps with `metric: grid`]."""
    metric: Literal["space", "grid"] = "space"
    """`space`: distance of the initial positions; `grid`: distance in grid steps inside a plane or block."""


class ListedBonds(BondBetweenBase):
    """Pairs as listed."""

    rule: Literal["pairs"]
    """The pairs listed under `pairs`."""
    pairs: Annotated[tuple[AtomPair, ...], Field(strict=False, min_length=1), Begin([[0, 1]])]
    """[[i, k], …]: indices into `within`, or the first into A and the second into B of `between: [A, B]`."""


def _check_except_bound(value: Any) -> Any:
    if isinstance(value, bool) or (isinstance(value, int) and 1 <= value <= FURTHEST_BOUND):
        return value
    raise PydanticCustomError("except_bound", f"needs true, false or a whole number from 1 to {FURTHEST_BOUND}")


FURTHEST_BOUND = 20
"""So many bonds apart pairs may be left out at most: a thread whose atoms are 0.1 apart overlaps itself as far."""

ExceptBound = Annotated[
    bool | int,
    Field(title="true or whole number ≥ 1"),
    BeforeValidator(_check_except_bound),
    WithJsonSchema({"anyOf": [{"type": "boolean"}, {"type": "integer", "minimum": 1, "maximum": FURTHEST_BOUND}]}),
]
"""Up to how many bonds apart pairs are left out; `true` stands for 1."""


Bonds = Annotated[
    AllPairsBonds | NeighbourBonds | DistanceThresholdBonds | ListedBonds,
    Field(discriminator="rule"),
]


class Collisions(Declaration):
    """Pairs of atoms that push each other apart when they overlap (centres less than 2 apart)."""

    within: Selection | None = None
    """A group (or a list of groups): atoms inside each collide with one another."""
    min_gap: Count | None = None
    """With `within`: how many places apart in the selection atoms collide at least (default 1); not around a ring."""
    between: Pair | None = None
    """Two groups: every atom of one collides with every atom of the other."""
    among: Annotated[tuple[Selection, ...], Field(strict=False, min_length=2)] | None = None
    """Two or more groups: atoms of different groups collide."""
    except_bound: ExceptBound = False
    """`true`: pairs that a bond joins do not collide; or a number N: nor do pairs up to N bonds apart."""

    @model_validator(mode="after")
    def _check_where(self) -> Collisions:
        require_one(self, "within", "between", "among")
        if self.min_gap is not None and self.within is None:
            raise PydanticCustomError("min_gap", "`min_gap` goes with `within` only")
        return self
