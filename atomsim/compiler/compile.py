"""From a scene to a model and its first state; knows the scene language and the records of the core, no stepper."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable
from itertools import chain
from typing import TypeVar, assert_never

import numpy as np

from atomsim.compiler import checks
from atomsim.compiler.checks import Complaint
from atomsim.compiler.coincident import Pairs, coincident_among, coincident_pairs
from atomsim.compiler.pairs import RuleError, expand
from atomsim.compiler.selections import GroupLayout, SelectionError, Selections, lay_out, place_of
from atomsim.compiler.shapes import place, unit
from atomsim.core.model import (
    Between,
    BondTable,
    BoundPairs,
    CollisionTable,
    DampingForce,
    ExternalForce,
    Floats,
    GroupSpan,
    HoldForce,
    Indices,
    Model,
    Origin,
    OscillateForce,
    PushForce,
    State,
    TetherForce,
    TorqueForce,
    TowardsForce,
    Within,
)
from atomsim.core.pairs.bonded import bound_pairs
from atomsim.core.pairs.near import pair_squares, squared_distance
from atomsim.errors import Problem, SceneError
from atomsim.scene import LoadedScene
from atomsim.scene.language import Bonds, Collisions, Jitter, Rest, Scene
from atomsim.scene.language.base import is_point
from atomsim.scene.language.forces import Damping, Force, Gravity, Hold, Oscillate, Push, Tether, Torque
from atomsim.scene.mistakes.mistake import first_of
from atomsim.scene.source import KeyPath, Source

Array = TypeVar("Array", Floats, Indices)
Entry = TypeVar("Entry")


def compile_scene(loaded: LoadedScene) -> tuple[Model, State]:
    """Compile a scene to flat force tables and its first state.

    Args:
        loaded: what a person wrote, and where, for messages and for the origin of every table.

    Returns:
        The model, constant in a run, and the state at round 0; their arrays are read-only.

    Raises:
        SceneError: selections that name no atoms, tables without pairs, coincident atoms that are bound or collide,
            or more atoms or pairs than fit into memory; all mistakes at once.
    """
    return _Compiler(loaded.scene, loaded.source).compile()


class _Compiler:
    """One compilation: what has been placed so far, and the mistakes found so far."""

    def __init__(self, scene: Scene, source: Source) -> None:
        self._scene = scene
        self._source = source
        self._problems: list[Problem] = []
        self._bound_pairs: dict[int, BoundPairs] = {}

    def compile(self) -> tuple[Model, State]:
        """Compile every section in order and report all mistakes together."""
        scene = self._scene
        layouts = lay_out(scene)
        n_atoms = sum(layout.stop - layout.start for layout in layouts.values())
        self._stop_on(checks.too_many_atoms(layouts))
        self._selections = Selections(layouts, n_atoms)
        with np.errstate(over="ignore", invalid="ignore"):  # what grows too large is reported next
            placed = [place(group) for group in scene.groups.values()]
            self._placed = np.concatenate([position for position, _ in placed])
            velocity = np.concatenate([velocity for _, velocity in placed])
            self._position = _jittered(self._placed, scene.jitter)
        self._stop_on(checks.too_large_numbers(scene, layouts, self._position, velocity))
        self._stop_on(checks.atoms_at_one_place(scene, layouts, self._placed, self._selections))
        self._stop_on(checks.too_many_bonds(scene.bonds, self._selections))
        self._bonds = _all_of([self._bond_table(name, entry) for name, entry in scene.bonds.items()])
        collisions = [self._collision_table(name, entry) for name, entry in scene.collisions.items()]
        forces = [force for name, entry in scene.forces.items() for force in self._forces(name, entry)]
        self._complain_all(checks.pictures_of_nothing(scene, self._selections))
        self._stop_if_wrong()
        model = Model(
            title=scene.title,
            time_step=scene.time_step,
            n_atoms=n_atoms,
            groups=self._spans(layouts),
            bonds=self._bonds,
            collisions=_all_of(collisions),
            forces=tuple(forces),
        )
        state = State(0, _read_only(self._position), _read_only(velocity))
        if scene.expect:  # only they need what measures
            from atomsim.compiler.expectations import senseless

            self._stop_on(senseless(scene, model, state))
        return model, state

    def _spans(self, layouts: dict[str, GroupLayout]) -> tuple[GroupSpan, ...]:
        """Give every group its place and origin."""
        return tuple(
            GroupSpan(name, layout.start, layout.stop, self._origin("groups", name), layout.n_copies)
            for name, layout in layouts.items()
        )

    def _bond_table(self, name: str, bonds: Bonds) -> BondTable | None:
        """Expand a rule to pairs with their desired distances."""
        path = ("bonds", name)
        try:
            first, second = expand(bonds, self._selections, self._placed)
        except RuleError as error:
            self._complain((*path, *_parts(error.key)), str(error))
            return None
        except SelectionError as error:
            self._complain_of_selection(path, bonds, error)
            return None
        except MemoryError as error:
            self._complain(path, f"binds too much: {error}")
            return None
        if self._meets(path, "bound", lambda position: coincident_among(position, first, second)):
            return None
        initial = pair_squares(self._placed.T, first, second)
        rest_squared = self._rest_squared(path, bonds.rest, initial)
        return BondTable(self._origin(*path), _read_only(first), _read_only(second), _read_only(rest_squared))

    def _collision_table(self, name: str, collisions: Collisions) -> CollisionTable | None:
        """Describe which atoms may touch; pairs are found only when they are near."""
        path = ("collisions", name)
        try:
            table = CollisionTable(
                self._origin(*path), tuple(self._blocks(collisions)), self._bound(int(collisions.except_bound))
            )
            if self._complain_all(checks.nothing_collides(path, table)):
                return None
            meets = self._meets(path, "set to collide", lambda position: coincident_pairs(position, table))
        except SelectionError as error:
            self._complain_of_selection(path, collisions, error)
            return None
        except MemoryError as error:
            self._complain((*path, "except_bound"), str(error))
            return None
        return None if meets else table

    def _bound(self, n_bonds: int) -> BoundPairs | None:
        """Return the pairs up to so many bonds apart, counted over all bonds; None for no bonds at all."""
        if n_bonds and n_bonds not in self._bound_pairs:
            self._bound_pairs[n_bonds] = bound_pairs(self._bonds, self._placed.shape[0], n_bonds)
        return self._bound_pairs.get(n_bonds)

    def _blocks(self, collisions: Collisions) -> Iterable[Within | Between]:
        """Yield the blocks of pairs that a declaration is the union of."""
        atoms = self._selections.atoms
        if collisions.within is not None:
            for part in collisions.within:
                yield from self._within(part, collisions.min_gap or 1)
        elif collisions.between is not None:
            left, right = collisions.between
            yield Between(_read_only(atoms(left)), _read_only(atoms(right)))
        else:
            yield from self._among(collisions.among or ())

    def _within(self, expression: str, min_gap: int) -> Iterable[Within | Between]:
        """Yield the blocks of one selection; places are counted in each copy, and copies collide with one another."""
        copies = self._selections.each_copy(expression) if min_gap > 1 else [expression]
        yield from (Within(_read_only(self._selections.atoms((copy,))), min_gap) for copy in copies)
        yield from self._among(tuple((copy,) for copy in copies))

    def _among(self, sides: tuple[tuple[str, ...], ...]) -> Iterable[Between]:
        """Yield few blocks with all pairs across sides: between two halves of the sides, then inside each half."""
        if len(sides) > 1:
            left, right = sides[: len(sides) // 2], sides[len(sides) // 2 :]
            yield Between(*(self._selections.atoms(tuple(chain.from_iterable(half))) for half in (left, right)))
            yield from self._among(left)
            yield from self._among(right)

    def _forces(self, name: str, force: Force) -> list[ExternalForce]:
        """Compile one external force; a torque turns each copy by itself, so it is one for each."""
        path = ("forces", name)
        origin = self._origin(*path)
        try:
            atoms = _read_only(self._selections.atoms(force.acts_on))
            match force:
                case Damping():
                    return [DampingForce(origin, atoms, force.coefficient)]
                case Gravity():
                    return [PushForce(origin, atoms, force.impulse, 0, None)]
                case Push():
                    return list(self._pushes(origin, atoms, force))
                case Oscillate():
                    return [OscillateForce(origin, atoms, force.impulse, force.period, force.phase)]
                case Torque():
                    return list(self._torques(origin, force))
                case Tether():
                    return self._tether(origin, atoms, force)
                case Hold():
                    return [HoldForce(origin, atoms)]
                case _:
                    assert_never(force)
        except SelectionError as error:
            self._complain_of_selection(path, force, error)
            return []

    def _pushes(self, origin: Origin, atoms: Indices, force: Push) -> Iterable[ExternalForce]:
        """Yield a push; if what it is directed at has copies, each of them draws the copy of the same number."""
        window, magnitude = (force.from_round, force.until_round), force.magnitude or 0.0
        if force.impulse is not None:
            yield PushForce(origin, atoms, force.impulse, *window)
        elif is_point(force.towards):
            self._complain_all(checks.too_large_point(("forces", origin.name, "towards"), force.towards))
            yield TowardsForce(origin, atoms, magnitude, force.towards, atoms[:0], *window)
        else:
            towards = tuple(str(expression) for expression in force.towards or ())
            matched = [atoms], [self._selections.atoms(towards)]
            if self._selections.n_copies(towards) > 1:
                matched = self._selections.matched((force.acts_on, towards))
            for pushed, centre in zip(*matched, strict=True):
                yield TowardsForce(origin, _read_only(pushed), magnitude, (0.0, 0.0, 0.0), _read_only(centre), *window)

    def _torques(self, origin: Origin, force: Torque) -> Iterable[TorqueForce]:
        """Yield a torque for each copy of what it acts on, about its own centre or that of the copy of `about`."""
        x, y, z = unit(force.axis).tolist()
        matched = self._selections.matched((force.acts_on, force.acts_on if force.about is None else force.about))
        for atoms, about in zip(*matched, strict=True):
            yield TorqueForce(origin, _read_only(atoms), (x, y, z), force.magnitude, _read_only(about))

    def _tether(self, origin: Origin, atoms: Indices, force: Tether) -> list[ExternalForce]:
        path, placed = ("forces", origin.name), self._placed[atoms]
        if force.target == "initial":
            target = placed
        elif self._complain_all(checks.too_large_point((*path, "target"), force.target)):
            return []
        else:
            target = np.broadcast_to(np.array(force.target), placed.shape)
        rest_squared = self._rest_squared(path, force.rest, squared_distance(placed.T, target.T))
        return [TetherForce(origin, atoms, _read_only(target), _read_only(rest_squared))]

    def _rest_squared(self, path: KeyPath, rest: Rest, initial: Floats) -> Floats:
        """Return r² per pair: the squared initial distance, without the detour through the root, or a number's."""
        if rest == "initial":
            return initial
        self._complain_all(checks.too_large_rest(path, rest))
        return np.full(initial.shape, rest * rest)

    def _meets(self, path: KeyPath, what: str, coincident: Callable[[Floats], Pairs]) -> bool:
        """Complain of atoms that start at one place, before or after jitter; return whether there are any."""
        positions = (self._placed,) if self._scene.jitter is None else (self._placed, self._position)
        return any(
            self._complain_all(checks.at_one_place(path, coincident(position), what, self._selections))
            for position in positions
        )

    def _origin(self, section: str, name: str) -> Origin:
        mark = self._source.mark((section, name))
        return Origin(section, name, mark.file, mark.line)

    def _complain(self, path: KeyPath, message: str) -> None:
        self._problems.append(self._source.problem(path, message))

    def _complain_all(self, complaints: Iterable[Complaint]) -> bool:
        """Note what a check found; return whether it found anything."""
        n_before = len(self._problems)
        for path, message in complaints:
            self._complain(path, message)
        return len(self._problems) > n_before

    def _complain_of_selection(
        self, path: KeyPath, declaration: Bonds | Collisions | Force, error: SelectionError
    ) -> None:
        """Complain at the place in a declaration where the selection was written."""
        self._complain((*path, *place_of(error.expression, declaration)), str(error))

    def _stop_on(self, complaints: Iterable[Complaint]) -> None:
        """Report all mistakes so far, if a check found some with which it makes no sense to go on."""
        self._complain_all(complaints)
        self._stop_if_wrong()

    def _stop_if_wrong(self) -> None:
        if self._problems:
            raise SceneError(first_of(sorted(self._problems, key=_place_in_text), self._source.mark(())))


def _place_in_text(problem: Problem) -> tuple[str, int, int]:
    mark = problem.mark
    return mark.file, mark.line, mark.column


def _jittered(position: Floats, jitter: Jitter | None) -> Floats:
    """Disturb every coordinate by amplitude · (2u − 1), atom by atom, x then y then z."""
    if jitter is None:
        return position
    uniform = random.Random(jitter.seed).random  # its stream is guaranteed to stay the same
    noise = np.array([2.0 * uniform() - 1.0 for _ in range(position.size)])
    return position + jitter.amplitude * noise.reshape(position.shape)


def _parts(key: str) -> KeyPath:
    return tuple(int(part) if part.isdigit() else part for part in key.split("."))


def _all_of(entries: list[Entry | None]) -> tuple[Entry, ...]:
    """Drop the entries that could not be compiled; their problems have been reported."""
    return tuple(entry for entry in entries if entry is not None)


def _read_only(array: Array) -> Array:
    """Make an array safe to share."""
    array.setflags(write=False)
    return array
