"""Scales, ticks, labels and lines of events: nothing overlaps, nothing is lost."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from atomsim.drawing.plot_layout import MOST_POINTS, Lanes, apart, limits, thinned, ticks

PLACES = st.lists(st.tuples(st.floats(0, 1000), st.floats(1, 300)), max_size=60)


@given(PLACES)
def test_texts_in_a_lane_do_not_overlap(places: list[tuple[float, float]]) -> None:
    lanes = Lanes(right=1000, gap=10, most=8)
    found: dict[int, list[tuple[float, float]]] = {}
    for at, width in places:
        place = lanes.place(at, width)
        if place is not None:
            found.setdefault(place[0], []).append((place[1], place[1] + width))
            assert place[1] + width <= 1000 or place[1] + width <= at
    assert len(found) == len(lanes) <= 8
    for taken in found.values():
        assert all(before[1] + 9.99 < after[0] for before, after in pairwise(sorted(taken)))


def test_a_text_that_would_go_too_far_ends_at_its_place() -> None:
    lanes = Lanes(right=100, gap=10, most=1)
    assert lanes.place(80, 50) == (0, 25)
    assert lanes.place(81, 50) is None


@given(st.lists(st.floats(-50, 150), min_size=1, max_size=6))
def test_labels_keep_their_distance_and_their_order(wished: list[float]) -> None:
    found = apart(wished, 10.0, 0.0, 100.0)
    ordered = [place for _, place in sorted(zip(wished, found, strict=True))]
    assert all(after - before >= 10 - 1e-9 for before, after in pairwise(ordered))
    assert max(found) <= 100
    assert min(found) >= -1e-9


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), st.integers(2, 9))
def test_ticks_are_within_the_scale_and_evenly_spaced(low: float, span: float, most: int) -> None:
    found = ticks(low, low + span, most)
    assert all(low <= tick <= low + span for tick in found)
    assert 1 <= len(found) <= most + 1
    assert np.diff(found, 2) == pytest.approx(0, abs=1e-9 * (abs(low) + span))


@pytest.mark.parametrize(("low", "high"), [(0.0, np.inf), (np.nan, 1.0), (1.0, 1.0)])
def test_without_a_scale_there_are_no_ticks(low: float, high: float) -> None:
    assert ticks(low, high, 5) == []


def test_scales_have_room_and_constants_stand_in_the_middle() -> None:
    assert limits([np.array([1.0, 2.0])]) == pytest.approx((0.94, 2.06))
    assert limits([np.array([4.0, 4.0 + 1e-14])]) == pytest.approx((3.5, 4.5))
    assert limits([np.array([np.nan]), np.array([])]) == (-1.0, 1.0)
    assert limits([np.array([-1e308, 1e308])]) == (-1e308, 1e308)


def test_a_long_line_is_thinned_and_keeps_its_extremes_and_gaps() -> None:
    rounds = np.arange(0, 1_000_000, 10)
    values = np.sin(rounds / 777.0)
    values[33_333], values[66_666], values[50_000:50_100] = 9.0, -9.0, np.nan
    few, thin = thinned(rounds, values)
    assert few.size == thin.size <= 2 * MOST_POINTS
    assert (np.diff(few) > 0).all()
    assert (few[0], few[-1]) == (rounds[0], rounds[-1])
    assert (np.nanmax(thin), np.nanmin(thin)) == (9.0, -9.0)
    assert np.isnan(thin).any()
    assert all(values[index // 10] == value or np.isnan(value) for index, value in zip(few, thin, strict=True))
    assert thinned(rounds[:9], values[:9])[0].size == 9
