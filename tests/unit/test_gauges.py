"""Gauges against sums written out one by one, to the last bit: in blocks, alone, and after a pause."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from support.running import compiled

from atomsim.core.gauges import motion, shape
from atomsim.core.gauges.block import Block, Gauge, ordered_sum
from atomsim.core.gauges.meter import Meter
from atomsim.core.gauges.near import Gap, Overlap
from atomsim.core.gauges.passing import Passing
from atomsim.core.gauges.recorded import Recorded
from atomsim.core.gauges.rigid import Body, Deformation, Tilt, Turning
from atomsim.core.gauges.strings import Crossings, Winding
from atomsim.core.model import State
from atomsim.core.simulate import simulate

N_ATOMS = 37
FEW = np.array([2, 3, 5, 30])
SOME = slice(4, 29)
FIRST, SECOND = np.array([0, 1, 7, 20]), np.array([5, 3, 8, 36])
REST = np.array([1.0, 0.5, 2.0, 3.0])

Vector = tuple[float, float, float]
Slow = Callable[[list[Vector], list[Vector]], list[float]]


def states(n_states: int) -> list[State]:
    """Random states of one set of atoms, which drift and turn a little from one to the next."""
    random = np.random.default_rng(7)
    position, velocity = random.normal(size=(2, N_ATOMS, 3))
    found = []
    for index in range(n_states):
        found.append(State(10 * index, position, velocity))
        position = position * 1.01 + 0.3 * velocity
        velocity = velocity + 0.1 * random.normal(size=velocity.shape)
    return found


def block_of(found: list[State]) -> Block:
    position, velocity = (
        np.ascontiguousarray(np.stack(arrays).transpose(2, 1, 0))
        for arrays in ([state.position for state in found], [state.velocity for state in found])
    )
    return Block(position, velocity, {})


def mean(vectors: list[Vector]) -> Vector:
    x = y = z = 0.0
    for vector in vectors:
        x, y, z = x + vector[0], y + vector[1], z + vector[2]
    return x / len(vectors), y / len(vectors), z / len(vectors)


def size(vector: Vector) -> float:
    return math.sqrt((vector[0] * vector[0] + vector[1] * vector[1]) + vector[2] * vector[2])


def apart(one: Vector, other: Vector) -> Vector:
    return other[0] - one[0], other[1] - one[1], other[2] - one[2]


def width(vectors: list[Vector], axis: int) -> float:
    along = [vector[axis] for vector in vectors]
    return max(along) - min(along)


def chosen(vectors: list[Vector], atoms: object) -> list[Vector]:
    return [vectors[atom] for atom in np.arange(N_ATOMS)[atoms].tolist()]


def energy(position: list[Vector], velocity: list[Vector]) -> list[float]:
    total = 0.0
    for x, y, z in chosen(velocity, SOME):
        total += (x * x + y * y) + z * z
    return [0.5 * total]


def spin(position: list[Vector], velocity: list[Vector]) -> list[float]:
    total = 0.0
    for c, v in zip(chosen(position, SOME), chosen(velocity, SOME), strict=True):
        total += c[1] * v[2] - c[2] * v[1]
    return [total]


def closing(position: list[Vector], velocity: list[Vector]) -> list[float]:
    way = apart(mean(chosen(position, FEW)), mean(chosen(position, SOME)))
    speed = apart(mean(chosen(velocity, FEW)), mean(chosen(velocity, SOME)))
    return [-((speed[0] * way[0] + speed[1] * way[1]) + speed[2] * way[2]) / size(way)]


def strains(position: list[Vector]) -> list[float]:
    return [
        size(apart(position[i], position[k])) / r - 1.0
        for i, k, r in zip(FIRST.tolist(), SECOND.tolist(), REST.tolist(), strict=True)
    ]


def mean_strain(position: list[Vector], velocity: list[Vector]) -> list[float]:
    total = 0.0
    for strain in strains(position):
        total += strain
    return [total / 4]


def radii(position: list[Vector]) -> list[float]:
    centre = mean(chosen(position, FEW))
    return [size(apart(centre, place)) for place in chosen(position, FEW)]


def surfaces(position: list[Vector]) -> float:
    return min(size(apart(c, d)) for c in chosen(position, FEW) for d in chosen(position, slice(31, 37))) - 2.0


GAUGES: list[tuple[Gauge, Slow]] = [
    (motion.Mean("position", FEW), lambda c, v: list(mean(chosen(c, FEW)))),
    (motion.Mean("velocity", SOME, (2,)), lambda c, v: [mean(chosen(v, SOME))[2]]),
    (motion.Speed(SOME), lambda c, v: [size(mean(chosen(v, SOME)))]),
    (motion.Fastest(FEW), lambda c, v: [max(map(size, chosen(v, FEW)))]),
    (motion.Momentum(FEW, (1,)), lambda c, v: [sum((w[1] for w in chosen(v, FEW)), 0.0)]),
    (motion.AngularMomentum(SOME, (0,)), spin),
    (motion.KineticEnergy(SOME), energy),
    (motion.Distance(FEW, SOME), lambda c, v: [size(apart(mean(chosen(c, FEW)), mean(chosen(c, SOME))))]),
    (motion.RelativeVelocity(FEW, SOME), lambda c, v: list(apart(mean(chosen(v, FEW)), mean(chosen(v, SOME))))),
    (motion.ClosingSpeed(FEW, SOME), closing),
    (shape.Level(FEW, 1, "lowest"), lambda c, v: [min(place[1] for place in chosen(c, FEW))]),
    (shape.Level(SOME, 2, "highest"), lambda c, v: [max(place[2] for place in chosen(c, SOME))]),
    (shape.Extent(FEW, (1, 2)), lambda c, v: [width(chosen(c, FEW), axis) for axis in (1, 2)]),
    (shape.Radius(FEW, "inner"), lambda c, v: [min(radii(c))]),
    (shape.Radius(FEW, "outer"), lambda c, v: [max(radii(c))]),
    (shape.Strain(FIRST, SECOND, REST, "max"), lambda c, v: [max(strains(c))]),
    (shape.Strain(FIRST, SECOND, REST, "min"), lambda c, v: [min(strains(c))]),
    (shape.Strain(FIRST, SECOND, REST, "mean"), mean_strain),
    (Gap(FEW, np.arange(31, 37)), lambda c, v: [surfaces(c)]),
    (Overlap(Gap(FEW, np.arange(31, 37))), lambda c, v: [max(0.0, -surfaces(c))]),
]  # fmt: skip

BODY = Body.of(SOME, states(1)[0].position)
LINE = Body.of(slice(0, 5), np.outer(np.arange(float(N_ATOMS)), [1.0, 2.0, -1.0]))
OTHERS: list[Gauge] = [
    Turning(BODY),
    Tilt(BODY, 2),
    Deformation(BODY),
    Turning(LINE, (0,)),
    Winding(SOME, FEW),
    Crossings(SOME, FEW),
    Passing(Gap(FEW, np.arange(31, 37)), 2.0),
]


@pytest.mark.parametrize("n_frames", [1, 2, 3, 9])
@pytest.mark.parametrize(("gauge", "slow"), GAUGES)
def test_a_gauge_gives_what_its_formula_says_to_the_last_bit(gauge: Gauge, slow: Slow, n_frames: int) -> None:
    found = states(n_frames)
    expected = [slow(state.position.tolist(), state.velocity.tolist()) for state in found]
    assert gauge.n_columns == len(expected[0])
    assert gauge.measure(block_of(found), gauge.begin()).T.tolist() == expected


@pytest.mark.parametrize("gauge", [*(gauge for gauge, _ in GAUGES), *OTHERS])
def test_how_frames_are_cut_into_blocks_changes_no_bit(gauge: Gauge) -> None:
    found = states(12)
    at_once = Meter([gauge]).take(block_of(found))
    pieces = Meter([gauge])
    cuts = [found[:1], found[1:3], found[3:11], found[11:]]
    assert np.concatenate([pieces.take(block_of(part)) for part in cuts]).tobytes() == at_once.tobytes()
    alone = Meter([gauge])
    one_by_one = np.concatenate([alone.take(Block.of_states([state])) for state in found])
    assert one_by_one.tobytes() == at_once.tobytes()


def test_a_meter_goes_on_where_another_stopped() -> None:
    gauges = [motion.Speed(FEW), *OTHERS]
    found = states(12)
    at_once = Meter(gauges)
    expected = at_once.take(block_of(found))[5:]
    before, after = Meter(gauges), Meter(gauges)
    before.take(block_of(found[:5]))
    after.memory = before.memory.copy()
    assert after.take(block_of(found[5:])).tobytes() == expected.tobytes()
    assert at_once.is_running
    assert not Meter([motion.Speed(FEW)]).is_running


@pytest.mark.parametrize("n_frames", [1, 2, 17])
def test_sums_are_taken_in_order(n_frames: int) -> None:
    values = np.random.default_rng(3).normal(size=(2, 1001, n_frames)) * 10.0 ** (np.arange(1001)[:, None] % 9)
    expected = np.zeros((2, n_frames))
    for row in values.transpose(1, 0, 2):
        expected = expected + row
    assert ordered_sum(values).tobytes() == expected.tobytes()
    assert ordered_sum(values[:, 100:]).shape == (2, n_frames)


def test_a_frame_has_what_was_observed_of_it() -> None:
    groups = {"pair": {"shape": "atoms", "positions": [[0, 0, 0], [1.5, 0, 0]], "velocity": [1, 2, 3]}}
    model, state = compiled(groups, bonds={"b": {"within": "pair", "rule": "all-pairs"}})
    frame = list(simulate(model, state, 3, record_every=1))[-1]
    block = Block.of_frame(frame)
    total = Recorded(("kinetic_energy", "potential_energy_bonds")).measure(block, np.empty(0))
    assert total.tolist() == [[frame.observables.kinetic_energy + frame.observables.potential_energy_bonds]]
    assert block.observables["momentum"].tolist() == [frame.observables.momentum.tolist()]
    assert np.array_equal(block.position[:, :, 0], frame.position.T)


def test_what_is_not_finite_gives_what_is_not_finite_and_no_warning() -> None:
    position = np.full((N_ATOMS, 3), np.inf)
    position[3] = np.nan
    block = Block.of_states([State(0, position, position)])
    values = Meter([*(gauge for gauge, _ in GAUGES), *OTHERS]).take(block)
    assert values.shape[0] == 1
    assert not np.isfinite(Meter([motion.Speed(FEW)]).take(block)).any()


def test_centroids_at_one_place_do_not_close_in() -> None:
    position = np.zeros((N_ATOMS, 3))
    block = Block.of_states([State(0, position, np.random.default_rng(0).normal(size=(N_ATOMS, 3)))])
    assert motion.ClosingSpeed(FEW, SOME).measure(block, np.empty(0)).tolist() == [[0.0]]
