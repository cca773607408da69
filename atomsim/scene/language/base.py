"""The words that all declarations share: numbers, vectors, axes, names, colours; knows no declaration."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeGuard, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    WithJsonSchema,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from atomsim.scene.language.css_colors import CSS_COLORS
from atomsim.scene.language.names import LONGEST_NAME, NAME_PATTERN, is_name, normalised
from atomsim.scene.language.selection import SelectionSyntaxError, parse_selection


class Declaration(BaseModel):
    """Base of everything in a scene: frozen, no unknown keys, no silent conversion between types."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _null_is_absent(cls, value: Any) -> Any:
        """A key that is known and null counts as not written: that is how a scene deletes what it extends."""
        if not isinstance(value, dict):
            return value
        known = cls.fields_by_key()
        return {key: inner for key, inner in value.items() if inner is not None or key not in known}

    @classmethod
    def fields_by_key(cls) -> dict[str, FieldInfo]:
        """Return the fields by the keys under which a scene writes them: `from` is no name in Python."""
        return {field.alias or name: field for name, field in cls.model_fields.items()}


def require_one(declaration: Declaration, *keys: str) -> None:
    """Refuse a declaration that does not say exactly one of the keys."""
    refuse_all_but_one([key for key in keys if getattr(declaration, key) is not None], keys)


def refuse_all_but_one(given: list[str], keys: tuple[str, ...]) -> None:
    """Refuse what is not exactly one of the keys."""
    if len(given) != 1:
        names = ", ".join(f"`{key}`" for key in keys[:-1]) + f" or `{keys[-1]}`"
        found = " and ".join(f"`{key}`" for key in given) if given else "none"
        context = {"names": names, "found": found, "first": keys[0]}
        raise PydanticCustomError("one_of", "say exactly one of {names} (got {found})", context)


def refuse_together(is_wrong: bool, message: str) -> None:
    """Refuse keys that make no sense together."""
    if is_wrong:
        raise PydanticCustomError("together", message)


Number = Annotated[float, Field(allow_inf_nan=False)]
"""A finite number."""

Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]
"""A finite number above zero."""

NotNegative = Annotated[float, Field(allow_inf_nan=False, ge=0)]
"""A finite number, zero or more."""

LARGEST_WHOLE_NUMBER = 10**15
"""More than any scene needs, and exact in every number type that meets it (int64, float64, JSON)."""


def _as_whole(value: Any) -> Any:
    """Take 1e3 for the whole number it is, as JSON does."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


Count = Annotated[int, Field(ge=1, le=LARGEST_WHOLE_NUMBER), BeforeValidator(_as_whole)]
"""A whole number, one or more."""

Round = Annotated[int, Field(ge=0, le=LARGEST_WHOLE_NUMBER), BeforeValidator(_as_whole)]
"""An iteration round: a whole number, zero or more."""

Vector = Annotated[tuple[Number, Number, Number], Field(strict=False, title="[x, y, z]")]
"""Three finite numbers: x, y, z."""


def _check_direction(value: Vector) -> Vector:
    if not any(value):
        raise PydanticCustomError("zero_axis", "needs a direction, not [0, 0, 0]")
    return value


def _spell_out_axis(value: Any) -> Any:
    letters = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
    if isinstance(value, str):
        if value not in letters:
            raise PydanticCustomError("axis", "needs x, y, z or a direction [x, y, z]")
        return letters[value]
    return value


AxisLetter = Literal["x", "y", "z"]

Axis = Annotated[
    tuple[Number, Number, Number],
    Field(strict=False, title="x, y, z or [x, y, z]"),
    AfterValidator(_check_direction),
    BeforeValidator(_spell_out_axis),
    WithJsonSchema(
        {
            "anyOf": [
                {"enum": ["x", "y", "z"]},
                {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
            ],
        }
    ),
]
"""A direction: x, y, z or three numbers, of any length but zero."""


def _check_name(value: str) -> str:
    value = normalised(value)
    if not is_name(value):
        raise PydanticCustomError("name", "a name has letters, digits, _ and -, and does not begin with a digit or -")
    if len(value) > LONGEST_NAME:
        raise PydanticCustomError("name", "a name has at most {most} letters", {"most": LONGEST_NAME})
    if value == "all":
        raise PydanticCustomError("name", "`all` already means every atom; choose another name")
    if value.lower() in ("true", "false", "null"):
        raise PydanticCustomError("name", "`true`, `false` and `null` are values in YAML; choose another name")
    return value


Name = Annotated[str, AfterValidator(_check_name), WithJsonSchema({"type": "string", "pattern": NAME_PATTERN})]
"""A name that a person gives: letters of any script, digits, `_` and `-`."""


def drop_nulls(value: Any) -> Any:
    """Leave out what is null: it counts as not declared."""
    return {key: inner for key, inner in value.items() if inner is not None} if isinstance(value, dict) else value


def as_tuple(value: object) -> object:
    """Let one item stand for a list of it."""
    return tuple(value) if isinstance(value, (list, tuple)) else (value,)


class OneOrList:
    """Says of a list that one item alone will do."""


@dataclass(frozen=True)
class Begin:
    """Says of a key a value to begin with.

    The examples of a `Field` would do but for pydantic before 2.11.5: where two fields are merged, the default that one
    of them has anywhere comes with it. So no type here is made of two, and none gets a second where it is used.
    """

    value: Any


Declared = TypeVar("Declared")

Named = Annotated[dict[Name, Declared], BeforeValidator(drop_nulls)]
"""Declarations by name, in order; null counts as not declared."""


def _check_color(value: str) -> str:
    if value.lower() not in CSS_COLORS and not re.fullmatch(r"#(?:[0-9a-fA-F]{3}){1,2}", value):
        raise PydanticCustomError("color", "needs a CSS name such as steelblue, or '#rgb' or '#rrggbb' in quotes")
    return value


Color = Annotated[str, Field(title="color"), AfterValidator(_check_color)]
"""A CSS colour name such as `steelblue`, or `#rgb`, or `#rrggbb`."""


def _as_list(value: Any) -> Any:
    if isinstance(value, str):
        return (value,)
    if not isinstance(value, (list, tuple)) or not value:
        raise PydanticCustomError("selection", "needs a selection such as `ring`, `ring[0:10]` or a list of these")
    return value


def _check_selection(value: str) -> str:
    try:
        parse_selection(value)
    except SelectionSyntaxError as error:
        raise PydanticCustomError("selection_syntax", "{why}", {"why": str(error)}) from None
    return normalised(value)


_SELECTION_FORMS: list[dict[str, Any]] = [
    {"type": "string"},
    {"type": "array", "items": {"type": "string"}, "minItems": 1},
]

_SELECTION_SCHEMA = {"title": "selection", "anyOf": _SELECTION_FORMS}

SelectionText = Annotated[str, AfterValidator(_check_selection)]
"""One selection expression: `ring`, `ring[0:10]`, `floor[0, :]` or `all`."""

Colors = Annotated[dict[SelectionText, Color], BeforeValidator(drop_nulls)]
"""Colours by selection."""

Selection = Annotated[
    tuple[SelectionText, ...],
    Field(strict=False),
    BeforeValidator(_as_list),
    WithJsonSchema(_SELECTION_SCHEMA),
]
"""An expression that names atoms: `ring`, `ring[0:10]`, `floor[0, :]`, `all`, or a list of these (their union)."""

Pair = Annotated[tuple[Selection, Selection], Field(strict=False)]
"""Two selections."""


def _check_point(value: Any, otherwise: str) -> Any:
    """Return a point [x, y, z] as three floats."""
    is_point = isinstance(value, (list, tuple)) and len(value) == 3
    if not is_point or not all(is_finite_number(part) for part in value):
        raise PydanticCustomError("point", "needs a point [x, y, z] or {otherwise}", {"otherwise": otherwise})
    return tuple(float(part) for part in value)


def is_finite_number(value: Any) -> bool:
    """Tell whether a value is a number that computing can begin with."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < float("inf")


def _check_target(value: Any) -> Any:
    return value if value == "initial" else _check_point(value, "`initial`")


_POINT_SCHEMA = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}

Target = Annotated[
    Vector | Literal["initial"],
    Field(title="[x, y, z] or initial"),
    BeforeValidator(_check_target),
    WithJsonSchema({"anyOf": [{"const": "initial"}, _POINT_SCHEMA]}),
]
"""A fixed point, or `initial`: for each atom where it starts."""


def _check_towards(value: Any) -> Any:
    if isinstance(value, (list, tuple)) and not any(isinstance(part, str) for part in value):
        return _check_point(value, "a selection such as `palm`")
    return tuple(_check_selection(part) if isinstance(part, str) else part for part in _as_list(value))


def is_point(towards: Vector | tuple[str, ...] | None) -> TypeGuard[Vector]:
    """Tell whether a push is directed at a point, not at a selection."""
    return towards is not None and not any(isinstance(part, str) for part in towards)


Towards = Annotated[
    Vector | tuple[SelectionText, ...],
    Field(title="selection or [x, y, z]"),
    BeforeValidator(_check_towards),
    WithJsonSchema({"anyOf": [*_SELECTION_FORMS, _POINT_SCHEMA]}),
]
"""What a push is directed at: a point, or the centroid of a selection."""


def _check_rest(value: Any) -> Any:
    if value == "initial":
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < float("inf"):
        raise PydanticCustomError("rest", "needs `initial` or a number, zero or more")
    return float(value)


Rest = Annotated[
    float | Literal["initial"],
    BeforeValidator(_check_rest),
    WithJsonSchema({"anyOf": [{"const": "initial"}, {"type": "number", "minimum": 0}]}),
]
"""A desired distance: `initial` (the distance at the start) or a number."""
