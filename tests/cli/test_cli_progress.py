"""The line that says how far a run is: its words, how often it is written, and that it goes away."""

from __future__ import annotations

import io
import os
import sys
import time

import pytest

from atomsim.cli.terminal.progress import Progress, duration, progress_line, rate
from atomsim.trajectory import Recorder, Trajectory


class Terminal(io.StringIO):
    """A stream that somebody watches."""

    def isatty(self) -> bool:
        return True

    def lines(self) -> list[str]:
        """Return what was written since the last call, from one return of the carriage to the next."""
        written = self.getvalue().split("\r")
        self.seek(0)
        self.truncate()
        return written


def watched(monkeypatch) -> Terminal:
    """Become a program at a terminal; no fixture, since pytest puts its own stream back before a test begins."""
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    return terminal


@pytest.fixture
def clock(monkeypatch):
    """Seconds that pass only when told: `clock.append(12.5)`."""
    seconds = [1000.0]
    monkeypatch.setattr(time, "monotonic", lambda: seconds[-1])
    return seconds


@pytest.mark.parametrize(
    ("begin", "reached", "rounds", "seconds", "line"),
    [
        (0, 1000, 4000, 2.0, "round 1,000 of 4,000  25 %  500 rounds/s  0:06 left"),
        (1000, 1500, 4000, 1.0, "round 1,500 of 4,000  37 %  500 rounds/s  0:05 left"),
        (0, 3999, 4000, 4000.0, "round 3,999 of 4,000  99 %  1 rounds/s  0:01 left"),
        (0, 4000, 4000, 8.0, "round 4,000 of 4,000  100 %  500 rounds/s  0:00 left"),
        (500, 500, 4000, 3.0, "round 500 of 4,000  12 %  0 rounds/s  ? left"),
        (0, 0, 4000, 0.0, "round 0 of 4,000  0 %  0 rounds/s  ? left"),
    ],
)
def test_the_line_counts_from_where_the_run_began(begin, reached, rounds, seconds, line):
    assert progress_line("round", begin, reached, rounds, seconds) == line


def test_rates_have_as_many_digits_as_mean_something():
    assert [rate(number) for number in (0.0123, 9.96, 10.0, 12345.6)] == ["0.012", "10", "10", "12,346"]


def test_durations_are_rounded_to_seconds():
    seconds = (0.4, 59.6, 75, 3599.4, 3600, 7265)
    assert [duration(second) for second in seconds] == ["0:00", "1:00", "1:15", "59:59", "1:00:00", "2:01:05"]


def test_a_line_is_written_ten_times_a_second_and_taken_away_at_the_end(monkeypatch, clock):
    terminal = watched(monkeypatch)
    with Progress() as progress:
        progress.report(100, 400)
        assert terminal.lines() == ["", "round 100 of 400  25 %  0 rounds/s  ? left"]
        clock.append(1000.05)
        progress.report(150, 400)
        assert terminal.lines() == [""]
        clock.append(1001.0)
        progress.report(200, 400)
        assert terminal.lines() == ["", "round 200 of 400  50 %  100 rounds/s  0:02 left"]
        progress.report(300, 400)
        assert terminal.lines() == [""]
    assert terminal.lines() == ["", " " * len("round 200 of 400  50 %  100 rounds/s  0:02 left"), ""]


def test_a_shorter_line_covers_the_one_before(monkeypatch, clock):
    terminal = watched(monkeypatch)
    with Progress() as progress:
        for second, round_index in ((0.0, 0), (0.5, 1), (1.0, 400)):
            clock.append(1000.0 + second)
            progress.report(round_index, 400)
    *written, blank, end = terminal.lines()
    assert [line.rstrip() for line in written] == [
        "",
        "round 0 of 400  0 %  0 rounds/s  ? left",
        "round 1 of 400  0 %  2 rounds/s  3:20 left",
        "round 400 of 400  100 %  400 rounds/s  0:00 left",
    ]
    following = [*written[1:], blank]
    assert all(len(line) >= len(before.rstrip()) for before, line in zip(written, following, strict=True))
    assert (blank.strip(), end) == ("", "")


@pytest.mark.parametrize(("is_shown", "is_silent"), [(None, True), (False, True), (True, False)])
def test_nobody_is_told_who_does_not_watch(monkeypatch, is_shown, is_silent):
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    with Progress(is_shown=is_shown) as progress:
        progress.report(1, 4)
    assert (stream.getvalue() == "") == is_silent


def test_a_terminal_that_is_told_not_to_be_written_to(monkeypatch):
    terminal = watched(monkeypatch)
    with Progress(is_shown=False) as progress:
        progress.report(1, 4)
    assert terminal.getvalue() == ""


def test_a_line_is_no_wider_than_the_terminal(monkeypatch, clock):
    """The rest would go into the next line, from where nothing takes it back."""
    terminal = watched(monkeypatch)
    terminal.fileno = lambda: 2
    monkeypatch.setattr(os, "get_terminal_size", lambda fd: os.terminal_size((20, 24)))
    with Progress() as progress:
        progress.report(0, 400)
        clock.append(1001.0)
        progress.report(200, 400)
    assert [len(line) for line in terminal.lines()] == [0, 19, 19, 19, 0]


def test_a_terminal_that_cannot_return_its_carriage(monkeypatch):
    terminal = watched(monkeypatch)
    monkeypatch.setenv("TERM", "dumb")
    with Progress() as progress:
        progress.report(1, 4)
    assert terminal.getvalue() == ""


def test_what_is_gone_through_is_counted(monkeypatch, clock):
    terminal = watched(monkeypatch)
    with Progress("frame") as progress:
        for number in progress.over([1, 2, 3]):
            clock.append(1000.0 + number)
    assert [line.strip() for line in terminal.lines()] == [
        "",
        "frame 0 of 3  0 %  0 frames/s  ? left",
        "frame 1 of 3  33 %  1 frames/s  0:02 left",
        "frame 2 of 3  66 %  1 frames/s  0:01 left",
        "frame 3 of 3  100 %  1 frames/s  0:00 left",
        "",
        "",
    ]


def test_nothing_at_all_is_done_at_once(monkeypatch):
    terminal = watched(monkeypatch)
    with Progress("frame") as progress:
        assert list(progress.over([])) == []
    assert "frame 0 of 0  0 %" in terminal.getvalue()


LONG = {
    "run scenes/rods.yaml --rounds 20 -o new.h5": "round 0 of 20",
    "run --resume out.h5 --rounds 40": "round 20 of 40",
    "verify out.h5": "round 0 of 20",
    "compare out.h5 out.h5": "frame 0 of 3",
    "render out.h5 --size 32x24 --rounds 0,10,20": "picture 0 of 3",
    "render out.h5 --size 32x24 --frames film": "picture 0 of 3",
    "recover killed.h5": "frame 3 of 3",
    "measure out.h5 -o out.csv": "frame 3 of 3",
    "golden record scenes/threads.yaml": "round 0 of ",
    "golden check scenes/threads.yaml": "round 0 of ",
}


@pytest.mark.parametrize("command", LONG)
def test_whatever_may_take_long_says_how_far_it_is(cli, monkeypatch, command):
    assert cli("run", "scenes/rods.yaml", "--rounds", "20", "-q").code == 0
    if "recover" in command:
        with Trajectory("out.h5") as trajectory, Recorder.begin("killed.h5", trajectory.header) as recorder:
            for frame in trajectory:
                recorder.append(frame)
    if "check" in command:
        assert cli("golden", "record", "scenes/threads.yaml").code == 0
    terminal = watched(monkeypatch)
    result = cli(*command.split())
    assert (result.code, LONG[command] in terminal.getvalue()) == (0, True)
    assert terminal.lines()[-1] == ""
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert cli("compare", "out.h5", "out.h5").code == 0
    assert sys.stderr.getvalue() == ""


def test_a_run_outlives_its_terminal(monkeypatch):
    lost = []

    def gone(text):
        lost.append(text)
        raise OSError

    monkeypatch.setattr(watched(monkeypatch), "write", gone)
    with Progress() as progress:
        progress.report(1, 4)
    assert len(lost) == 3


def test_no_stream_at_all(monkeypatch):
    monkeypatch.setattr(sys, "stderr", None)
    with Progress() as progress:
        progress.report(1, 4)
