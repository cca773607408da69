"""Gaps and contacts: looking at a few boxes or at all pairs gives the same numbers."""

from __future__ import annotations

import numpy as np
import pytest
from support.running import atoms_at, compiled

from atomsim.core.gauges import near
from atomsim.core.gauges.block import Block
from atomsim.core.gauges.near import Contacts, Gap
from atomsim.core.gauges.passing import Passing
from atomsim.core.model import Floats, Indices

NOTHING = np.empty(0)


def block_of(frames: Floats) -> Block:
    """Return a block of positions (n_frames, n_atoms, 3)."""
    position = np.ascontiguousarray(frames.transpose(2, 1, 0))
    return Block(position, np.zeros_like(position), {})


def slow_gap(frames: Floats, left: Indices, right: Indices) -> list[float]:
    gaps = []
    for frame in frames:
        apart = frame[left][:, None] - frame[right][None]
        squared = (apart[..., 0] ** 2 + apart[..., 1] ** 2) + apart[..., 2] ** 2
        squared[left[:, None] == right[None]] = np.inf
        gaps.append(float(np.sqrt(squared.min())) - 2.0)
    return gaps


@pytest.mark.parametrize("seed", range(8))
def test_boxes_find_the_nearest_pair(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Bodies far apart, inside one another, flat, and with atoms in common."""
    random = np.random.default_rng(seed)
    n_atoms = 400
    start = random.normal(size=(n_atoms, 3)) * random.choice([0.0, 1.0, 30.0], size=3)
    start[200:] += random.choice([0.0, 3.0, 100.0])
    frames = start + 0.2 * random.normal(size=(5, n_atoms, 3))
    left, right = np.arange(0, 210), np.arange(190, 400)
    expected = slow_gap(frames, left, right)
    assert Gap(left, right).measure(block_of(frames), NOTHING)[0].tolist() == expected
    monkeypatch.setattr(near, "FEW_PAIRS", 0)
    assert Gap(left, right).measure(block_of(frames), NOTHING)[0].tolist() == expected
    assert Gap(right, left).measure(block_of(frames), NOTHING)[0].tolist() == expected


def test_boxes_look_at_few_pairs_where_many_are_far(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at = []
    squared_distance = near.squared_distance

    def counted(left: Floats, right: Floats) -> Floats:
        result = squared_distance(left, right)
        looked_at.append(result.size)
        return result

    monkeypatch.setattr(near, "squared_distance", counted)
    side = np.stack(np.meshgrid(np.arange(40.0), np.arange(40.0), [0.0]), axis=-1).reshape(-1, 3)
    frames = np.concatenate([side, side + np.array([0, 0, 5])])[None]
    gap = Gap(np.arange(1600), np.arange(1600, 3200)).measure(block_of(frames), NOTHING)
    assert gap[0, 0] == 3.0
    assert sum(looked_at) < 1600 * 1600 / 4


def test_gap_of_what_is_not_finite_is_no_number(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = np.zeros((2, 4, 3))
    frames[0, :, 0] = np.arange(4)
    frames[1, 0, 0] = np.nan
    for few in (near.FEW_PAIRS, 0):
        monkeypatch.setattr(near, "FEW_PAIRS", few)
        gap = Gap(np.array([0, 1]), np.array([2, 3])).measure(block_of(frames), NOTHING)[0]
        assert gap[0] == -1.0
        assert np.isnan(gap[1])


def contacts(tables: tuple, n_atoms: int, one: object = None, other: object = None) -> Contacts:
    sides = np.ones((2, n_atoms), dtype=bool)
    for side, chosen in zip(sides, (one, other), strict=True):
        if chosen is not None:
            side[:] = False
            side[chosen] = True
    return Contacts(tables, (sides[0], sides[1]))


@pytest.mark.parametrize("few", [near.FEW_DECLARED, 0])
@pytest.mark.parametrize("step", [0.02, 3.0])
def test_contacts_are_counted_as_a_run_counts_them(few: int, step: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether all declared pairs are looked at or those that may come near, in slow and in wild motion."""
    monkeypatch.setattr(near, "FEW_DECLARED", few)
    random = np.random.default_rng(2)
    places = [tuple(place) for place in (random.random((30, 3)) * 8).tolist()]
    model, _ = compiled(
        {"a": atoms_at(*places[:10]), "b": atoms_at(*places[10:])},
        collisions={"one": {"between": ["a", "b"]}, "two": {"within": "b", "min_gap": 3}, "three": {"within": "all"}},
    )
    frames = np.array(places) + np.cumsum(step * random.normal(size=(9, 30, 3)), axis=0)
    block = block_of(frames)
    apart = frames[:, :, None] - frames[:, None]
    touches = np.triu((apart**2).sum(axis=3) < 4.0, 1)
    a, b = slice(0, 10), slice(10, 30)
    far = np.abs(np.subtract.outer(np.arange(20), np.arange(20))) >= 3
    one, two, three, of_a = (
        pairs.sum(axis=(1, 2)) for pairs in (touches[:, a, b], touches[:, b, b] & far, touches, touches[:, a])
    )
    tables = model.collisions
    assert contacts(tables, 30).measure(block, NOTHING)[0].tolist() == (one + two + three).tolist()
    assert contacts(tables[1:2], 30).measure(block, NOTHING)[0].tolist() == two.tolist()
    assert contacts(tables[2:], 30, a).measure(block, NOTHING)[0].tolist() == of_a.tolist()
    for sides in ((a, b), (b, a)):
        assert contacts(tables, 30, *sides).measure(block, NOTHING)[0].tolist() == (2 * one).tolist()


def moving(places: list[list[float]], speeds: list[list[float]]) -> Block:
    """Return a block of one frame."""
    position, velocity = (np.array(rows, dtype=float).T[:, :, None].copy() for rows in (places, speeds))
    return Block(position, velocity, {})


@pytest.mark.parametrize(
    ("place", "speed", "span", "ahead"),
    [
        ([6, 0, 0], [-1, 0, 0], 5.0, -1.0),  # they would be 1 apart, if they went through each other
        ([6, 0, 0], [-1, 0, 0], 10.0, -2.0),  # head on
        ([6, 1, 0], [-1, 0, 0], 10.0, -1.0),  # past each other, 1 apart
        ([6, 3, 0], [-1, 0, 0], 10.0, 1.0),
        ([6, 0, 0], [-1, 0, 0], 1.0, 4.0),  # too slow: not even looked at
        ([6, 0, 0], [1, 0, 0], 100.0, 4.0),  # away from each other
        ([6, 0, 0], [0, 0, 0], 100.0, 4.0),
        ([1, 0, 0], [-9, 0, 0], 1.0, -1.0),  # in contact already
        ([12, 0, 0], [-1, 0, 0], 100.0, 10.0),  # too far away to be looked at
    ],
)
def test_what_two_atoms_do_until_the_next_frame(
    place: list[float], speed: list[float], span: float, ahead: float
) -> None:
    block = moving([[0, 0, 0], place], [[0, 0, 0], speed])
    passing = Passing(Gap(np.array([0]), np.array([1])), span)
    now = float(np.linalg.norm(place)) - 2.0
    assert passing.measure(block, NOTHING)[:, 0] == pytest.approx([now, ahead])


def test_an_atom_on_both_sides_does_not_meet_itself() -> None:
    block = moving([[0, 0, 0], [6, 0, 0]], [[9, 0, 0], [9, 0, 0]])
    passing = Passing(Gap(np.array([0, 1]), np.array([1])), 1.0)
    assert passing.measure(block, NOTHING)[:, 0] == pytest.approx([4.0, 4.0])
