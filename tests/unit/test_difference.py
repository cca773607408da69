"""In what two scenes would run differently: every value that changes a frame, and none that does not."""

from __future__ import annotations

from typing import Any

import pytest
from support.running import atoms_at, scene_of

from atomsim.scene.difference import differences

GROUPS = {"a": atoms_at((0, 0, 0), (1, 0, 0)), "b": atoms_at((5, 0, 0), velocity=[1, 0, 0])}
BOND = {"within": "a", "rule": "all-pairs"}


def found(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return the differences of two scenes that are written as changes of one."""
    one, other = (scene_of(**{"groups": GROUPS, "bonds": {"x": BOND}, **changes}) for changes in (before, now))
    return differences(one, other)


@pytest.mark.parametrize(
    "now",
    [
        {},
        {"title": "Another", "description": "Other words"},
        {"render": {"rounds": [0, 7], "colors": {"a": "red"}, "camera": {"azimuth": 1}}},
        {"bonds": {"x": {**BOND, "rest": "initial"}}},
    ],
)
def test_words_pictures_and_defaults_move_no_atom(now: dict[str, Any]) -> None:
    assert found({}, now) == []


@pytest.mark.parametrize(
    ("now", "line"),
    [
        ({"time_step": 0.1}, "time_step: 0.05 before, 0.1 now"),
        ({"record_every": 20}, "record_every: 10 before, 20 now"),
        ({"jitter": {"amplitude": 0.1}}, "jitter: null before, {amplitude: 0.1, seed: 1} now"),
        ({"groups": {**GROUPS, "c": GROUPS["a"]}}, "groups.c: new"),
        ({"bonds": {"x": BOND, "y": BOND}}, "bonds.y: new"),
        ({"bonds": {}}, "bonds.x: no longer there"),
        ({"bonds": {"x": {**BOND, "rest": 2}}}, 'bonds.x.rest: "initial" before, 2.0 now'),
        ({"groups": {"b": GROUPS["b"], "a": GROUPS["a"]}}, "groups: in another order"),
    ],
)
def test_what_moves_atoms_or_chooses_frames(now: dict[str, Any], line: str) -> None:
    assert found({}, now) == [line]


@pytest.mark.parametrize(("n_new", "last"), [(12, "bonds.y11: new"), (13, "and 1 more")])
def test_many_differences_are_counted(n_new: int, last: str) -> None:
    lines = found({}, {"bonds": {"x": BOND, **{f"y{number}": BOND for number in range(n_new)}}})
    assert lines[:2] == ["bonds.y0: new", "bonds.y1: new"]
    assert (len(lines), lines[-1]) == (n_new, last)
