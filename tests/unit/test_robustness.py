"""Robustness: by hand on small runs, and against an independent monitor of signal temporal logic on random formulas."""

from __future__ import annotations

import math
import sys
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from atomsim.measures.robustness import Trace, Verdict, judge
from atomsim.scene.language import Expectation

with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)  # of the parser that it uses, for Python 3.12
    rtamt = pytest.importorskip("rtamt") if sys.version_info < (3, 12) else None

NAMES = {"x": "x of a", "y": "y of a"}
LENGTH = 24


def expected(**said: Any) -> Expectation:
    return Expectation.model_validate(said)


def verdict(said: dict[str, Any], x: list[float], *, every: int = 1, rounds: int | None = None) -> Verdict:
    """Judge a run in which x of a has these values in its frames."""
    recorded = every * np.arange(len(x))
    trace = Trace(recorded, int(recorded[-1]) if rounds is None else rounds, {"x of a": np.array(x)})
    return judge(expected(**said), trace)


def above(bound: float, **when: Any) -> dict[str, Any]:
    return {"measure": "x of a", "above": bound, **when}


@pytest.mark.parametrize(
    ("said", "margin", "round_index"),
    [
        (above(1, at=20), 2.0, 20),
        (above(1, at=14), -2.0, 10),  # the nearest frame
        (above(1, always=True), -2.0, 10),
        (above(1, always=[20, 30]), 2.0, 20),
        (above(4, eventually=True), 1.0, 30),
        (above(4, eventually=[0, 20]), -1.0, 20),
        ({"measure": "x of a", "below": 4, "at": 30}, -1.0, 30),
        ({"measure": "x of a", "between": [2, 4], "at": 20}, 1.0, 20),
        ({"not": above(1, always=True)}, 2.0, 10),
        ({"at": 30, "all": [above(1), above(4)]}, 1.0, 30),
        ({"at": 30, "any": [above(1), above(4)]}, 4.0, 30),
        ({"always": True, "that": above(2, eventually=[0, 20])}, 1.0, 20),
        ({"that": {"measure": "x of a", "below": 4}, "until": above(4)}, 1.0, 30),
        ({"that": {"measure": "x of a", "below": 2.5}, "until": above(4)}, -0.5, 20),
    ],
)
def test_by_hand(said: dict[str, Any], margin: float, round_index: int) -> None:
    found = verdict(said, [2.0, -1.0, 3.0, 5.0], every=10)
    assert (found.margin, found.round_index, found.is_met) == (margin, round_index, margin > 0)
    assert not found.is_open


@pytest.mark.parametrize(
    ("said", "is_met", "is_open"),
    [
        (above(1, always=True), False, True),
        (above(4, always=True), False, False),  # has failed, whatever had come
        (above(6, eventually=True), False, True),
        (above(1, eventually=True), True, False),  # was met, whatever had come
        (above(1, at=90), False, True),
        ({"that": above(1), "until": {"measure": "x of a", "below": 0}}, False, True),
        ({"that": above(4), "until": {"measure": "x of a", "below": 0}}, False, False),
    ],
)
def test_a_run_that_ended_early_leaves_open_what_it_did_not_settle(
    said: dict[str, Any], is_met: bool, is_open: bool
) -> None:
    found = verdict(said, [2.0, 3.0, 5.0], every=10, rounds=100)
    assert (found.is_met, found.is_open) == (is_met, is_open)


def test_what_is_no_number_meets_nothing() -> None:
    assert not verdict(above(1, at=0), [math.nan]).is_met
    assert not verdict({"measure": "x of a", "below": 1, "at": 0}, [math.nan]).is_met


def predicates() -> st.SearchStrategy[dict[str, Any]]:
    bound = st.integers(-5, 5)
    one_sided = st.builds(
        lambda name, side, value: {"measure": NAMES[name], side: value}, st.sampled_from("xy"),
        st.sampled_from(["above", "below"]), bound,
    )  # fmt: skip
    two_sided = st.builds(
        lambda name, low, width: {"measure": NAMES[name], "between": [low, low + width]},
        st.sampled_from("xy"), bound, st.integers(1, 6),
    )  # fmt: skip
    return one_sided | two_sided


def formulas() -> st.SearchStrategy[dict[str, Any]]:
    window = st.tuples(st.integers(0, 3), st.integers(0, 3)).map(lambda pair: [pair[0], pair[0] + pair[1]])

    def larger(inner: st.SearchStrategy[dict[str, Any]]) -> st.SearchStrategy[dict[str, Any]]:
        several = st.lists(inner, min_size=1, max_size=3)
        timed = st.builds(lambda key, span, that: {key: span, "that": that},
                          st.sampled_from(["always", "eventually"]), window, inner)  # fmt: skip
        return (
            several.map(lambda parts: {"all": parts})
            | several.map(lambda parts: {"any": parts})
            | inner.map(lambda part: {"not": part})
            | st.builds(lambda n, part: {"at": n, "that": part}, st.integers(0, 3), inner)
            | timed
        )

    return st.recursive(predicates(), larger, max_leaves=5)


def in_rtamt(said: dict[str, Any]) -> str:
    """Write an expectation as the other monitor reads it."""
    when = next((key for key in ("at", "always", "eventually") if key in said), None)
    if when is not None:
        first, last = (said["at"], said["at"]) if when == "at" else said[when]
        inner = in_rtamt({key: value for key, value in said.items() if key != when})
        return f"({'always' if when == 'always' else 'eventually'}[{first}:{last}] {inner})"
    if "measure" in said:
        name = next(name for name, text in NAMES.items() if text == said["measure"])
        if "between" in said:
            low, high = said["between"]
            return f"(({name} >= {low}) and ({name} <= {high}))"
        return f"({name} >= {said['above']})" if "above" in said else f"({name} <= {said['below']})"
    if "not" in said:
        return f"(not {in_rtamt(said['not'])})"
    if "until" in said:
        return f"({in_rtamt(said['that'])} until[0:{LENGTH - 1}] {in_rtamt(said['until'])})"
    if "that" in said:
        return in_rtamt(said["that"])
    word = "all" if "all" in said else "any"
    return "(" + (" and " if word == "all" else " or ").join(map(in_rtamt, said[word])) + ")"


def by_rtamt(said: dict[str, Any], values: dict[str, list[float]]) -> float:
    monitor = rtamt.StlDiscreteTimeSpecification()
    for name in (*NAMES, "out"):
        monitor.declare_var(name, "float")
    monitor.spec = f"out = {in_rtamt(said)}"
    monitor.parse()
    return float(monitor.evaluate({"time": list(range(LENGTH)), **values})[0][1])


SERIES = st.lists(st.integers(-9, 9).map(float), min_size=LENGTH, max_size=LENGTH)


@pytest.mark.skipif(rtamt is None, reason="rtamt needs Python 3.11")
@given(formulas() | st.builds(lambda a, b: {"that": a, "until": b}, predicates(), predicates()), SERIES, SERIES)
def test_as_an_independent_monitor_has_it(said: dict[str, Any], x: list[float], y: list[float]) -> None:
    trace = Trace(np.arange(LENGTH), LENGTH - 1, {"x of a": np.array(x), "y of a": np.array(y)})
    found = judge(expected(**said), trace)
    assert found.worst == found.best == by_rtamt(said, {"x": x, "y": y})
