"""Times actions in turns, so that whatever else the machine does hits all of them alike; knows nothing of them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from statistics import median
from typing import Any

Results = dict[str, Any]
"""What a section measured, as JSON holds it."""


def in_turns(actions: Mapping[str, Callable[[], object]], n_turns: int) -> dict[str, list[float]]:
    """Do everything once, then everything again; return for each action the seconds it took, turn by turn.

    Who begins moves on from turn to turn: nobody always follows the one that leaves the cache full of its own.
    """
    names = list(actions)
    seconds: dict[str, list[float]] = {name: [] for name in names}
    for turn in range(n_turns):
        start = turn % len(names)
        for name in names[start:] + names[:start]:
            begin = time.perf_counter()
            actions[name]()
            seconds[name].append(time.perf_counter() - begin)
    return seconds


def spread(seconds: list[float], unit: float = 1.0) -> Results:
    """Return the median and the minimum of some times, in a unit of so many seconds."""
    return {"median": median(seconds) / unit, "minimum": min(seconds) / unit}
