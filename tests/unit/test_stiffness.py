"""The stiffness of scenes whose largest eigenvalue is known by hand, and that it tells when a run blows up."""

from __future__ import annotations

import numpy as np
import pytest
from support.running import after, atoms_at, compiled, is_finite

from atomsim.core import stiffness
from atomsim.core.stiffness import is_surely_stable, largest_stiffness, largest_time_step

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


@pytest.mark.parametrize("count", [2, 5, 20])
def test_the_limit_is_where_runs_blow_up(count: int) -> None:
    """Just below it a disturbed rod is still there after many rounds, just above it is not."""
    limit = 2 / count
    jitter = {"amplitude": 1e-6, "seed": 1}
    for factor, survives in ((0.97, True), (1.03, False)):
        model, state = compiled(rod(count), time_step=factor * limit, bonds=ALL_PAIRS, jitter=jitter)
        end = after(model, state, 3000)
        distance = np.abs(end.position).max() if is_finite(end) else np.inf
        assert (distance < 2 * count) == survives, factor


def test_the_cheap_bound_is_never_below_the_eigenvalue() -> None:
    for count in (2, 7, 40):
        for factor in (0.2, 0.49, 0.51, 0.99, 1.01):
            model, state = compiled(rod(count), time_step=factor * 2 / count, bonds=ALL_PAIRS)
            if is_surely_stable(model, state):
                assert model.time_step < largest_time_step(model, state)
    assert not is_surely_stable(model, state)


def test_numbers_too_large_to_tell_are_infinitely_stiff() -> None:
    groups = {"a": atoms_at((0, 0, 0), (1e-150, 0, 0))}
    model, state = compiled(groups, bonds={"b": {"within": "a", "rule": "all-pairs", "rest": 1e150}})
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
