"""Which recorded rounds are meant: `--rounds 0,250`, `0-2000:100`, `0-2000`, `2000-`, `-20`."""

import numpy as np
import pytest

from atomsim.errors import InputError
from atomsim.tasks.rounds import chosen, wishes

RECORDED = np.array([0, 10, 20, 30, 40, 42])


def meant(rounds):
    """Return what was asked for and what is shown."""
    asked, places = chosen(wishes(rounds), RECORDED)
    return asked.tolist(), RECORDED[places].tolist()


@pytest.mark.parametrize(
    ("rounds", "asked", "shown"),
    [
        ("0", [0], [0]),
        ("42,0,42", [42, 0, 42], [42, 0, 42]),
        ("5,6,15,16,41", [5, 6, 15, 16, 41], [0, 10, 10, 20, 40]),
        ("0-40", [0, 10, 20, 30, 40], [0, 10, 20, 30, 40]),
        ("5-35", [10, 20, 30], [10, 20, 30]),
        ("35-", [40, 42], [40, 42]),
        ("0-42:20", [0, 20, 40], [0, 20, 40]),
        ("4-:17", [4, 21, 38], [0, 20, 40]),
        ("0-40:3", [0, 10, 20, 30, 40], [0, 10, 20, 30, 40]),
        ("7-7:1", [7], [10]),
        ("-1", [42], [42]),
        ("-2", [40, 42], [40, 42]),
        ("-20", [0, 10, 20, 30, 40, 42], [0, 10, 20, 30, 40, 42]),
        (" 0, -2 ", [0, 40, 42], [0, 40, 42]),
        ("1e1,0-4e1:2e1", [10, 0, 20, 40], [10, 0, 20, 40]),
        ([7, 42], [7, 42], [10, 42]),
        (range(0, 43, 20), [0, 20, 40], [0, 20, 40]),
        (np.array([3, 30]), [3, 30], [0, 30]),
    ],
)
def test_what_is_asked_for_and_what_is_shown(rounds, asked, shown):
    assert meant(rounds) == (asked, shown)


def test_the_nearest_is_the_nearest_and_of_two_the_earlier():
    rng = np.random.default_rng(12)
    for _ in range(300):
        recorded = np.unique(rng.integers(0, 60, size=rng.integers(1, 9)))
        asked = tuple(range(int(recorded[-1]) + 1))
        places = chosen(asked, recorded)[1]
        assert places.tolist() == [abs(recorded - wish).argmin() for wish in asked]


def test_a_span_of_a_million_million_rounds_costs_no_more_than_the_recorded_ones():
    recorded = np.array([0, 10**14, 10**15 - 1])
    assert chosen(wishes("0-999999999999999:1"), recorded)[1].tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    "rounds", ["", "-", "a", "1.5", "-0", "7-3", "0-40:0", "-3:2", "0-40:", "0,,1", "1e", "9" * 30]
)
def test_what_cannot_be_read_is_told_how_it_is_written(rounds):
    with pytest.raises(InputError, match=r"^rounds are written 0,250,500 or 0-2000:100 \(from, to, every\) or -20 "):
        wishes(rounds)


@pytest.mark.parametrize(
    ("rounds", "message"),
    [
        ("43", "there is no round 43; it ends at round 42"),
        ("0-2000:100", "there is no round 2000; it ends at round 42"),
        ("50-", "there is no round 50; it ends at round 42"),
        ("1e99", f"there is no round 1{'0' * 99}; it ends at round 42"),
        ("1-9", "no round from 1 to 9 is recorded"),
    ],
)
def test_rounds_that_are_not_there(rounds, message):
    with pytest.raises(InputError) as caught:
        meant(rounds)
    assert str(caught.value) == message
