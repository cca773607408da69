"""Expectations: what should happen in a run, as statements about measures over rounds that can be true or false."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from atomsim.scene.language.base import Declaration, Number, Round, refuse_all_but_one
from atomsim.scene.language.measures import MeasureSyntaxError, parse_measure
from atomsim.scene.language.selection import SelectionSyntaxError
from atomsim.scene.mistakes.wording import readable

BOUNDS = ("above", "below", "between")
CLAIMS = ("measure", "all", "any", "not", "that")
WHENS = ("at", "always", "eventually", "until")

END = "end"
"""The last round from which everything that is asked can still be seen."""


def _check_measure(value: str) -> str:
    try:
        measure = parse_measure(value)
    except (MeasureSyntaxError, SelectionSyntaxError) as error:
        raise PydanticCustomError("measure", "{why}", {"why": str(error)}) from None
    if len(measure.columns) > 1:
        why = f"`{readable(value)}` is a vector; say which component, such as `z of {readable(value)}`"
        raise PydanticCustomError("measure", "{why}", {"why": why})
    return str(measure)


MeasureText = Annotated[str, AfterValidator(_check_measure), WithJsonSchema({"type": "string", "title": "measure"})]
"""A measure that is one number, such as `height of ring`."""


def _check_span(value: tuple[float, float]) -> tuple[float, float]:
    if not value[0] < value[1]:
        raise PydanticCustomError("span", "needs [low, high] with low below high")
    return value


Span = Annotated[tuple[Number, Number], Field(strict=False, title="[low, high]"), AfterValidator(_check_span)]
"""Two numbers, the lower one first."""


def _as_window(value: Any) -> Any:
    """Let `true` stand for the whole of a run."""
    return (0, END) if value is True else value


def _check_window(value: tuple[int, int | str]) -> tuple[int, int | str]:
    first, last = value
    if isinstance(last, int) and last < first:
        raise PydanticCustomError("window", "needs [first round, last round] with the first not after the last")
    return value


Window = Annotated[
    tuple[Round, Round | Literal["end"]],
    Field(strict=False, title="true or [from, to]"),
    AfterValidator(_check_window),
    BeforeValidator(_as_window),
    WithJsonSchema(
        {
            "anyOf": [
                {"const": True},
                {
                    "type": "array",
                    "prefixItems": [
                        {"type": "integer", "minimum": 0},
                        {"anyOf": [{"type": "integer", "minimum": 0}, {"const": END}]},
                    ],
                    "minItems": 2,
                    "maxItems": 2,
                },
            ]
        }
    ),
]
"""Rounds from one to another, both included: `true` (all), `[100, 400]` or `[100, end]`."""


class Expectation(Declaration):
    """What should happen, about one measure or made of other expectations; each says when.

    Rounds count from the beginning of the run; inside another expectation, from the round that is looked at there.
    """

    measure: MeasureText | None = None
    """What is looked at, a number such as `height of ring`; with `above`, `below` or `between`."""
    above: Number | None = None
    """The measure is above this."""
    below: Number | None = None
    """The measure is below this."""
    between: Span | None = None
    """The measure is between these two."""
    all_: Annotated[tuple[Expectation, ...], Field(strict=False, min_length=1)] | None = Field(None, alias="all")
    """Each of these holds."""
    any_: Annotated[tuple[Expectation, ...], Field(strict=False, min_length=1)] | None = Field(None, alias="any")
    """At least one of these holds."""
    not_: Expectation | None = Field(None, alias="not")
    """This does not hold."""
    that: Expectation | None = None
    """This holds, when `at`, `always`, `eventually` or `until` say."""
    at: Round | None = None
    """It holds in this round."""
    always: Window | None = None
    """It holds in every one of these rounds: `true` for all, or `[from, to]`; `to` may be `end`."""
    eventually: Window | None = None
    """It holds in at least one of these rounds: `true` for all, or `[from, to]`; `to` may be `end`."""
    until: Expectation | None = None
    """It holds until this does, and this comes to hold before the run ends."""

    @model_validator(mode="after")
    def _check_parts(self) -> Expectation:
        refuse_all_but_one(self.said(CLAIMS), CLAIMS)
        bounds = self.said(BOUNDS)
        if self.measure is not None:
            refuse_all_but_one(bounds, BOUNDS)
        elif bounds:
            raise PydanticCustomError("bound", "`{bound}` needs a `measure`", {"bound": bounds[0]})
        if len(self.said(WHENS)) > 1:
            context = {"found": " and ".join(f"`{key}`" for key in self.said(WHENS))}
            raise PydanticCustomError("when", "say one of `at`, `always`, `eventually`, `until` (got {found})", context)
        return self

    def said(self, keys: tuple[str, ...]) -> list[str]:
        """Return which of some keys are written."""
        fields = {field.alias or name: name for name, field in type(self).model_fields.items()}
        return [key for key in keys if getattr(self, fields[key]) is not None]

    @property
    def parts(self) -> dict[str, Expectation]:
        """What it is made of, by where it is written: `all.0`, `not`, `until`."""
        listed = {f"{key}.{i}": part for key in ("all", "any") for i, part in enumerate(self._listed(key))}
        single = {"not": self.not_, "that": self.that, "until": self.until}
        return listed | {key: part for key, part in single.items() if part is not None}

    def _listed(self, key: str) -> tuple[Expectation, ...]:
        return (self.all_ if key == "all" else self.any_) or ()

    @property
    def measures(self) -> tuple[str, ...]:
        """The measures that it speaks of, each once, in order."""
        own = () if self.measure is None else (self.measure,)
        return tuple(dict.fromkeys([*own, *(text for part in self.parts.values() for text in part.measures)]))
