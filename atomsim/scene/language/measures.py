"""The vocabulary and the grammar of measures, text to plain parts; knows no groups, no atoms and no numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from atomsim.scene.language.names import is_name, normalised
from atomsim.scene.language.selection import parse_selection
from atomsim.scene.mistakes.wording import either, readable, suggestion

Component: TypeAlias = Literal["x", "y", "z"]

QuantityName: TypeAlias = Literal[
    "centroid",
    "height",
    "lowest",
    "highest",
    "extent",
    "inner radius",
    "outer radius",
    "velocity",
    "speed",
    "fastest",
    "turning",
    "tilt",
    "deformation",
    "max strain",
    "min strain",
    "mean strain",
    "contacts",
    "kinetic energy",
    "momentum",
    "angular momentum",
    "energy",
    "bond energy",
    "contact energy",
    "distance",
    "gap",
    "overlap",
    "relative velocity",
    "closing speed",
    "winding",
    "crossings",
]

COMPONENTS: tuple[Component, ...] = ("x", "y", "z")

LENGTH, SPEED, DEGREES, COUNT, RATIO = "length", "length/time", "degrees", "", ""
ENERGY, MOMENTUM, SPIN = "mass·length²/time²", "mass·length/time", "mass·length²/time"


@dataclass(frozen=True, slots=True)
class Quantity:
    """What can be measured, and of what.

    Attributes:
        name: as it is written.
        unit: in the reduced units of the model; empty for a pure number.
        is_vector: whether it has components x, y and z.
        of: whether it is measured of one selection.
        between: whether it is measured between two selections.
        rules: the section whose declarations it is also measured of, as in `max strain of bonds.left`.
    """

    name: QuantityName
    unit: str
    is_vector: bool = False
    of: bool = True
    between: bool = False
    rules: Literal["bonds", "collisions"] | None = None


QUANTITIES: dict[str, Quantity] = {
    quantity.name: quantity
    for quantity in (
        Quantity("centroid", LENGTH, is_vector=True),
        Quantity("height", LENGTH),
        Quantity("lowest", LENGTH),
        Quantity("highest", LENGTH),
        Quantity("extent", LENGTH, is_vector=True),
        Quantity("inner radius", LENGTH),
        Quantity("outer radius", LENGTH),
        Quantity("velocity", SPEED, is_vector=True),
        Quantity("speed", SPEED),
        Quantity("fastest", SPEED),
        Quantity("turning", DEGREES, is_vector=True),
        Quantity("tilt", DEGREES),
        Quantity("deformation", LENGTH),
        Quantity("max strain", RATIO, rules="bonds"),
        Quantity("min strain", RATIO, rules="bonds"),
        Quantity("mean strain", RATIO, rules="bonds"),
        Quantity("contacts", COUNT, between=True, rules="collisions"),
        Quantity("kinetic energy", ENERGY),
        Quantity("momentum", MOMENTUM, is_vector=True),
        Quantity("angular momentum", SPIN, is_vector=True),
        Quantity("energy", ENERGY, of=False),
        Quantity("bond energy", ENERGY, of=False),
        Quantity("contact energy", ENERGY, of=False),
        Quantity("distance", LENGTH, of=False, between=True),
        Quantity("gap", LENGTH, of=False, between=True),
        Quantity("overlap", LENGTH, of=False, between=True),
        Quantity("relative velocity", SPEED, is_vector=True, of=False, between=True),
        Quantity("closing speed", SPEED, of=False, between=True),
        Quantity("winding", DEGREES, of=False, between=True),
        Quantity("crossings", COUNT, of=False, between=True),
    )
}
"""Everything that can be measured, by name; docs/measures.md defines each."""

_SYNONYMS: dict[str, tuple[QuantityName, ...]] = {
    "position": ("centroid",),
    "place": ("centroid",),
    "centre": ("centroid",),
    "center": ("centroid",),
    "altitude": ("height",),
    "elevation": ("height",),
    "bottom": ("lowest",),
    "top": ("highest",),
    "size": ("extent",),
    "width": ("extent",),
    "length": ("extent",),
    "bounding box": ("extent",),
    "radius": ("inner radius", "outer radius"),
    "top speed": ("fastest",),
    "max speed": ("fastest",),
    "rotation": ("turning",),
    "turning angle": ("turning",),
    "angle": ("turning", "tilt"),
    "orientation": ("turning", "tilt"),
    "lean": ("tilt",),
    "strain": ("max strain", "min strain", "mean strain"),
    "stretch": ("max strain", "min strain", "mean strain"),
    "tension": ("max strain",),
    "collisions": ("contacts",),
    "touching": ("contacts",),
    "potential energy": ("bond energy", "contact energy"),
    "total energy": ("energy",),
    "separation": ("gap", "distance"),
    "clearance": ("gap",),
    "depth": ("overlap",),
    "penetration": ("overlap",),
    "relative speed": ("closing speed", "relative velocity"),
    "approach": ("closing speed",),
}
"""What people write who mean one of ours."""

_CLAUSE = re.compile(r"\s*(.*?)(?:(?:\s+|^)(of|between)(?:\s+(.*?))?)?\s*", re.DOTALL | re.IGNORECASE)
_AND = re.compile(r"\s+and\s+", re.IGNORECASE)
_RULE = re.compile(r"(bonds|collisions)\.(\S+)")
_LIST = re.compile(r"\[(.*)\]", re.DOTALL)
_BETWEEN_ITEMS = re.compile(r",(?![^\[\]]*\])")


class MeasureSyntaxError(ValueError):
    """A measure that cannot be read; the message says how it should look."""


@dataclass(frozen=True, slots=True)
class Measure:
    """One parsed measure.

    Attributes:
        quantity: a name in `QUANTITIES`.
        component: which component of a vector; None for all three, or for what is one number.
        selections: what it is measured of: none (all atoms), one or two, each a tuple of expressions (their union).
        rule: the declaration it is measured of in place of a selection, as `bonds.left`.
    """

    quantity: QuantityName
    component: Component | None = None
    selections: tuple[tuple[str, ...], ...] = ()
    rule: str | None = None

    @property
    def unit(self) -> str:
        """The unit, empty for a pure number."""
        return QUANTITIES[self.quantity].unit

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of its numbers: its own, or that of each component."""
        if self.component is not None or not QUANTITIES[self.quantity].is_vector:
            return (str(self),)
        return tuple(str(Measure(self.quantity, letter, self.selections, self.rule)) for letter in COMPONENTS)

    def __str__(self) -> str:
        """The measure as one writes it; reading that gives the measure again."""
        words: str = self.quantity
        if self.component is not None:
            is_place = self.quantity == "centroid"
            words = self.component if is_place else f"{self.component} of {self.quantity}"
        if self.rule is not None:
            return f"{words} of {self.rule}"
        if not self.selections:
            return words
        link = "of" if len(self.selections) == 1 else "between"
        return f"{words} {link} {' and '.join(map(_written, self.selections))}"


def parse_measure(text: str) -> Measure:
    """Read one measure.

    Args:
        text: `height of ring`, `x of ring`, `z of velocity of ring[0:10]`, `gap between ring and [floor, wall]`,
            `max strain of bonds.ring`, `energy`; without `of …`, what is measured of a selection is that of all.

    Returns:
        Its parts; `str` of them is the measure in its usual spelling.

    Raises:
        MeasureSyntaxError: the text is no measure.
        SelectionSyntaxError: what it is measured of is no selection.

    >>> parse_measure("x of velocity of ring[0:10]")
    Measure(quantity='velocity', component='x', selections=(('ring[0:10]',),), rule=None)
    >>> str(parse_measure("Gap  between ring and [floor, wall]"))
    'gap between ring and [floor, wall]'
    """
    words, link, rest = _clause(normalised(text))
    component = next((letter for letter in COMPONENTS if letter == words), None)
    if component is None:
        return _measure(_quantity(words, text), None, link, rest)
    if link == "between":
        raise MeasureSyntaxError(
            f"`{readable(text)}`: name what `{words}` is of, as in `{words} of relative velocity …`"
        )
    inner, inner_link, inner_rest = _clause(rest or "")
    if inner_link is None and inner not in QUANTITIES:
        return _measure(QUANTITIES["centroid"], component, link, rest)
    quantity = _quantity(inner, text)
    if not quantity.is_vector:
        raise MeasureSyntaxError(f"`{readable(text)}`: {quantity.name} is one number and has no {component}")
    return _measure(quantity, component, inner_link, inner_rest)


def _clause(text: str) -> tuple[str, str | None, str | None]:
    """Cut a text into the words before its first `of` or `between`, that word, and what follows."""
    match = _CLAUSE.fullmatch(text)
    assert match is not None  # it matches everything
    words, link, rest = match.groups()
    return " ".join(words.lower().replace("_", " ").split()), link and link.lower(), rest


def _quantity(words: str, text: str) -> Quantity:
    """Look a quantity up by its name."""
    if words in QUANTITIES:
        return QUANTITIES[words]
    close = suggestion(words, QUANTITIES)
    near = _SYNONYMS.get(words, () if close is None else (close,))
    begun = max((name for name in QUANTITIES if words.startswith(f"{name} ")), key=len, default=None)
    if begun is not None and not near:
        raise MeasureSyntaxError(f"`{readable(text)}` is no measure; write {_form(QUANTITIES[begun])}")
    remedy = f"did you mean {_either(near)}?" if near else f"the measures are {', '.join(QUANTITIES)}"
    raise MeasureSyntaxError(f"there is no measure `{readable(words)}`; {remedy}")


def _measure(quantity: Quantity, component: Component | None, link: str | None, rest: str | None) -> Measure:
    """Read what a quantity is measured of."""
    is_allowed = {None: quantity.of or not quantity.between, "of": quantity.of, "between": quantity.between}[link]
    if not is_allowed or (link is not None and rest is None):
        raise MeasureSyntaxError(f"{quantity.name} is measured as {_form(quantity)}")
    if rest is None:
        return Measure(quantity.name, component)
    if link == "between":
        sides = _AND.split(rest)
        if len(sides) != 2:
            raise MeasureSyntaxError(f"{quantity.name} is measured as {_form(quantity)}")
        return Measure(quantity.name, component, (_selection(sides[0]), _selection(sides[1])))
    rule = _RULE.fullmatch(rest)
    if rule is None or not is_name(rule[2]):
        return Measure(quantity.name, component, (_selection(rest),))
    if rule[1] != quantity.rules:
        raise MeasureSyntaxError(f"{quantity.name} is not measured of {rule[1]}; write {_form(quantity)}")
    return Measure(quantity.name, component, rule=rule[0])


def _selection(text: str) -> tuple[str, ...]:
    """Read one selection or a list of them, and write each in its usual spelling."""
    listed = _LIST.fullmatch(text)
    expressions = [text] if listed is None else _BETWEEN_ITEMS.split(listed[1])
    for expression in expressions:
        parse_selection(expression)
    return tuple("".join(normalised(expression).split()).replace(",", ", ") for expression in expressions)


def _written(selection: tuple[str, ...]) -> str:
    return selection[0] if len(selection) == 1 else f"[{', '.join(selection)}]"


def _form(quantity: Quantity) -> str:
    """Say how a quantity is written."""
    forms: list[str] = [quantity.name] if not (quantity.of or quantity.between) else []
    if quantity.of:
        forms.append(f"{quantity.name} of A")
    if quantity.rules is not None:
        forms.append(f"{quantity.name} of {quantity.rules}.NAME")
    if quantity.between:
        forms.append(f"{quantity.name} between A and B")
    return _either(forms)


def _either(words: Iterable[str]) -> str:
    return either([f"`{word}`" for word in words])
