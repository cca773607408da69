"""What compiling comes to, and every message it has for a scene that makes no sense."""

from __future__ import annotations

import math
import random
import re
import tracemalloc
from collections.abc import Callable
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from support.running import atoms_at, compiled, scene_of

from atomsim.compiler import compile_scene, room
from atomsim.compiler.checks import LARGEST
from atomsim.core.model import Between, PushForce, TetherForce, TorqueForce, Within
from atomsim.core.pairs import bonded, near
from atomsim.core.pairs.collisions import n_collision_pairs
from atomsim.errors import SceneError
from atomsim.scene.loader import LoadedScene, loads

PAIR = {"pair": atoms_at((0, 0, 0), (1, 0, 0))}


def mistakes(groups: dict[str, Any], **sections: Any) -> list[str]:
    """Return path and message of every mistake."""
    with pytest.raises(SceneError) as error:
        compiled(groups, **sections)
    return [f"{problem.path}: {problem.message}" for problem in error.value.problems]


def test_origins_are_the_lines_of_the_declarations() -> None:
    text = (
        "atomsim: 1\ntime_step: 0.1\nrounds: 1\ngroups:\n  a: {shape: string, count: 3, step: [1, 0, 0]}\n"
        "bonds:\n  b: {within: a, rule: neighbour}\n\n  c: {within: a, rule: all-pairs}\n"
        "collisions:\n  d: {within: a}\nforces:\n  e: {kind: hold}\n"
    )
    loaded = loads(text, "here.yaml")
    model, _ = compile_scene(loaded)
    origins = [entry.origin for entry in (*model.groups, *model.bonds, *model.collisions, *model.forces)]
    assert [str(origin) for origin in origins] == [
        "groups.a (here.yaml:5)",
        "bonds.b (here.yaml:7)",
        "bonds.c (here.yaml:9)",
        "collisions.d (here.yaml:11)",
        "forces.e (here.yaml:13)",
    ]


def test_mistakes_are_told_together_with_their_places_in_the_order_of_the_file() -> None:
    text = (
        "atomsim: 1\ntime_step: 0.1\nrounds: 1\ngroups:\n  a: {shape: string, count: 3, step: [1, 0, 0]}\n"
        "forces:\n  late: {kind: hold, acts_on: 'a[7]'}\n"
        "bonds:\n  far: {within: a, rule: distance-threshold, threshold: 0.5}\n"
    )
    loaded = loads(text, "here.yaml")
    with pytest.raises(SceneError) as error:
        compile_scene(loaded)
    assert str(error.value) == (
        "here.yaml:7:22: forces.late.acts_on: `a[7]` is out of range: a has 3 there, 0 to 2\n"
        "here.yaml:9:46: bonds.far.threshold: nothing is bound: no two atoms are less than 0.5 apart"
    )


@pytest.mark.parametrize(
    ("bonds", "message"),
    [
        ({"within": "dot", "rule": "all-pairs"}, "within: nothing is bound: there are no two different atoms here"),
        (
            {"between": ["dot", "dot"], "rule": "all-pairs"},
            "between: nothing is bound: there are no two different atoms here",
        ),
        (
            {"within": "pair", "rule": "distance-threshold", "threshold": 1},
            "threshold: nothing is bound: no two atoms are less than 1 apart",
        ),
        (
            {"within": "floor", "rule": "distance-threshold", "threshold": 1, "metric": "grid"},
            "threshold: nothing is bound: no two atoms are less than 1 apart on the grid",
        ),
        (
            {"within": "pair", "rule": "distance-threshold", "threshold": 2, "metric": "grid"},
            "metric: `metric: grid` needs a plane or a block, and `pair` is neither",
        ),
        (
            {"between": ["floor", "pair"], "rule": "distance-threshold", "threshold": 2, "metric": "grid"},
            "metric: `metric: grid` counts steps inside one group; it goes with `within`",
        ),
        (
            {"within": "pair", "rule": "pairs", "pairs": [[0, 1], [1, 2]]},
            "pairs.1: index 2 is out of range; the atoms here are numbered 0 to 1",
        ),
        (
            {"between": ["pair", "dot"], "rule": "pairs", "pairs": [[1, 1]]},
            "pairs.0: index 1 is out of range; the atoms here are numbered 0 to 0",
        ),
        (
            {"within": "pair", "rule": "pairs", "pairs": [[0, 1], [1, 1]]},
            "pairs.1: [1, 1] would bind an atom to itself",
        ),
    ],
)
def test_bonds_that_make_no_sense(bonds: dict[str, Any], message: str) -> None:
    floor = {"shape": "plane", "counts": [2, 2], "step_x": [1, 0, 0], "step_y": [0, 1, 0], "centre": [0, 0, 9]}
    groups = {**PAIR, "dot": atoms_at((5, 5, 5)), "floor": floor}
    assert mistakes(groups, bonds={"b": bonds}) == [f"bonds.b.{message}"]


@pytest.mark.parametrize(
    ("collisions", "message"),
    [
        ({"within": "pair[0]"}, "c: nothing can collide: there are no two different atoms here"),
        ({"within": "pair[0]", "min_gap": 2}, "c: nothing can collide: there are no two different atoms here"),
        ({"between": ["pair[0]", "pair[0]"]}, "c: nothing can collide: there are no two different atoms here"),
        (
            {"within": ["pair[0]", "pair"], "min_gap": 7},
            "c.min_gap: nothing can collide: no two atoms here are 7 or more places apart",
        ),
    ],
)
def test_collisions_of_no_two_atoms(collisions: dict[str, Any], message: str) -> None:
    assert mistakes(PAIR, collisions={"c": collisions}) == [f"collisions.{message}"]


def test_collisions_of_bound_atoms_only() -> None:
    rigid = {"b": {"within": "pair", "rule": "all-pairs"}}
    for collisions in ({"within": "pair"}, {"between": ["pair", "pair"]}, {"among": ["pair[0]", "pair[1]"]}):
        assert mistakes(PAIR, bonds=rigid, collisions={"c": {**collisions, "except_bound": True}}) == [
            "collisions.c.except_bound: nothing can collide: all atoms here are that few bonds apart"
        ]


def test_atoms_at_one_place_may_be_bound_through_others_and_then_do_not_collide() -> None:
    """Both ends are bound to the hook; among those at one place, one pair that is not bound is enough for an error."""
    groups = {"ends": atoms_at((0, 0, 0), (0, 0, 0)), "hook": atoms_at((0, 0, 1.5)), "loose": atoms_at((0, 0, 9))}
    bonds = {"b": {"between": ["hook", "ends"], "rule": "all-pairs"}}
    collide = {"c": {"within": "all", "except_bound": 2}}
    compiled(groups, bonds=bonds, collisions={"c": {"among": ["ends", "hook", "loose"], "except_bound": 2}})
    everything = {"c": {"between": ["all", "all"], "except_bound": 2}}
    compiled(groups, bonds=bonds, collisions=everything)
    assert mistakes(groups, bonds=bonds, collisions={"c": {**everything["c"], "except_bound": True}}) == [
        "collisions.c: ends[0] and ends[1] are set to collide but start at the same place"
    ]
    groups["loose"] = atoms_at((0, 0, 0))
    assert mistakes(groups, bonds=bonds, collisions=collide) == [
        "collisions.c: ends[0] and loose[0] are set to collide but start at the same place (and so do others)"
    ]


def test_more_pairs_so_many_bonds_apart_than_memory() -> None:
    groups = {"a": {"shape": "string", "count": 4, "step": [1, 0, 0]}}
    sections = {
        "bonds": {"b": {"within": "a", "rule": "neighbour"}},
        "collisions": {"c": {"within": "a", "except_bound": 2}},
    }
    with patch.object(bonded, "LARGE", 0), patch.object(bonded, "free_memory", return_value=10):
        assert mistakes(groups, **sections) == [
            "collisions.c.except_bound: too many pairs are up to 2 bonds apart to fit into memory"
        ]


def test_bound_atoms_at_the_same_place() -> None:
    groups = {"a": atoms_at((1, 1, 1), (0, 0, 0)), "b": atoms_at((1, 1, 1))}
    bonds = {"b": {"between": ["a", "b"], "rule": "all-pairs"}}
    assert mistakes(groups, bonds=bonds) == ["bonds.b: a[0] and b[0] are bound but start at the same place"]
    groups["b"] = atoms_at((0, 0, 0), (1, 1, 1))
    assert mistakes(groups, bonds=bonds, jitter={"amplitude": 1e-9}) == [
        "bonds.b: a[0] and b[1] are bound but start at the same place (and so do others)"
    ]


@pytest.mark.parametrize(
    ("collisions", "pair", "more"),
    [
        ({"within": "a"}, "a[1] and a[3]", ""),
        ({"within": "a", "min_gap": 2}, "a[1] and a[3]", ""),
        ({"within": "a[1:]"}, "a[1] and a[3]", ""),
        ({"between": ["b", "a"]}, "b[1] and a[3]", " (and so do others)"),
        ({"between": ["b", ["a", "b"]]}, "b[1] and a[3]", ""),
        ({"between": ["b", "a[3]"]}, "b[1] and a[3]", ""),
        ({"among": ["a[0]", "b", "a[3:]"]}, "b[1] and a[3]", ""),
        ({"between": ["a", "a"]}, "a[1] and a[3]", ""),
        ({"between": ["a", "a[1]"]}, "a[1] and a[3]", ""),
    ],
)
def test_colliding_atoms_at_the_same_place(collisions: dict[str, Any], pair: str, more: str) -> None:
    groups = {"b": atoms_at((9, 0, 0), (5, 5, 5)), "a": atoms_at((0, 0, 0), (5, 5, 5), (2, 0, 0), (5, 5, 5), (7, 7, 7))}
    assert mistakes(groups, collisions={"c": collisions}) == [
        f"collisions.c: {pair} are set to collide but start at the same place{more}"
    ]


@pytest.mark.parametrize(
    "collisions",
    [{"within": "a", "min_gap": 3}, {"between": ["a[0]", "b"]}, {"within": ["a[:3]", "b"]}, {"between": ["b", "b"]}],
)
def test_atoms_at_the_same_place_that_do_not_collide_are_fine(collisions: dict[str, Any]) -> None:
    groups = {"b": atoms_at((9, 0, 0), (5, 5, 5)), "a": atoms_at((0, 0, 0), (5, 5, 5), (2, 0, 0), (5, 5, 5), (7, 7, 7))}
    model, _ = compiled(groups, collisions={"c": collisions})
    assert len(model.collisions) == 1


@pytest.mark.parametrize(("apart", "is_refused"), [(1e-170, True), (1.5e-162, True), (1.6e-162, False)])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_atoms_are_at_one_place_where_the_square_of_their_distance_is_zero(
    apart: float, is_refused: bool, axis: int
) -> None:
    groups = {"a": atoms_at((0, 0, 0), tuple(-apart * (axis == other) for other in range(3)))}
    sections = {"bonds": {"b": {"within": "a", "rule": "all-pairs"}}, "collisions": {"c": {"within": "a"}}}
    if is_refused:
        assert mistakes(groups, **sections) == [
            "bonds.b: a[0] and a[1] are bound but start at the same place",
            "collisions.c: a[0] and a[1] are set to collide but start at the same place",
        ]
    else:
        compiled(groups, **sections)


def test_atoms_that_jitter_puts_at_one_place() -> None:
    """A jitter of up to three quarters of the gap between two floats moves an atom by that gap or not at all."""
    far = 8e6
    gap = math.ulp(far)
    groups = {"a": atoms_at((far, far, far), (far + gap, far, far))}
    sections = {"bonds": {"b": {"within": "a", "rule": "all-pairs"}}, "collisions": {"c": {"within": "a"}}}
    compiled(groups, **sections)
    compiled(groups, jitter={"amplitude": 0.75 * gap, "seed": 1}, **sections)
    assert mistakes(groups, jitter={"amplitude": 0.75 * gap, "seed": 4}, **sections) == [
        "bonds.b: a[0] and a[1] are bound but start at the same place",
        "collisions.c: a[0] and a[1] are set to collide but start at the same place",
    ]


def test_a_crowd_at_one_place_is_told_at_once() -> None:
    groups = {"crowd": atoms_at(*[(0, 0, 0)] * 200_000)}
    assert mistakes(groups, collisions={"c": {"within": "crowd"}}) == [
        "collisions.c: crowd[0] and crowd[199999] are set to collide but start at the same place"
    ]


@pytest.mark.parametrize(
    ("groups", "message"),
    [
        (
            {"a": {"shape": "string", "count": 10**12, "step": [3, 0, 0]}},
            "groups.a: 1,000,000,000,000 atoms need about 600 TB of memory, and 8.0 GB are free",
        ),
        (
            {"a": {"shape": "block", "counts": [10**5, 10**5, 10**5], "spacing": 3}},
            "groups.a: 1,000,000,000,000,000 atoms need about 600 PB of memory, and 8.0 GB are free",
        ),
        (
            {"a": {"shape": "polygon", "corners": [[0, 0, 0], [1, 0, 0], [0.5, 0, 0]], "spacing": 1e-12}},
            "groups.a: 2,000,000,000,000 atoms need about 1 PB of memory, and 8.0 GB are free",
        ),
        (
            {"a": {"shape": "polygon", "corners": [[0, 0, 0], [1e308, 0, 0], [-1e308, 0, 0]], "spacing": 1e-320}},
            "groups.a: 3,000,000,000,000,000 atoms need about 1800 PB of memory, and 8.0 GB are free",
        ),
    ],
)
def test_absurd_numbers_of_atoms(groups: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "free_memory", lambda: 8 * 10**9)
    assert mistakes(groups) == [message]


def test_too_many_atoms_are_blamed_on_the_group_that_asks_for_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "free_memory", lambda: 10_000 * room.BYTES_PER_ATOM)
    few, many = ({"shape": "string", "count": count, "step": [3, 0, 0]} for count in (6000, 20_000))
    compiled({"a": few})
    assert mistakes({"a": few, "b": many, "c": many})[0].startswith("groups.b: 26,000 atoms, with those before, need ")
    assert mistakes({"a": few, "b": few, "c": many})[0].startswith("groups.b: 12,000 atoms, with those before, need ")
    assert mistakes({"b": many, "a": few})[0].startswith("groups.b: 20,000 atoms need ")


MILLION = {"a": {"shape": "string", "count": 10**6, "step": [3, 0, 0]}}


@pytest.mark.parametrize(
    ("bonds", "message"),
    [
        ({"within": "a", "rule": "all-pairs"}, "499,999,500,000 bonds need about 50.0 TB"),
        ({"within": ["a", "a"], "rule": "all-pairs"}, "999,999,000,000 bonds need about 100.0 TB"),
        ({"between": ["a", "all"], "rule": "all-pairs"}, "1,000,000,000,000 bonds need about 100 TB"),
        ({"within": "a", "rule": "neighbour", "reach": 10**9}, "1,000,000,000,000 bonds need about 100 TB"),
    ],
)
def test_absurd_numbers_of_bonds(bonds: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "free_memory", lambda: 8 * 10**9)
    assert mistakes(MILLION, bonds={"b": bonds}) == [f"bonds.b.rule: {message} of memory, and 8.0 GB are free"]


def test_a_threshold_that_binds_too_much(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near, "LARGE", 1 << 20)
    monkeypatch.setattr(near, "free_memory", lambda: 1 << 24)
    groups = {"a": {"shape": "string", "count": 5000, "step": [1, 0, 0]}}
    bonds = {"b": {"within": "a", "rule": "distance-threshold", "threshold": 10**4}}
    message = "bonds.b: binds too much: about 1.2e+07 pairs are near each other, too many for memory"
    assert mistakes(groups, bonds=bonds) == [message]


def test_a_million_colliding_atoms_compile_without_their_pairs() -> None:
    scene = scene_of(MILLION, collisions={"c": {"within": "a"}})
    tracemalloc.start()
    model, _ = compile_scene(LoadedScene(scene))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    (block,) = model.collisions[0].blocks
    assert isinstance(block, Within)
    assert block.atoms.size == 10**6
    assert peak < room.BYTES_PER_ATOM * 10**6


LARGE = "its coordinates are too large to compute with: more than 1e+07"
FAR = "its way in the first round is too far to compute with: more than 1e+06"


@pytest.mark.parametrize(
    ("group", "message"),
    [
        ({"shape": "string", "count": 3, "step": [1e200, 0, 0]}, LARGE),
        ({"shape": "string", "count": 3, "step": [1, 0, 0], "velocity": [0, 1e300, 0]}, FAR),
        ({"shape": "ring", "count": 3, "radius": 3, "spin": {"axis": "z", "rate": 1e9}}, FAR),
        ({"shape": "ring", "count": 3, "radius": 1e300}, LARGE),
        (atoms_at((1.7e308, 0, 0), (1.7e308, 0, 0), centre=[0, 0, 0]), LARGE),
        (atoms_at((0, 0, 0), (1e150, 0, 0)), LARGE),
    ],
)
def test_numbers_too_large_to_compute_with(group: dict[str, Any], message: str) -> None:
    assert mistakes({"fine": atoms_at((0, 0, 0)), "a": group}) == [f"groups.a: {message}"]


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ({"time_step": 1e15}, "time_step: is"),
        ({"jitter": {"amplitude": 1e308}}, "jitter.amplitude: is"),
        ({"bonds": {"b": {"within": "a", "rule": "all-pairs", "rest": 1e151}}}, "bonds.b.rest: is"),
        ({"forces": {"t": {"kind": "tether", "target": [0, 0, 1e151]}}}, "forces.t.target: its coordinates are"),
    ],
)
def test_other_numbers_too_large_to_compute_with(sections: dict[str, Any], message: str) -> None:
    found = mistakes({"a": atoms_at((0, 0, 0), (3, 0, 0))}, **sections)
    assert found[0] == f"{message} too large to compute with: more than 1e+07"


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("where", "write"),
    [
        ("groups.pair", lambda number: {"groups": {"pair": atoms_at((0, 0, 0), (0, number, 0))}}),
        (
            "groups.pair",
            lambda number: {"time_step": 0.5, "groups": {"pair": atoms_at((0, 0, 0), velocity=[0, 0, number / 5])}},
        ),
        ("time_step", lambda number: {"time_step": abs(number)}),
        ("bonds.b.rest", lambda number: {"bonds": {"b": {"within": "pair", "rule": "all-pairs", "rest": abs(number)}}}),
        ("forces.t.target", lambda number: {"forces": {"t": {"kind": "tether", "target": [number, 0, 0]}}}),
        (
            "forces.t.rest",
            lambda number: {"forces": {"t": {"kind": "tether", "target": [0, 9, 0], "rest": abs(number)}}},
        ),
    ],
)
def test_the_largest_number_to_compute_with(where: str, write: Callable[[float], dict[str, Any]], sign: float) -> None:
    compiled(**{"groups": PAIR, **write(sign * LARGEST)})
    [message] = mistakes(**{"groups": PAIR, **write(sign * math.nextafter(LARGEST, math.inf))})
    assert message.startswith(f"{where}: ")
    assert re.search("too (large|far) to compute with: more than 1e", message)


@pytest.mark.parametrize(
    ("group", "pair"),
    [
        ({"shape": "polygon", "corners": [[1, 1, 1]] * 3, "spacing": 1}, "a[0] and a[2] start at the same place"),
        ({"shape": "polygon", "corners": [[0, 0, 0], [3, 0, 0], [3, 0, 0], [0, 3, 0]], "spacing": 1}, "a[3] and a[4]"),
        ({"shape": "polygon", "corners": [[0, 0, 0], [3, 0, 0]] * 2, "spacing": 1}, "a["),
        ({"shape": "string", "count": 5, "step": [0, 0, 0]}, "a[0] and a[4]"),
        ({"shape": "plane", "counts": [3, 1], "step_x": [0, 0, 0], "step_y": [0, 0, 0]}, "a[0] and a[2]"),
        ({"shape": "plane", "counts": [3, 3], "step_x": [2, 0, 0], "step_y": [4, 0, 0]}, "a["),
        ({"shape": "ring", "count": 9, "radius": 1e-13}, "a["),
        ({"shape": "ring", "count": 9, "radius": 4, "copies": {"count": 2, "step": [0, 0, 0]}}, "a.0["),
        ({"shape": "block", "counts": [2, 1, 1], "spacing": 1e-10, "centre": [9e6, 0, 0]}, "a[0] and a[1]"),
    ],
)
def test_a_shape_whose_atoms_are_at_one_place(group: dict[str, Any], pair: str) -> None:
    [message] = mistakes({"fine": atoms_at((0, 0, 0)), "a": group})
    assert message.startswith(f"groups.a: {pair}")
    assert " start at the same place" in message


def test_a_single_atom_and_crossing_lines_have_places_of_their_own() -> None:
    compiled({"a": {"shape": "string", "count": 1, "step": [0, 0, 0]}})
    compiled({"a": {"shape": "plane", "counts": [3, 3], "step_x": [2, 0, 0], "step_y": [math.pi, 0, 0]}})


def test_jitter_is_drawn_atom_by_atom_and_only_by_its_seed() -> None:
    _, still = compiled(PAIR)
    _, state = compiled(PAIR, jitter={"amplitude": 0.25, "seed": 5})
    uniform = random.Random(5).random
    expected = [[part + 0.25 * (2 * uniform() - 1) for part in place] for place in still.position.tolist()]
    assert state.position.tolist() == expected
    _, other = compiled(PAIR, jitter={"amplitude": 0.25, "seed": 6})
    assert not np.array_equal(other.position, state.position)


def test_state_and_tables_are_read_only() -> None:
    _, state = compiled(PAIR)
    for array in (state.position, state.velocity):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1.0


def test_an_atom_knows_its_group() -> None:
    model, _ = compiled({name: atoms_at((0, 0, 0)) for name in "abc"})
    assert [model.group_of(atom).name for atom in range(3)] == ["a", "b", "c"]


def test_among_is_every_two_groups() -> None:
    groups = {name: atoms_at((place, 0, 0)) for place, name in enumerate("abc")}
    model, _ = compiled(groups, collisions={"c": {"among": ["a", "b", "c"]}})
    blocks = [block for block in model.collisions[0].blocks if isinstance(block, Between)]
    assert [(block.left.tolist(), block.right.tolist()) for block in blocks] == [([0], [1, 2]), ([1], [2])]


def test_among_many_groups_needs_few_blocks() -> None:
    names = [f"g{number}" for number in range(300)]
    groups = {name: atoms_at((3 * place, 0, 0)) for place, name in enumerate(names)}
    model, _ = compiled(groups, collisions={"c": {"among": names}})
    assert len(model.collisions[0].blocks) == 299
    assert n_collision_pairs(model.collisions[0]) == 300 * 299 // 2


def test_a_selection_used_often_is_kept_once() -> None:
    model, _ = compiled(
        {"a": atoms_at((0, 0, 0), (3, 0, 0))},
        forces={f"f{number}": {"kind": "damping", "coefficient": 0.1} for number in range(9)},
    )
    assert len({id(force.atoms) for force in model.forces}) == 1


def test_bonds_are_counted_together_before_any_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "free_memory", lambda: 10**6)
    groups = {"a": {"shape": "string", "count": 100, "step": [3, 0, 0]}}
    bonds = {name: {"within": "a", "rule": "all-pairs"} for name in "bcdef"}
    message = "bonds.d.rule: 14,850 bonds, with those before, need about 1.5 MB of memory, and 1.0 MB are free"
    assert mistakes(groups, bonds=bonds) == [message]


def test_forces_keep_their_order_and_numbers() -> None:
    model, _ = compiled(
        {"a": atoms_at((0, 0, 0), (4, 3, 0))},
        forces={
            "fall": {"kind": "gravity", "impulse": [0, 0, -1]},
            "turn": {"kind": "torque", "acts_on": "a[1]", "axis": [0, 0, 9], "magnitude": 2, "about": "a"},
            "hang": {"kind": "tether", "target": [0, 0, 2]},
        },
    )
    fall, turn, hang = model.forces
    assert isinstance(fall, PushForce)
    assert (fall.impulse, fall.from_round, fall.until_round, fall.atoms.tolist()) == ((0, 0, -1), 0, None, [0, 1])
    assert isinstance(turn, TorqueForce)
    assert (turn.axis, turn.atoms.tolist(), turn.about.tolist()) == ((0, 0, 1), [1], [0, 1])
    assert isinstance(hang, TetherForce)
    assert hang.rest_squared.tolist() == [4, 29]


FINGERS: dict[str, Any] = {
    "finger": {"shape": "string", "from": [3, 0, 0], "to": [7, 0, 0], "count": 3, "copies": {"count": 3, "axis": "z"}},
    "wheel": {"shape": "ring", "count": 4, "radius": 2, "centre": [0, 0, 9], "copies": {"count": 2, "step": [9, 0, 0]}},
    "hub": atoms_at((0, 0, 9)),
}
"""Atoms 0–2, 3–5, 6–8; 9–12, 13–16; 17."""


@pytest.mark.parametrize(
    ("collisions", "n_pairs"),
    [
        ({"within": "finger"}, 36),
        ({"within": "finger", "min_gap": 2}, 27 + 3),
        ({"within": "finger.0"}, 3),
        ({"within": "finger[::2]", "min_gap": 9}, 12),
        ({"between": ["finger", "wheel"]}, 72),
        ({"among": ["finger", "wheel"]}, 72),
        ({"among": ["finger.0", "finger.1", "finger.2"]}, 27),
    ],
)
def test_copies_collide_with_one_another(collisions: dict[str, Any], n_pairs: int) -> None:
    """Only `min_gap` counts in each copy; groups collide as wholes."""
    model, _ = compiled(FINGERS, collisions={"c": collisions})
    assert n_collision_pairs(model.collisions[0]) == n_pairs


def test_a_torque_turns_each_copy_by_itself() -> None:
    forces = {
        "each": {"kind": "torque", "acts_on": "wheel", "axis": "z", "magnitude": 2},
        "one": {"kind": "torque", "acts_on": "wheel.1", "axis": "z", "magnitude": 2},
        "about": {"kind": "torque", "acts_on": "wheel", "about": "hub", "axis": "z", "magnitude": 2},
        "copies": {"kind": "torque", "acts_on": "finger[0]", "about": "finger[-1]", "axis": "z", "magnitude": 2},
    }
    model, _ = compiled(FINGERS, forces=forces)
    turns = [
        (force.origin.name, force.atoms.tolist(), force.about.tolist())
        for force in model.forces
        if isinstance(force, TorqueForce)
    ]
    first, second = [9, 10, 11, 12], [13, 14, 15, 16]
    assert turns == [
        ("each", first, first),
        ("each", second, second),
        ("one", second, second),
        ("about", first, [17]),
        ("about", second, [17]),
        ("copies", [0], [2]),
        ("copies", [3], [5]),
        ("copies", [6], [8]),
    ]


def test_groups_with_different_numbers_of_copies_are_told_where_they_are_written() -> None:
    bonds = {"b": {"between": ["finger", ["hub", "wheel[1]"]], "rule": "all-pairs"}}
    assert mistakes(FINGERS, bonds=bonds) == [
        "bonds.b.between.1.1: `finger` has 3 copies and `wheel[1]` has 2: copies of one number go together; "
        "name the ones that are meant, such as `wheel.0[1]`"
    ]


def test_messages_name_atoms_of_copies_as_selections_do() -> None:
    groups = {"dot": {**atoms_at((0, 0, 0)), "copies": {"count": 2, "step": [0, 0, 0]}}}
    assert mistakes(groups, collisions={"c": {"within": "dot"}}) == [
        "collisions.c: dot.0[0] and dot.1[0] are set to collide but start at the same place"
    ]


def test_more_copies_than_memory_are_told_before_any_is_made() -> None:
    groups = {
        "a": {**atoms_at((0, 0, 0)), "copies": [{"count": 10**9, "axis": "z"}, {"count": 10**6, "step": [1, 0, 0]}]}
    }
    (message,) = mistakes(groups)
    assert "1,000,000,000,000,000 atoms need about" in message


def test_thousands_of_triples_are_bound_and_left_out_in_little_room() -> None:
    """30,000 atoms: one set of twins for each triple, and no pair of the fluid is listed."""
    triple = {
        **atoms_at((0, 0, 0), (1.5, 0, 0), (0, 1.5, 0)),
        "copies": [
            {"count": 10, "step": [3.6, 0, 0]},
            {"count": 10, "step": [0, 3.6, 0]},
            {"count": 100, "step": [0, 0, 2.1]},
        ],
    }
    model, _ = compiled(
        {"fluid": triple},
        bonds={"triples": {"within": "fluid", "rule": "all-pairs"}},
        collisions={"fluid": {"within": "fluid", "except_bound": True}},
    )
    (bonds,), (table,) = model.bonds, model.collisions
    assert table.bound is not None
    assert (bonds.first.size, table.bound.n_sets, table.bound.sets_near.size) == (30_000, 10_000, 10_000)
    assert n_collision_pairs(table) == 30_000 * 29_999 // 2 - 30_000
