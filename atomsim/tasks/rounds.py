"""Which recorded rounds a user means: single ones, spans with or without a step, the latest."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from atomsim.arguments import sequence, whole
from atomsim.core.model import Indices
from atomsim.errors import InputError

_NUMBER = r"[0-9]{1,15}(?:e[0-9]{1,2})?"
_WISH = re.compile(rf"(?P<first>{_NUMBER})?(?P<span>-(?P<last>{_NUMBER})?(?::(?P<step>{_NUMBER}))?)?")

_FORM = "0,250,500 or 0-2000:100 (from, to, every) or -20 (the last twenty recorded)"


@dataclass(frozen=True, slots=True)
class Span:
    """The rounds first, first + step, … up to last; without a step all recorded ones, without a last to the end."""

    first: int
    last: int | None
    step: int | None


@dataclass(frozen=True, slots=True)
class Latest:
    """The last recorded rounds: `count` of them, or all there are."""

    count: int


Wish: TypeAlias = int | Span | Latest
"""Some rounds that are asked for: one, or several in one word."""


def wishes(rounds: Any) -> tuple[Wish, ...]:
    """Return what a user asks for.

    Args:
        rounds: a text as on the command line, or whole numbers.

    Raises:
        InputError: it is neither, or there is none.
    """
    if isinstance(rounds, str):
        return tuple(_wish(part.strip(), rounds) for part in rounds.split(","))
    found = sequence("rounds", rounds, "whole numbers, such as [0, 250], or a text, such as 0-2000:100")
    return tuple(whole("rounds", part, least=0) for part in found)


def _wish(part: str, whole: str) -> Wish:
    """Read `250`, `0-2000:100`, `0-2000`, `2000-` or `-20`."""
    match = _WISH.fullmatch(part)
    if match is not None:
        first, last, step = (_number(match[name]) for name in ("first", "last", "step"))
        if first is not None and match["span"] is None:
            return first
        if first is not None and step != 0 and (last is None or first <= last):
            return Span(first, last, step)
        if first is None and last and step is None:
            return Latest(last)
    raise InputError(f"rounds are written {_FORM}; got {whole}")


def _number(text: str | None) -> int | None:
    """Read a whole number; 1e3 is one."""
    if text is None:
        return None
    digits, _, exponent = text.partition("e")
    return int(digits + "0" * int(exponent or 0))


def chosen(asked: tuple[Wish, ...], recorded: Indices) -> tuple[Indices, Indices]:
    """Return the rounds that are asked for and in which places of a trajectory the nearest recorded ones stand.

    Args:
        asked: what a user asks for; the order is kept, and what is asked for twice comes twice.
        recorded: the recorded rounds, ascending, at least one, (n_frames,) int64.

    Returns:
        Rounds and places, each (n,) int64; of two recorded rounds that are as near, the place of the earlier.

    Raises:
        InputError: a round after the last, or a span in which none is recorded.
    """
    rounds = np.concatenate([_rounds(wish, recorded) for wish in asked])
    later = np.searchsorted(recorded, rounds)
    earlier = np.maximum(later - 1, 0)
    is_nearer = recorded[later] - rounds < rounds - recorded[earlier]
    return rounds, np.where(is_nearer | (rounds <= recorded[0]), later, earlier)


def _rounds(wish: Wish, recorded: Indices) -> Indices:
    """Return the rounds of one wish, (n,) int64."""
    end = int(recorded[-1])
    match wish:
        case int():
            _require(wish, end)
            return np.array([wish])
        case Latest(count):
            return recorded[-min(count, len(recorded)) :]
        case Span(first, last, step):
            last = end if last is None else last
            _require(max(first, last), end)
            within = recorded[np.searchsorted(recorded, first) : np.searchsorted(recorded, last, side="right")]
            if step is not None and (last - first) // step <= len(within):
                return np.arange(first, last + 1, step)
            if not len(within):
                raise InputError(f"no round from {first} to {last} is recorded")
            return within  # there are no more, however fine the steps


def _require(round_index: int, end: int) -> None:
    if round_index > end:
        raise InputError(f"there is no round {round_index}; it ends at round {end}")
