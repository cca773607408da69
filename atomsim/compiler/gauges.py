"""From measures to gauges: which atoms, bonds and collisions a measure is taken of, and from what it started."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeVar, assert_never

import numpy as np
from numpy.typing import NDArray

from atomsim.compiler.selections import Selections, lay_out
from atomsim.core.gauges import motion, near, rigid, shape
from atomsim.core.gauges.block import Atoms, Gauge
from atomsim.core.gauges.recorded import Recorded
from atomsim.core.gauges.strings import Crossings, Winding
from atomsim.core.model import BondTable, CollisionTable, Floats, Indices, Model, State
from atomsim.core.pairs.collisions import as_index
from atomsim.scene.language import Scene
from atomsim.scene.language.measures import COMPONENTS, Measure
from atomsim.scene.mistakes.wording import meant, readable

Table = TypeVar("Table", BondTable, CollisionTable)


class MeasureError(ValueError):
    """A measure that makes no sense for the atoms it names; the message says why and what would."""


@dataclass(frozen=True, slots=True, eq=False)
class Subject:
    """What measures are taken of.

    Attributes:
        selections: resolves selections to atoms.
        n_atoms: number of atoms.
        up: the axis of height, as 0, 1 or 2.
        start: returns the atom centres of the first state [length], (n_atoms, 3): what turning is measured from.
        model: returns the compiled scene; asked only for what bonds and collisions tell.
    """

    selections: Selections
    n_atoms: int
    up: int
    start: Callable[[], Floats]
    model: Callable[[], Model]

    @classmethod
    def of(cls, scene: Scene, start: Callable[[], Floats], model: Callable[[], Model]) -> Subject:
        """Return the subject that a scene describes, without compiling it.

        Args:
            scene: the scene.
            start: see above.
            model: see above.
        """
        layouts = lay_out(scene)
        n_atoms = max(layout.stop for layout in layouts.values())
        up = COMPONENTS.index(scene.render.camera.up)
        return cls(Selections(layouts, n_atoms), n_atoms, up, start, model)

    @classmethod
    def compiled(cls, scene: Scene, model: Model, state: State) -> Subject:
        """Return the subject that a compiled scene is, with its first state."""
        return cls.of(scene, lambda: state.position, lambda: model)


def gauge_of(measure: Measure, subject: Subject) -> Gauge:
    """Resolve a measure.

    Args:
        measure: what is asked for.
        subject: of what.

    Returns:
        A gauge of as many columns as the measure has.

    Raises:
        SelectionError: a selection that names no atoms.
        MeasureError: no such rule, nothing to measure, or atoms that the measure makes no sense of.
    """
    return _Resolver(measure, subject).gauge()


class _Resolver:
    """One measure on its way to a gauge."""

    def __init__(self, measure: Measure, subject: Subject) -> None:
        self._measure = measure
        self._subject = subject
        letter = measure.component
        self._axes = (0, 1, 2) if letter is None else (COMPONENTS.index(letter),)

    def gauge(self) -> Gauge:
        """Choose by what is measured."""
        axes, up = self._axes, self._subject.up
        match self._measure.quantity:
            case "centroid":
                return motion.Mean("position", self._atoms(), axes)
            case "height":
                return motion.Mean("position", self._atoms(), (up,))
            case "velocity":
                return motion.Mean("velocity", self._atoms(), axes)
            case "speed":
                return motion.Speed(self._atoms())
            case "fastest":
                return motion.Fastest(self._atoms())
            case "momentum":
                return motion.Momentum(self._atoms(), axes)
            case "angular momentum":
                return motion.AngularMomentum(self._atoms(), axes)
            case "kinetic energy":
                return motion.KineticEnergy(self._atoms())
            case "lowest" | "highest" as which:
                return shape.Level(self._atoms(), up, which)
            case "extent":
                return shape.Extent(self._atoms(), axes)
            case "inner radius":
                return shape.Radius(self._atoms(), "inner")
            case "outer radius":
                return shape.Radius(self._atoms(), "outer")
            case "turning":
                return rigid.Turning(self._body(), axes)
            case "tilt":
                return rigid.Tilt(self._body(), up)
            case "deformation":
                return rigid.Deformation(self._body())
            case "max strain":
                return self._strain("max")
            case "min strain":
                return self._strain("min")
            case "mean strain":
                return self._strain("mean")
            case "contacts":
                return self._contacts()
            case "distance":
                return motion.Distance(*self._pair())
            case "relative velocity":
                return motion.RelativeVelocity(*self._pair(), axes)
            case "closing speed":
                return motion.ClosingSpeed(*self._pair())
            case "gap":
                return self._gap()
            case "overlap":
                return near.Overlap(self._gap())
            case "winding":
                return self._winding()
            case "crossings":
                return self._crossings()
            case "energy":
                return Recorded(("kinetic_energy", "potential_energy_bonds", "potential_energy_collisions"))
            case "bond energy":
                return Recorded(("potential_energy_bonds",))
            case "contact energy":
                return Recorded(("potential_energy_collisions",))
            case _:
                assert_never(self._measure.quantity)

    def _sides(self) -> list[Indices]:
        """Return the atoms of each selection."""
        return [self._subject.selections.atoms(side) for side in self._measure.selections]

    def _atoms(self) -> Atoms:
        """Return the atoms of the one selection, or all."""
        sides = self._sides()
        return as_index(sides[0]) if sides else slice(0, self._subject.n_atoms)

    def _two_sides(self) -> tuple[Indices, Indices]:
        """Return the atoms of two selections that are not the same."""
        first, second = self._sides()
        if np.array_equal(first, second):
            raise MeasureError("both selections are the same atoms")
        return first, second

    def _pair(self) -> tuple[Atoms, Atoms]:
        first, second = map(as_index, self._two_sides())
        return first, second

    def _body(self) -> rigid.Body:
        """Return the selection with the shape it had at first."""
        atoms = self._atoms()
        self._require_two(np.arange(self._subject.n_atoms)[atoms], "has no attitude, and so no {quantity}")
        return rigid.Body.of(atoms, self._subject.start())

    def _require_two(self, atoms: Indices, what: str) -> None:
        """Refuse a single atom where a direction is asked for."""
        if atoms.size < 2:
            name = self._subject.selections.expression(int(atoms[0]))
            raise MeasureError(f"`{name}` is a single atom, which {what.format(quantity=self._measure.quantity)}")

    def _gap(self) -> near.Gap:
        left, right = self._sides()
        if left.size == right.size == 1 and left[0] == right[0]:
            raise MeasureError("both selections are the same single atom")
        return near.Gap(left, right)

    def _winding(self) -> Winding:
        string, body = self._two_sides()
        self._require_two(string, "cannot wind about anything")
        self._require_two(body, "has no axis to wind about")
        return Winding(as_index(string), as_index(body))

    def _crossings(self) -> Crossings:
        left, right = self._two_sides()
        for string in (left, right):
            self._require_two(string, "crosses nothing")
        return Crossings(as_index(left), as_index(right))

    def _strain(self, which: Literal["max", "min", "mean"]) -> shape.Strain:
        """Gather the bonds of a rule, or those inside a selection, that have a length to be strained from."""
        bonds = self._declared(self._subject.model().bonds)
        is_inside = self._is_selected()[0]
        parts = []
        for table in bonds:
            is_asked = is_inside[table.first] & is_inside[table.second] & (table.rest_squared > 0.0)
            parts.append((table.first[is_asked], table.second[is_asked], np.sqrt(table.rest_squared[is_asked])))
        first, second, rest = (
            (np.concatenate(part) for part in zip(*parts, strict=True)) if parts else (np.empty(0, int),) * 3
        )
        if not first.size:
            raise MeasureError("there are no bonds of a length above zero here")
        return shape.Strain(first, second, rest, which)

    def _contacts(self) -> near.Contacts:
        return near.Contacts(self._declared(self._subject.model().collisions), self._is_selected())

    def _declared(self, tables: tuple[Table, ...]) -> tuple[Table, ...]:
        """Return the tables of the rule that is asked for, or all."""
        rule = self._measure.rule
        if rule is None:
            return tables
        section, _, name = rule.partition(".")
        chosen = tuple(table for table in tables if table.origin.name == name)
        if not chosen:
            names = [table.origin.name for table in tables]
            remedy = meant(name, names, f"the {section} are") if names else f"there are no {section}"
            raise MeasureError(f"there is no `{readable(rule)}`; {remedy}")
        return chosen

    def _is_selected(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return for either end of a pair which atoms it may be; what no selection limits may be any."""
        sides = np.ones((2, self._subject.n_atoms), dtype=bool)
        for side, atoms in zip(sides, self._sides(), strict=False):
            side[:] = False
            side[atoms] = True
        return sides[0], sides[1]
