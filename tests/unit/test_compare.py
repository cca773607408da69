"""Where two runs part: the round, the first atom, the atom that differs most, and what is no difference."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from atomsim.core.digest import state_digest
from atomsim.core.model import Frame, GroupSpan, Observables, Origin, State
from atomsim.tasks.compare import first_difference

GROUPS = [
    GroupSpan(name, start, stop, Origin("groups", name, "a.yaml", 1))
    for name, start, stop in (("left", 0, 2), ("right", 2, 5))
]
NOTHING_MEASURED = Observables(0.0, 0.0, 0.0, np.zeros(3), np.zeros(3), 0)
INF, NAN = math.inf, math.nan


def frame(round_index=10, position=None, velocity=None):
    """A frame of five atoms in which the given numbers, by atom and axis, are not 0."""
    arrays = np.zeros((2, 5, 3))
    for array, numbers in zip(arrays, (position or {}, velocity or {}), strict=True):
        for place, number in numbers.items():
            array[place] = number
    return Frame(State(round_index, *arrays), 0.0, state_digest(*arrays), NOTHING_MEASURED)


def said(one, other, tolerance=0.0):
    """Compare number by number; frames of one digest would not be looked at."""
    other = replace(other, digest="another")
    return str(first_difference([one], [other], GROUPS, tolerance))


def test_first_is_the_lowest_atom_and_most_the_one_farthest_off():
    other = frame(position={(1, 2): 0.25, (2, 0): -0.5, (4, 1): 0.125})
    assert said(frame(), other) == (
        "round 10: position of 3 of 5 atoms differs, first left[1] (atom 1), most right[0] (atom 2) by 0.5"
    )
    assert said(other, frame()) == said(frame(), other)


def test_only_atoms_beyond_the_tolerance_count_and_the_edge_is_within():
    other = frame(position={(1, 0): 0.25, (1, 1): 0.25, (1, 2): 0.25, (2, 0): -0.5, (4, 1): 0.75})
    assert said(frame(), other, 0.25) == (
        "round 10: position of 2 of 5 atoms differs, first right[0] (atom 2), most right[2] (atom 4) by 0.75"
    )
    assert said(frame(), other, 0.75) == "None"
    assert said(frame(), other, math.nextafter(0.75, 0.0)) == (
        "round 10: position of 1 of 5 atoms differs, first right[2] (atom 4), most right[2] (atom 4) by 0.75"
    )


def test_velocities_are_compared_where_positions_agree():
    other = frame(position={(0, 0): 0.25}, velocity={(3, 1): 2.0})
    assert said(frame(), other).startswith("round 10: position of 1 of 5 atoms differs, first left[0] (atom 0), ")
    assert said(frame(), other, 0.5) == (
        "round 10: velocity of 1 of 5 atoms differs, first right[1] (atom 3), most right[1] (atom 3) by 2"
    )


@pytest.mark.parametrize("wild", [INF, -INF, NAN])
def test_what_is_not_finite_differs_from_all_but_itself(wild):
    one = frame(position={(0, 1): 0.5, (3, 2): wild})
    assert said(one, frame(position={(0, 1): 0.5, (3, 2): wild})) == "None"
    for other in (7.0, -INF if wild == INF else INF):
        assert said(one, frame(position={(0, 1): 0.75, (3, 2): other}), 1e300) == (
            "round 10: position of 1 of 5 atoms differs, "
            f"first right[1] (atom 3), most right[1] (atom 3) by {abs(wild):g}"
        )


def test_numbers_too_far_apart_for_a_number_are_infinitely_far_apart():
    one, other = frame(position={(4, 0): 1e308}), frame(position={(4, 0): -1e308})
    assert said(one, other, 1e300).endswith("most right[2] (atom 4) by inf")


def test_zeros_of_either_sign_are_the_same():
    negative = frame(position={(2, 2): -0.0})
    assert said(frame(), negative) == "None"
    assert negative.digest == frame().digest


def test_the_first_round_that_differs_is_named():
    left = [frame(number) for number in (0, 10, 20)]
    right = [left[0], frame(10, velocity={(0, 0): 1.0}), frame(20, position={(0, 0): 1.0})]
    found = first_difference(left, right, GROUPS)
    assert found is not None
    assert found.round_index == 10
    assert str(found).startswith("round 10: velocity ")


@pytest.mark.parametrize(
    ("left", "right", "message"),
    [
        ((0, 10, 20), (0, 10), "round 20 is only in the first"),
        ((0, 10), (0, 10, 20), "round 20 is only in the second"),
        ((0, 10, 20), (0, 20), "round 10 is only in the first"),
        ((0, 20), (0, 10, 20), "round 10 is only in the second"),
        ((), (0,), "round 0 is only in the second"),
    ],
)
def test_rounds_of_one_run_only(left, right, message):
    difference = first_difference([frame(number) for number in left], [frame(number) for number in right], GROUPS)
    assert str(difference) == message
