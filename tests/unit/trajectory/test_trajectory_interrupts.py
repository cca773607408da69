"""Signals at moments that must not be interrupted: none gets lost, none comes twice, none comes too early."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator

import pytest

from atomsim.trajectory.interrupts import postponed

NUMBERS = (signal.SIGINT, signal.SIGTERM)


@pytest.fixture
def arrived() -> Iterator[list[int]]:
    """The signals that have reached the handlers of this process, in order."""
    numbers: list[int] = []
    before = {number: signal.signal(number, lambda arrived, _frame: numbers.append(arrived)) for number in NUMBERS}
    yield numbers
    for number, handler in before.items():
        signal.signal(number, handler)


def test_signals_wait_until_the_end(arrived: list[int]) -> None:
    with postponed():
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGINT)
        assert arrived == []
    assert arrived == [signal.SIGTERM, signal.SIGINT]
    signal.raise_signal(signal.SIGINT)
    assert arrived == [signal.SIGTERM, signal.SIGINT, signal.SIGINT]


def test_signals_that_are_let_through_do_not_come_again(arrived: list[int]) -> None:
    with postponed() as let_through:
        signal.raise_signal(signal.SIGINT)
        let_through()
        assert arrived == [signal.SIGINT]
        let_through()
        signal.raise_signal(signal.SIGTERM)
        assert arrived == [signal.SIGINT]
    assert arrived == [signal.SIGINT, signal.SIGTERM]


def test_a_failure_inside_lets_them_through_as_well(arrived: list[int]) -> None:
    def fail() -> None:
        signal.raise_signal(signal.SIGINT)
        raise OSError

    with pytest.raises(OSError), postponed():  # noqa: PT011 - nobody else raises it
        fail()
    assert arrived == [signal.SIGINT]


def test_what_a_handler_raises_comes_when_it_is_let_through() -> None:
    reached = []

    def be_interrupted() -> None:
        with postponed() as let_through:
            signal.raise_signal(signal.SIGINT)
            reached.append("before")
            let_through()
            reached.append("after")

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            be_interrupted()
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert reached == ["before"]


def test_signals_that_are_ignored_stay_ignored(arrived: list[int]) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    with postponed():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
    assert arrived == []


def test_other_threads_hold_nothing() -> None:
    """Python would refuse to set a handler there."""
    done = []

    def work() -> None:
        with postponed() as let_through:
            let_through()
            done.append(True)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == [True]
