"""The stiffness of scenes whose largest eigenvalue is known by hand, and that it tells when a run blows up."""

from __future__ import annotations

import numpy as np
import pytest
from support.running import after, atoms_at, compiled, is_finite

from atomsim.core.diagnosis import stiffness
from atomsim.core.diagnosis.stiffness import is_surely_stable, largest_stiffness, largest_time_step

ALL_PAIRS = {"b": {"within": "all", "rule": "all-pairs"}}
TWO = {"a": atoms_at((0, 0, 0), (3, 0, 0))}


def rod(count: int) -> dict[str, object]:
    return {"a": {"shape": "string", "count": count, "step": [1.5, 0, 0]}}


@pytest.mark.parametrize("count", [2, 3, 10, 70])
def test_a_rod_is_as_stiff_as_it_has_atoms_twice(count: int) -> None:
    """Along a straight rod every pair pulls with stiffness 2: K is twice the Laplacian of the complete graph."""
    model, state = compiled(rod(count), bonds=ALL_PAIRS)
    assert largest_stiffness(model, state) == pytest.approx(2 * count, rel=1e-6)
    assert largest_time_step(model, state) == pytest.approx(2 / count, rel=1e-6)


def test_two_atoms_away_from_their_desired_distance() -> None:
    """Along the bond 1 + r²/d², and both atoms answer."""
    model, state = compiled(TWO, bonds={"b": {"within": "all", "rule": "all-pairs", "rest": 6}})
    assert largest_stiffness(model, state) == pytest.approx(2 * (1 + 36 / 9), rel=1e-6)


def test_a_chain_is_stiffest_in_a_zigzag() -> None:
    """The path graph: 2 · (2 − 2 cos(π (n − 1)/n))."""
    model, state = compiled(rod(12), bonds={"b": {"within": "a", "rule": "neighbour"}})
    assert largest_stiffness(model, state) == pytest.approx(2 * (2 - 2 * np.cos(np.pi * 11 / 12)), rel=1e-4)


@pytest.mark.parametrize(("rest", "expected"), [("initial", 2.0), (0, 1.0), (6, 5.0)])
def test_a_tether_moves_one_atom_only(rest: object, expected: float) -> None:
    tether = {"kind": "tether", "acts_on": "a[1]", "target": [0, 0, 0], "rest": rest}
    model, state = compiled(TWO, forces={"t": tether})
    assert largest_stiffness(model, state) == pytest.approx(expected, rel=1e-6)


def test_an_atom_that_is_held_does_not_answer() -> None:
    model, state = compiled(TWO, bonds=ALL_PAIRS, forces={"h": {"kind": "hold", "acts_on": "a[0]"}})
    assert largest_stiffness(model, state) == pytest.approx(2.0, rel=1e-6)


def test_only_pairs_in_contact_count_among_collisions() -> None:
    groups = {"a": atoms_at((0, 0, 0), (1, 0, 0), (9, 0, 0))}
    model, state = compiled(groups, collisions={"c": {"within": "a"}})
    assert largest_stiffness(model, state) == pytest.approx(2 * (1 + 4 / 1), rel=1e-6)


def test_nothing_elastic_allows_any_time_step() -> None:
    model, state = compiled(TWO, forces={"d": {"kind": "damping", "coefficient": 0.5}})
    assert largest_time_step(model, state) == np.inf
    assert is_surely_stable(model, state)


def damping(*coefficients: float, **keys: str) -> dict[str, object]:
    """One damping force after the other."""
    return {f"d{i}": {"kind": "damping", "coefficient": m, **keys} for i, m in enumerate(coefficients)}


def growth(stiffness: list[list[float]], coefficients: list[float], time_step: float) -> float:
    """Return by how much a round multiplies v and c at most: v ← (1 − M)·v − K·c, c ← c + τ·v."""
    slowed, pulled = np.diag(1.0 - np.array(coefficients)), np.array(stiffness)
    moved = np.eye(len(pulled)) - time_step * pulled
    return float(np.abs(np.linalg.eigvals(np.block([[slowed, -pulled], [time_step * slowed, moved]]))).max())


@pytest.mark.parametrize("m", [0.0, 0.01, 0.5, 0.9, 1.0])
def test_damping_lowers_the_limit(m: float) -> None:
    """A bond has the stiffness 4, and the map of its motion is stable for τλ < 4 − 2m."""
    model, state = compiled(TWO, bonds=ALL_PAIRS, forces=damping(m))
    limit = largest_time_step(model, state)
    assert limit == pytest.approx((4 - 2 * m) / 4, rel=1e-6)
    assert growth([[4]], [m], 0.999 * limit) < 1 + 1e-12
    assert growth([[4]], [m], 1.001 * limit) > 1.001


@pytest.mark.parametrize("coefficients", [(0.8, 0.0, 0.0), (0.1, 0.9, 0.5), (1.0, 0.2, 1.0)])
def test_each_atom_may_be_damped_by_another_coefficient(coefficients: tuple[float, ...]) -> None:
    """A chain of three, along itself: the eigenvalues of the whole map tell."""
    forces = {f"d{i}": {"kind": "damping", "acts_on": f"a[{i}]", "coefficient": m} for i, m in enumerate(coefficients)}
    model, state = compiled(rod(3), bonds={"b": {"within": "a", "rule": "neighbour"}}, forces=forces)
    limit, chain = largest_time_step(model, state), [[2.0, -2.0, 0.0], [-2.0, 4.0, -2.0], [0.0, -2.0, 2.0]]
    assert growth(chain, list(coefficients), 0.999 * limit) < 1 + 1e-7  # the chain as a whole moves on
    assert growth(chain, list(coefficients), 1.001 * limit) > 1.001


def test_coefficients_add_up_where_atoms_are_not_held() -> None:
    limits = [
        largest_time_step(*compiled(TWO, bonds=ALL_PAIRS, forces=forces))
        for forces in (
            damping(0.3, 0.9),
            {**damping(0.3, 0.9, acts_on="a[0]"), "h": {"kind": "hold", "acts_on": "a[0]"}},
        )
    ]
    assert limits == pytest.approx([(4 - 2 * 1.2) / 4, 4 / 2], rel=1e-6)


@pytest.mark.parametrize("bonds", [{}, ALL_PAIRS])
def test_damping_that_turns_the_velocity_round_allows_no_time_step(bonds: dict[str, object]) -> None:
    model, state = compiled({**TWO, "b": atoms_at((9, 0, 0))}, bonds=bonds, forces=damping(0.9, 0.9, 0.9, acts_on="b"))
    assert largest_time_step(model, state) == 0.0
    assert not is_surely_stable(model, state)


@pytest.mark.parametrize("m", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("count", [2, 5, 20])
def test_the_limit_is_where_runs_blow_up(count: int, m: float) -> None:
    """Just below it a disturbed rod is still there after many rounds, just above it has torn itself off its place."""
    limit = (2 - m) / count
    jitter = {"amplitude": 1e-6, "seed": 1}
    for factor, survives in ((0.97, True), (1.03, False)):
        model, state = compiled(rod(count), time_step=factor * limit, bonds=ALL_PAIRS, forces=damping(m), jitter=jitter)
        end = after(model, state, 3000)
        moved = np.abs(end.position - state.position).max() if is_finite(end) else np.inf
        assert moved < 1e-3 if survives else moved > 0.1, (factor, moved)


def test_the_cheap_bound_is_never_below_the_eigenvalue() -> None:
    sure = set()
    for count in (2, 7, 40):
        for factor in (0.2, 0.49, 0.51, 0.99, 1.01):
            for forces in ({}, damping(0.7), damping(0.9, acts_on="a[0]")):
                model, state = compiled(rod(count), time_step=factor * 2 / count, bonds=ALL_PAIRS, forces=forces)
                if is_surely_stable(model, state):
                    assert model.time_step < largest_time_step(model, state)
                    sure.add(factor)
    assert {0.2, 0.49} <= sure
    assert not is_surely_stable(model, state)


def test_numbers_too_large_to_tell_are_infinitely_stiff() -> None:
    groups = {"a": atoms_at((0, 0, 0), (1e-154, 0, 0))}
    model, state = compiled(groups, bonds={"b": {"within": "a", "rule": "all-pairs", "rest": 1e7}})
    assert largest_stiffness(model, state) == np.inf
    assert largest_time_step(model, state) == 0.0


def test_a_large_scene_is_judged_in_bounded_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """With as few products as a scene of millions of bonds gets, the limit is a few per cent off at most."""
    monkeypatch.setattr(stiffness, "MOST_PULLS", 0)
    sheet = {"a": {"shape": "plane", "counts": [30, 30], "step_x": [1, 0, 0], "step_y": [0, 1, 0]}}
    model, state = compiled(sheet, bonds={"b": {"within": "a", "rule": "distance-threshold", "threshold": 1.5}})
    quick = largest_stiffness(model, state)
    monkeypatch.undo()
    assert 0.93 * largest_stiffness(model, state) < quick <= largest_stiffness(model, state)
