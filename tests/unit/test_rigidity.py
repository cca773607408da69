"""Free motions of bodies known by hand, and counted by brute force on random bodies."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from atomsim.core.diagnosis import rigidity as module
from atomsim.core.diagnosis.clusters import Bars, clusters, prune
from atomsim.core.diagnosis.rigidity import joint_rigidity, rigidity

TRIVIAL = {0: 6, 1: 3, 2: 1}


def bars(pairs) -> Bars:
    first, second = np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2).T
    return Bars(first, second)


def ring(count: int, reach: int) -> set[tuple[int, int]]:
    return {tuple(sorted((i, (i + gap) % count))) for i in range(count) for gap in range(1, reach + 1)}


def block(n: int, threshold: float) -> tuple[np.ndarray, set[tuple[int, int]]]:
    position = np.array([(x, y, z) for z in range(n) for y in range(n) for x in range(n)], dtype=float)
    near = {
        (i, k)
        for i, k in combinations(range(n**3), 2)
        if np.square(position[i] - position[k]).sum() < threshold * threshold
    }
    return position, near


def circle(count: int) -> np.ndarray:
    angle = 2 * np.pi * np.arange(count) / count
    return np.stack((4 * np.cos(angle), 4 * np.sin(angle), 0 * angle), axis=1)


def free(n: int) -> np.ndarray:
    return np.zeros(n, dtype=bool)


@pytest.mark.parametrize(
    ("reach", "n_modes"),
    [(1, 3 * 20 - 6 - 20), (2, 3 * 20 - 6 - 40), (3, 0), (9, 0)],
)
def test_a_flat_ring_in_generic_position(reach: int, n_modes: int) -> None:
    """Every bond takes one freedom until none is left: 34 and 14 motions, although the drawn ring is flat."""
    found = rigidity(circle(20), bars(ring(20, reach)), free(20))
    assert (found.n_modes, found.is_exact) == (n_modes, True)


def test_a_straight_rod_and_a_thread() -> None:
    line = np.stack((np.arange(9.0), np.zeros(9), np.zeros(9)), axis=1)
    assert rigidity(line, bars(combinations(range(9), 2)), free(9)).n_modes == 0
    assert rigidity(line, bars((i, i + 1) for i in range(8)), free(9)).n_modes == 27 - 6 - 8


@pytest.mark.parametrize(("threshold", "is_floppy"), [(1.1, True), (1.5, False), (1.8, False)])
def test_a_block_needs_its_diagonals(threshold: float, is_floppy: bool) -> None:
    position, pairs = block(4, threshold)
    found = rigidity(position, bars(pairs), free(64))
    assert found.n_modes == (3 * 64 - 6 - len(pairs) if is_floppy else 0)


@pytest.mark.parametrize(("n_held", "n_modes"), [(0, 3), (1, 3 * 3 - 3 - 3), (2, 6 - 1 - 2), (3, 3 - 1), (4, 0)])
def test_held_atoms_of_a_chain_of_four(n_held: int, n_modes: int) -> None:
    line = np.stack((np.arange(4.0), np.zeros(4), np.zeros(4)), axis=1)
    held = np.arange(4) < n_held
    assert rigidity(line, bars([(0, 1), (1, 2), (2, 3)]), held).n_modes == n_modes


def brute_force(position: np.ndarray, pairs: Bars, held: np.ndarray) -> int:
    generic = position + module._noise(len(position))
    matrix = np.zeros((pairs.first.size, len(position), 3))
    for row, (i, k) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        matrix[row, i], matrix[row, k] = generic[i] - generic[k], generic[k] - generic[i]
    matrix = matrix[:, ~held].reshape(pairs.first.size, -1)
    rank = np.linalg.matrix_rank(matrix, tol=1e-7) if matrix.size else 0
    n_held = int(held.sum())
    whole = 0 if n_held >= 3 or n_held == len(position) else TRIVIAL[n_held]
    return 3 * int((~held).sum()) - int(rank) - whole


def is_one_body(n: int, pairs: Bars) -> bool:
    from atomsim.core.diagnosis.bodies import bodies

    return not bodies([(pairs.first, pairs.second)], n).any()


@pytest.mark.parametrize("seed", range(60))
def test_random_bodies_have_as_many_motions_as_brute_force_finds(seed: int) -> None:
    """Growing, taking away and ranks together find what the rank of all bonds says; some atoms are held."""
    random = np.random.default_rng(seed)
    n = int(random.integers(3, 26))
    share = random.uniform(0.1, 0.7)
    pairs = [pair for pair in combinations(range(n), 2) if random.random() < share or pair[1] == pair[0] + 1]
    held = random.random(n) < random.choice([0.0, 0.0, 0.15, 0.3])
    position = random.uniform(0, 6, (n, 3))
    body = bars(pairs)
    assert is_one_body(n, body)
    if held.all():
        held[0] = False
    expected = brute_force(position, body, held)
    assert rigidity(position, body, held).n_modes == expected
    with_mode = rigidity(position, body, held, with_mode=True)
    assert with_mode.n_modes == expected
    assert (with_mode.mode is not None) == (expected > 0)


def clumps(n_clumps: int, size: int, n_links: int, seed: int) -> tuple[np.ndarray, list[tuple[int, int]]]:
    """Rigid clumps in a row, each linked to the next by some bonds between different atoms."""
    random = np.random.default_rng(seed)
    pairs = [(clump * size + i, clump * size + k) for clump in range(n_clumps) for i, k in combinations(range(size), 2)]
    for clump in range(n_clumps - 1):
        ends = random.permutation(size)[:n_links], random.permutation(size)[:n_links]
        pairs += [(clump * size + int(i), (clump + 1) * size + int(k)) for i, k in zip(*ends, strict=True)]
    position = random.uniform(0, 2, (n_clumps * size, 3)) + 3 * np.repeat(np.arange(n_clumps), size)[:, None]
    return position, sorted(set(pairs))


@pytest.mark.parametrize(("n_links", "n_modes"), [(3, 9), (4, 6), (5, 3), (6, 0), (8, 0)])
def test_rigid_clumps_have_six_freedoms_each(n_links: int, n_modes: int) -> None:
    position, pairs = clumps(4, 9, n_links, seed=2)
    assert rigidity(position, bars(pairs), free(36)).n_modes == n_modes
    part = np.repeat(np.arange(4), 9)
    assert joint_rigidity(position, part, bars(pairs), free(36)).n_modes == n_modes


def test_a_hinge_is_one_motion_and_a_ball_joint_three() -> None:
    rod = np.stack((np.arange(5.0), np.zeros(5), np.zeros(5)), axis=1)
    pin = np.array([[-1.0, -1.5, 0], [-1.0, 1.5, 0]])
    other = rod[:, [2, 1, 0]] + [-1.0, 0, 1.0]
    position = np.concatenate((rod, other, pin))
    part = np.array([0] * 5 + [1] * 5 + [2] * 2)
    rods = [(i, k) for start in (0, 5) for i, k in combinations(range(start, start + 5), 2)]
    hinge = [(i, k) for i in range(10) for k in (10, 11)]
    assert joint_rigidity(position, part, bars([*rods, *hinge, (10, 11)]), free(12)).n_modes == 1
    ball = [(i, 10) for i in range(10)]
    assert joint_rigidity(position[:11], part[:11], bars([*rods, *ball]), free(11)).n_modes == 3
    held = np.arange(12) < 5
    assert joint_rigidity(position, part, bars([*rods, *hinge, (10, 11)]), held).n_modes == 1


def test_one_or_two_pins_hold_a_part_at_its_place() -> None:
    position = np.random.default_rng(4).uniform(0, 5, (8, 3))
    pairs = bars(combinations(range(8), 2))
    part = np.zeros(8, dtype=np.int64)
    for n_held in range(4):
        assert joint_rigidity(position, part, pairs, np.arange(8) < n_held).n_modes == 0


def test_beyond_a_size_a_count_of_bonds_is_a_lower_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    position, pairs = clumps(4, 9, 4, seed=2)
    monkeypatch.setattr(module, "MOST_FREEDOMS", 20)
    found = rigidity(position, bars(pairs), free(36))
    assert (found.n_modes, found.is_exact) == (6, False)
    position, pairs = clumps(4, 9, 9, seed=2)
    found = rigidity(position, bars(pairs), free(36))
    assert (found.n_modes, found.is_exact) == (0, False)


def test_large_bodies_are_decided_without_ranks(monkeypatch: pytest.MonkeyPatch) -> None:
    """A cubic lattice is taken away atom by atom, one with diagonals grows from a triangle."""
    monkeypatch.setattr(module, "MOST_FREEDOMS", 40)
    position, pairs = block(6, 1.1)
    found = rigidity(position, bars(pairs), free(216))
    assert (found.n_modes, found.is_exact) == (3 * 216 - 6 - len(pairs), True)
    position, pairs = block(6, 1.5)
    found = rigidity(position, bars(pairs), free(216))
    assert (found.n_modes, found.is_exact) == (0, True)


def test_the_mode_stretches_no_bond_and_moves_the_body_nowhere() -> None:
    position, body = circle(20), bars(ring(20, 2))
    mode = rigidity(position, body, free(20), with_mode=True).mode
    assert mode is not None
    generic = position + module._noise(20)
    along = generic[body.second] - generic[body.first]
    assert np.abs((along * (mode[body.second] - mode[body.first])).sum(axis=1)).max() < 1e-4
    assert np.abs(mode.sum(axis=0)).max() < 1e-6
    assert np.abs(np.cross(generic - generic.mean(axis=0), mode).sum(axis=0)).max() < 1e-6
    assert np.sqrt((mode * mode).sum(axis=1)).max() == pytest.approx(1.0)


def test_taking_away_and_growing_by_themselves() -> None:
    tail = bars([(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3), (0, 4), (1, 4), (2, 4), (4, 5), (5, 6)])
    n_taken, is_left = prune(tail, 7, free(7))
    assert (n_taken, is_left.any()) == (11, False)  # every bond takes a freedom
    stiff = bars(combinations(range(6), 2))
    n_taken, is_left = prune(stiff, 6, free(6))
    assert (n_taken, is_left.all()) == (0, True)
    assert clusters(stiff, 6, free(6)).tolist() == [0] * 6
    assert clusters(stiff, 6, np.arange(6) < 3).tolist() == [-1] * 6
    assert clusters(bars(ring(9, 1)), 9, free(9)).tolist() == list(range(9))
