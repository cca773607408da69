"""What happens in a run: which of its rounds tell most, and from where its motion is seen best."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atomsim.core.model import Floats, Frame, GroupSpan, Indices
from atomsim.drawing.camera import AZIMUTH, FARTHEST
from atomsim.drawing.framing import Box, is_scenery
from atomsim.errors import InputError

MOST_FRAMES, MOST_ATOMS, FEWEST_FRAMES = 256, 1 << 23, 16
"""Of a long run so many frames are looked at, evenly spread; of many atoms fewer, but never fewer than the last."""

_BLOW = 1 / 48
"""A blow is what changes the mean velocity from such a part of the run to the next; shaking to and fro is none."""

_TRIFLE = 0.01
"""Ways of less than this part of a radius, and blows of less than this part of the greatest speed, are none."""

_CALM = 0.5
"""What the mere passing of time counts, where all ways together count 1 and all blows together count 1."""

_LONG = 2.0
"""Motion that is so much longer than wide is looked at from its side."""

_LEVEL = 0.25
"""What goes sideways by less than this part of what goes up and down is no main motion."""

_ONE_WAY = 0.25
"""Motion has a direction if the mean way is this part of the root mean square of all ways."""

_SIDEWAYS, _ASIDE = 35.0, 20.0
"""How far from straight across a motion the viewer may stand, and how far he stands if he has to move [degrees]."""


@dataclass(frozen=True, slots=True, eq=False)
class Survey:
    """A run in some of its frames.

    Attributes:
        places: which frames, ascending, at least one, (k,) int64.
        happening: how much happens between two of them, above zero, (k − 1,) float64.
        motion: how the groups move.
        scenery: atoms that stay where they are, far from all that moves, (n_atoms,) bool.
    """

    places: Indices
    happening: Floats
    motion: Motion
    scenery: NDArray[np.bool_]


def telling(surveys: Sequence[Survey], n_frames: int) -> Indices:
    """Return the frames between which as much happens each time, the first and the last included.

    Args:
        surveys: of one run, or of several, of the same frames, which are to be seen side by side.
        n_frames: how many, 2 or more.

    Returns:
        Places, ascending, (n_frames,) int64, or all there are.
    """
    places = surveys[0].places
    n_chosen = min(n_frames, len(places))
    done = np.concatenate(([0.0], np.cumsum(np.sum([one.happening for one in surveys], axis=0))))
    chosen: list[int] = []
    for number in range(n_chosen):
        nearest = int(np.abs(done - done[-1] * (number / (n_frames - 1))).argmin())
        earliest, latest = chosen[-1] + 1 if chosen else 0, len(done) - n_chosen + number
        chosen.append(min(max(nearest, earliest), latest))
    return places[chosen]


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Where groups go, seen from where they began, in the mean over a run and for all groups together.

    Attributes:
        way: the way that they have gone [length], (3,) float64.
        product: the products of their ways along two axes [length²], (3, 3) float64.
    """

    way: Floats
    product: Floats

    @classmethod
    def total(cls, motions: Sequence[Motion]) -> Motion:
        """Return the motion of all groups of several runs."""
        return cls(np.sum([one.way for one in motions], axis=0), np.sum([one.product for one in motions], axis=0))

    def azimuth(self, up: str) -> float:
        """Return the direction of a viewer who has the main horizontal motion from left to right [degrees].

        It is the usual azimuth where nothing moves sideways as far as an atom's radius or as things go up and down,
        where no direction stands out, or where the motion is seen well enough from there.

        Args:
            up: the axis that points up: x, y or z.
        """
        vertical = "xyz".index(up)
        plane = [(vertical + 1) % 3, (vertical + 2) % 3]
        spread = _Spread.of(self.product[np.ix_(plane, plane)])
        height = math.sqrt(self.product[vertical, vertical])
        if spread.length < max(1.0, _LEVEL * height, _LONG * spread.width):
            return AZIMUTH
        one_way = float(self.way[plane[0]] * math.cos(spread.angle) + self.way[plane[1]] * math.sin(spread.angle))
        across = math.degrees(spread.angle) - 90.0  # from there, what goes that way goes to the right
        turn = math.remainder(AZIMUTH - across, 360.0)
        is_mirrored = one_way < 0.0 if abs(one_way) >= _ONE_WAY * spread.length else abs(turn) > 90.0
        if is_mirrored:
            across += 180.0
            turn = math.remainder(AZIMUTH - across, 360.0)
        return AZIMUTH if abs(turn) <= _SIDEWAYS else round(math.remainder(across + math.copysign(_ASIDE, turn), 360.0))


@dataclass(frozen=True, slots=True)
class _Spread:
    """The ellipse of a symmetric 2 × 2 matrix of mean products: half its length and width, and where it points."""

    length: float
    width: float
    angle: float

    @classmethod
    def of(cls, product: Floats) -> _Spread:
        (first, mixed), (_, second) = product.tolist()
        middle, half = (first + second) / 2, math.hypot((first - second) / 2, mixed)
        return cls(
            math.sqrt(middle + half), math.sqrt(max(middle - half, 0.0)), math.atan2(mixed, (first - second) / 2) / 2
        )


def survey(frames: Sequence[Frame], groups: Sequence[GroupSpan]) -> Survey:
    """Look a run over. Groups count alike, however many atoms they have; what has left the scene counts no more.

    Args:
        frames: all of the run, at least one; those that cannot be read have no say.
        groups: spans of atoms, which together hold all.
    """
    first = frames[0]
    box = Box.around(first.position)
    begun = box.clip(first.position)
    mean = _GroupMean.of(groups)
    position = low = high = begun
    velocity = np.zeros_like(begun)
    places, steps, speeds, ways, products = [], [], [], [], []
    for place, frame in _some(frames, len(begun)):
        is_here = box.holds(frame.position)[:, np.newaxis]
        before, position = position, box.clip(frame.position)
        low, high = np.minimum(low, position), np.maximum(high, position)
        velocity = np.where(is_here, np.clip(np.nan_to_num(frame.velocity), -FARTHEST, FARTHEST), velocity)
        way = mean(np.where(is_here, position - begun, 0.0))
        places.append(place)
        steps.append(np.sqrt(mean(np.square(position - before)).sum(axis=1)).sum())
        speeds.append(mean(velocity))
        ways.append(way.sum(axis=0))
        products.append((way[:, :, np.newaxis] * way[:, np.newaxis, :]).sum(axis=0))
    return Survey(
        places=np.array(places),
        happening=_happening(np.array(steps[1:]), np.array(speeds)),
        motion=Motion(np.mean(ways, axis=0), np.mean(products, axis=0)),
        scenery=is_scenery(low, high),
    )


def _some(frames: Sequence[Frame], n_atoms: int) -> Iterator[tuple[int, Frame]]:
    """Yield frames with their places, evenly spread: the first, the last, and not too many between."""
    n_wanted = min(len(frames), MOST_FRAMES, max(MOST_ATOMS // n_atoms, FEWEST_FRAMES))
    for number in range(n_wanted):
        place = number * (len(frames) - 1) // max(n_wanted - 1, 1)
        with suppress(InputError):
            yield place, frames[place]


@dataclass(frozen=True, slots=True, eq=False)
class _GroupMean:
    """Takes the mean of each group's atoms: (n_atoms, m) to (n_groups, m)."""

    start: Indices
    size: Indices

    @classmethod
    def of(cls, groups: Sequence[GroupSpan]) -> _GroupMean:
        return cls(
            np.array([group.start for group in groups]), np.array([[group.stop - group.start] for group in groups])
        )

    def __call__(self, values: Floats) -> Floats:
        return np.asarray(np.add.reduceat(values, self.start, axis=0) / self.size)


def _happening(steps: Floats, speed: Floats) -> Floats:
    """Return how much happens in each gap between frames: its share of all ways, of all blows, and some for time.

    Args:
        steps: how far the groups move in each gap [length], (n_gaps,) float64.
        speed: their mean velocities at each frame, (n_gaps + 1, n_groups, 3) float64.
    """
    blows = _blows(speed)
    happening = np.full(len(steps), _CALM / max(len(steps), 1))
    for kind, whole in ((steps, 1.0), (blows, float(np.abs(speed).max()))):
        if kind.sum() > _TRIFLE * whole:
            happening += kind / kind.sum()
    return happening


def _blows(speed: Floats) -> Floats:
    """Return how much the velocities after each gap differ from those before, of all groups together, (n_gaps,)."""
    n_gaps = len(speed) - 1
    reach = max(round(n_gaps * _BLOW), 1)
    total = np.concatenate((np.zeros_like(speed[:1]), np.cumsum(speed, axis=0)))
    here = np.arange(1, n_gaps + 1)
    before, after = np.maximum(here - reach, 0), np.minimum(here + reach, n_gaps + 1)

    def mean(first: Indices, stop: Indices) -> Floats:
        return np.asarray((total[stop] - total[first]) / (stop - first)[:, np.newaxis, np.newaxis])

    change = mean(here, after) - mean(before, here)
    return np.asarray(np.sqrt(np.square(change).sum(axis=2)).sum(axis=1))
