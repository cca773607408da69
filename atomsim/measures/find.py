"""What happened in a run: the series that events are made of, and the events in order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeAlias

from atomsim.core.gauges.block import Gauge
from atomsim.core.gauges.motion import Fastest, Mean
from atomsim.core.gauges.near import Gap
from atomsim.core.gauges.passing import Passing
from atomsim.core.gauges.rigid import Body, Deformation, Tilt
from atomsim.core.gauges.shape import Level, Radius
from atomsim.core.gauges.strings import Crossings, Winding
from atomsim.core.model import Floats
from atomsim.core.pairs.collisions import as_index
from atomsim.measures.attitude import entanglements, is_straight, rests, topples, wraps
from atomsim.measures.events import Event
from atomsim.measures.hysteresis import swing
from atomsim.measures.parts import Pair, Part
from atomsim.measures.series import series_of
from atomsim.measures.touching import Encounter
from atomsim.trajectory import Trajectory

Key: TypeAlias = tuple[str, ...]
"""What is measured and of which groups."""


def find_events(trajectory: Trajectory, parts: list[Part], pairs: list[Pair], up: int) -> list[Event]:
    """Find out what happened in a run, from its recorded frames.

    Args:
        trajectory: the run.
        parts: its groups.
        pairs: those that may touch.
        up: the axis of height, as 0, 1 or 2.

    Returns:
        The events in the order of their rounds.
    """
    return sorted(_Search(trajectory, parts, pairs, up).events(), key=lambda event: event.order)


class _Search:
    """One search: the series that it needs, measured together in one pass."""

    def __init__(self, trajectory: Trajectory, parts: list[Part], pairs: list[Pair], up: int) -> None:
        self._trajectory = trajectory
        self._parts = [part for part in parts if not part.is_held]
        self._pairs = pairs
        self._up = up
        self._round = trajectory.rounds
        self._series: Mapping[Key, Floats] = series_of(trajectory, self._gauges())

    def _gauges(self) -> dict[Key, Gauge]:
        start = self._trajectory[0].position
        gauges: dict[Key, Gauge] = {}
        for part in self._parts:
            atoms = as_index(part.atoms)
            gauges["fastest", part.name] = Fastest(atoms)
            body = Body.of(atoms, start) if part.is_body else None
            if body is not None and not body.is_round:
                gauges["tilt", part.name] = Tilt(body, self._up)
                gauges["deformation", part.name] = Deformation(body)
                gauges["radius", part.name] = Radius(atoms, "outer")
        for pair in self._pairs:
            gauges["gap", *pair.names] = Passing(Gap(*pair.atoms), self._span())
            for part in pair.parts:
                atoms = as_index(part.atoms)
                gauges["place", part.name] = Mean("position", atoms)
                gauges["drift", part.name] = Mean("velocity", atoms)
                gauges["lowest", part.name] = Level(atoms, self._up, "lowest")
                gauges["highest", part.name] = Level(atoms, self._up, "highest")
            if all(part.is_string for part in pair.parts):
                gauges["crossings", *pair.names] = Crossings(*(as_index(part.atoms) for part in pair.parts))
        for string, rod in self._wrapping():
            gauges["winding", string.name, rod.name] = Winding(as_index(string.atoms), as_index(rod.atoms))
        return gauges

    def _span(self) -> float:
        """Return how far to look from one frame to the next [time]: no further than paths are straight, about."""
        header = self._trajectory.header
        return min(float(header.record_every), swing(header.time_step)) * header.time_step

    def _wrapping(self) -> Iterator[tuple[Part, Part]]:
        """Yield the strings that may wrap around something long, with that."""
        for pair in self._pairs:
            for string, rod in (pair.parts, pair.parts[::-1]):
                if string.is_string and rod.is_body:
                    yield string, rod

    def events(self) -> Iterator[Event]:
        """Yield what happened, in no order."""
        carried: dict[str, int] = {}
        for pair in self._pairs:
            encounter = self._encounter(pair)
            yield from encounter.events()
            if encounter.carried is not None:
                number, frame = encounter.carried
                name = pair.names[number]
                carried[name] = min(frame, carried.get(name, frame))
            yield from self._entanglements(pair)
        for string, rod in self._wrapping():
            yield from self._wraps(string, rod)
        for part in self._parts:
            yield from self._alone(part, carried.get(part.name))

    def _of(self, *key: str) -> Floats:
        """Return a series of one number, (n_frames,)."""
        return self._series[key][:, 0]

    def _encounter(self, pair: Pair) -> Encounter:
        first, second = pair.names
        return Encounter(
            trajectory=self._trajectory,
            pair=pair,
            up=self._up,
            round_index=self._round,
            gap=self._series["gap", first, second][:, 0],
            ahead=self._series["gap", first, second][:, 1],
            between=self._series["place", first] - self._series["place", second],
            drift=self._series["drift", first] - self._series["drift", second],
            lowest=(self._of("lowest", first), self._of("lowest", second)),
            highest=(self._of("highest", first), self._of("highest", second)),
        )

    def _entanglements(self, pair: Pair) -> Iterator[Event]:
        if ("crossings", *pair.names) in self._series:
            for stretch in entanglements(self._of("crossings", *pair.names)):
                if not any(self._is_straight(part, stretch.begin) for part in pair.parts):
                    yield Event(int(self._round[stretch.begin]), "entangles", pair.names)

    def _wraps(self, string: Part, rod: Part) -> Iterator[Event]:
        for stretch in wraps(self._of("winding", string.name, rod.name)):
            if self._is_straight(rod, stretch.begin):
                yield Event(int(self._round[stretch.begin]), "wraps", (string.name, rod.name))

    def _is_straight(self, part: Part, frame: int) -> bool:
        return is_straight(self._trajectory[frame].position[part.atoms])

    def _alone(self, part: Part, carried: int | None) -> Iterator[Event]:
        """Yield what happens to a part by itself; only what has been carried can topple, and what is round rolls."""
        for at in rests(self._round, self._of("fastest", part.name), self._trajectory.header.time_step):
            yield Event(at, "rest", (part.name,))
        if carried is not None and ("tilt", part.name) in self._series:
            tilt, deformation, radius = (self._of(what, part.name) for what in ("tilt", "deformation", "radius"))
            for at in topples(self._round, tilt, deformation, radius):
                if at >= self._round[carried]:
                    yield Event(at, "topples", (part.name,))
