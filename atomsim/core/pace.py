"""The pace of a run: its rounds in stretches of about a tenth of a second, so that it can be heard of and stopped."""

from __future__ import annotations

import time
from collections.abc import Callable

from atomsim.core.backend import Stepper

REPORT_SECONDS = 0.1
"""How long a run goes on, about, before it says where it is."""

Report = Callable[[int], object]
"""Called with the round reached; what is true of its answer ends the run there."""


class Pace:
    """Advances steppers; how rounds are cut into stretches changes no bit. It remembers how long stretches may be."""

    def __init__(self) -> None:
        self._stretch = 1

    def advance(self, stepper: Stepper, round_index: int, n_rounds: int, report: Report | None) -> tuple[int, bool]:
        """Advance a stepper by some rounds.

        Args:
            stepper: what is advanced.
            round_index: the round it is at.
            n_rounds: how many rounds to compute.
            report: called after each stretch; without one there is no reason to stop on the way.

        Returns:
            The rounds computed, and whether nothing speaks against going on.
        """
        if report is None:
            stepper.advance(n_rounds)
            return n_rounds, True
        n_done = 0
        while n_done < n_rounds:
            begin = time.perf_counter()
            n_now = min(self._stretch, n_rounds - n_done)
            stepper.advance(n_now)
            n_done += n_now
            if report(round_index + n_done):
                return n_done, False
            is_quick = time.perf_counter() - begin < REPORT_SECONDS
            self._stretch = max(self._stretch, 2 * n_now) if is_quick else max(1, n_now // 2)
        return n_done, True
