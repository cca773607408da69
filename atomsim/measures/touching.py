"""What happens between two parts that may touch: they meet, bounce, stick, part, fall."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from atomsim.core.model import Floats, Indices
from atomsim.core.pairs.near import near_pairs
from atomsim.measures.events import Event, EventKind
from atomsim.measures.hysteresis import Stretch, stretches, swing
from atomsim.measures.parts import Pair
from atomsim.trajectory import Trajectory

PARTED = 0.5
"""A contact ends when the gap is wider than this [length]: what hops less has not left."""

APART = 2.0
"""Parts have separated when the gap is wider than this in the end [length]: another atom would fit between them."""

LONG = 20.0
"""A contact that lasts so many swings is no bounce any more; see `swing`."""

LIVELIEST = 2.0
"""Parts that come apart faster than this many times as fast as they met do not bounce: something carries one away."""

STILL = 0.5
"""Parts stick whose centroids then got less than this share of the way that they would at the speed they met with."""

CARRIED = 0.5
"""A part is carried when the line of contact points up to it, at least this steeply: 30° [sine of the angle]."""

BELOW = 1.0
"""A part has fallen when all of it is lower than all of what carried it by more than this [length]."""


@dataclass(frozen=True, eq=False)
class Encounter:
    """Two parts over the frames of a run.

    Attributes:
        trajectory: the run, of which a few frames are read again.
        pair: the parts.
        up: the axis of height, as 0, 1 or 2.
        round_index: of each frame, (n_frames,) int64.
        gap: between the atoms that may touch [length], (n_frames,).
        ahead: the least gap on the way from each frame to the next [length], (n_frames,).
        between: from the centroid of the second to that of the first [length], (n_frames, 3).
        drift: the velocity of the first centroid as seen from the second [length/time], (n_frames, 3).
        lowest: of either part [length], (n_frames,) each.
        highest: of either part [length], (n_frames,) each.
    """

    trajectory: Trajectory
    pair: Pair
    up: int
    round_index: Indices
    gap: Floats
    ahead: Floats
    between: Floats
    drift: Floats
    lowest: tuple[Floats, Floats]
    highest: tuple[Floats, Floats]

    @cached_property
    def _long(self) -> float:
        """How many rounds a long contact lasts."""
        return LONG * swing(self.trajectory.header.time_step)

    @cached_property
    def contacts(self) -> list[Stretch]:
        """The contacts, each until the parts have parted; one between two frames counts as one in the later frame."""
        touches = self.gap < 0.0
        touches[1:] |= self.ahead[:-1] < 0.0
        return stretches(touches, (self.gap > PARTED) & ~touches)

    @cached_property
    def normals(self) -> list[Floats]:
        """The line of each contact when it begins: a unit vector from the second part to the first, (3,)."""
        return [self._normal(contact.begin) for contact in self.contacts]

    @cached_property
    def carried(self) -> tuple[int, int] | None:
        """Which part the other carries, by number, and from which frame on; None if none does."""
        for contact, normal in zip(self.contacts, self.normals, strict=True):
            if abs(normal[self.up]) > CARRIED:
                return (0 if normal[self.up] > 0.0 else 1), contact.begin
        return None

    def events(self) -> Iterator[Event]:
        """Yield what happens between the two, in no order."""
        if not self.contacts:
            return
        yield self._event(self.contacts[0].begin, "first contact")
        if self._has_separated():
            yield self._event(self.contacts[-1].last, "separation")
        if all(part.is_held or part.bodies.size == 1 for part in self.pair.parts):
            yield from self._between_bodies()

    def _between_bodies(self) -> Iterator[Event]:
        """Yield what can happen between bodies, but makes no sense of a fluid."""
        for contact, normal in zip(self.contacts, self.normals, strict=True):
            if self._bounces(contact, normal):
                yield self._event(contact.last, "bounce")
            elif self._sticks(contact, normal):
                yield self._event(contact.begin, "sticks")
        if self.carried is not None:
            yield from self._fall(*self.carried)

    def _event(self, frame: int, kind: EventKind) -> Event:
        """Return an event of the two; one that is carried is named before what carries it."""
        is_turned = self.carried is not None and self.carried[0] == 1
        return Event(int(self.round_index[frame]), kind, self.pair.names[:: -1 if is_turned else 1])

    def _normal(self, frame: int) -> Floats:
        """Return the unit vector from the second part to the first, between the atoms nearest to each other."""
        position = self.trajectory[frame].position
        first, second = (position[atoms].T for atoms in self.pair.atoms)
        one, other = near_pairs(first, second, float(self.gap[frame]) + 2.0 + 1e-9)  # a little more, against rounding
        way = first[:, one] - second[:, other]
        squared = (way * way).sum(axis=0)
        nearest = int(np.where(squared > 0.0, squared, np.inf).argmin())
        return np.asarray(way[:, nearest] / np.sqrt(squared[nearest]))

    def _has_separated(self) -> bool:
        """Tell whether the two are apart at the end, for longer than ever between contacts, and not about to return."""
        if not self.gap[-1] > APART:
            return False
        begins, lasts, _ = zip(*self.contacts, strict=True)
        apart = int(self.round_index[-1] - self.round_index[lasts[-1]])
        before = self.round_index[list(begins[1:])] - self.round_index[list(lasts[:-1])]
        way = self.between[-1]
        closing = -float(self.drift[-1] @ way) / float(np.linalg.norm(way)) * self.trajectory.header.time_step
        return bool(apart > max(before.tolist(), default=0) and closing * apart < self.gap[-1])

    def _lasts(self, contact: Stretch) -> bool:
        return bool(self.round_index[contact.last] - self.round_index[contact.begin] >= self._long)

    def _bounces(self, contact: Stretch, normal: Floats) -> bool:
        """Tell whether a short contact turns the centroids back along its line: not past, not off, not carried away."""
        if contact.end is None or contact.begin == 0 or self._lasts(contact):
            return False
        approach, departure = float(-self.drift[contact.begin - 1] @ normal), float(self.drift[contact.end] @ normal)
        return 0.0 < departure < LIVELIEST * approach

    def _sticks(self, contact: Stretch, normal: Floats) -> bool:
        """Tell whether parts stay together that neither weight holds together nor sliding along each other."""
        if abs(normal[self.up]) > CARRIED or contact.begin == 0 or not self._lasts(contact):
            return False
        until = int(np.searchsorted(self.round_index, self.round_index[contact.begin] + self._long))
        met = float(np.linalg.norm(self.drift[contact.begin - 1])) * self.trajectory.header.time_step
        return self._way(contact.begin, until) < STILL * met * self._long

    def _way(self, frame: int, later: int) -> float:
        """Return how far one centroid moves as seen from the other."""
        return float(np.linalg.norm(self.between[later] - self.between[frame]))

    def _fall(self, fallen: int, begin: int) -> Iterator[Event]:
        """Yield the fall of a part, given by its number, that the other has carried from some frame on."""
        is_below = self.lowest[1 - fallen] - self.highest[fallen] > BELOW
        is_below[:begin] = False
        if is_below.any():
            frame = int(is_below.argmax())
            yield self._event(frame, "falls off" if self._is_outside(frame, fallen) else "falls through")

    def _is_outside(self, frame: int, fallen: int) -> bool:
        """Tell whether the centroid of a part is beside the box around the other, as seen from above."""
        position = np.delete(self.trajectory[frame].position, self.up, axis=1)
        centre = position[self.pair.parts[fallen].atoms].mean(axis=0)
        outline = position[self.pair.parts[1 - fallen].atoms]
        is_outside = (centre < outline.min(axis=0)) | (centre > outline.max(axis=0))
        return bool(is_outside.any())
