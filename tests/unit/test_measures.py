"""The grammar of measures: what is read, how it is written again, and what is said of what cannot be read."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from atomsim.scene.language.measures import (
    COMPONENTS,
    QUANTITIES,
    Measure,
    MeasureSyntaxError,
    Quantity,
    parse_measure,
)
from atomsim.scene.language.selection import SelectionSyntaxError

EXPRESSIONS = ["ring", "all", "ring[-1]", "floor[0, :]", "a-b[2:8:3]", "finger.2", "bonds.1[0]", "环"]
SELECTIONS = st.lists(st.sampled_from(EXPRESSIONS), min_size=1, max_size=3)


@st.composite
def measures(draw: st.DrawFn) -> Measure:
    """Any measure that can be written."""
    quantity: Quantity = draw(st.sampled_from(list(QUANTITIES.values())))
    component = draw(st.sampled_from([None, *COMPONENTS])) if quantity.is_vector else None
    forms = ["whole"] if quantity.of or not quantity.between else []
    forms += ["of"] if quantity.of else []
    forms += ["between"] if quantity.between else []
    forms += ["rule"] if quantity.rules else []
    form = draw(st.sampled_from(forms))
    if form == "rule":
        return Measure(quantity.name, component, rule=f"{quantity.rules}.left-1")
    n_selections = ["whole", "of", "between"].index(form)
    return Measure(quantity.name, component, tuple(tuple(draw(SELECTIONS)) for _ in range(n_selections)))


@given(measures())
def test_what_is_written_is_read_as_the_same(measure: Measure) -> None:
    assert parse_measure(str(measure)) == measure


@pytest.mark.parametrize(
    ("text", "usual"),
    [
        ("height of ring", "height of ring"),
        ("  Height   OF\n ring ", "height of ring"),
        ("kinetic_energy of ring", "kinetic energy of ring"),
        ("x of ring", "x of ring"),
        ("x of centroid of ring", "x of ring"),
        ("z", "z"),
        ("y of momentum", "y of momentum"),
        ("distance between and and of", "distance between and and of"),
        ("speed of [left,right[ 3 ]]", "speed of [left, right[3]]"),
        ("speed of [left]", "speed of left"),
        ("contacts of collisions.bounce", "contacts of collisions.bounce"),
        ("max strain of bonds.re\u0301ng", "max strain of bonds.réng"),
        ("height of re\u0301ng.2[ 0 ]", "height of réng.2[0]"),
        ("max strain of bonds.2", "max strain of bonds.2"),
    ],
)
def test_spellings(text: str, usual: str) -> None:
    assert str(parse_measure(text)) == usual


def test_columns_are_measures_again() -> None:
    assert parse_measure("velocity of ring").columns == (
        "x of velocity of ring",
        "y of velocity of ring",
        "z of velocity of ring",
    )
    assert parse_measure("centroid of ring").columns == ("x of ring", "y of ring", "z of ring")
    assert parse_measure("z of ring").columns == ("z of ring",)
    assert parse_measure("gap between a and b").columns == ("gap between a and b",)


def test_a_group_that_is_called_as_a_measure_can_be_named() -> None:
    assert parse_measure("x of centroid of velocity") == Measure("centroid", "x", (("velocity",),))
    assert parse_measure("height of height") == Measure("height", None, (("height",),))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("hight of ring", "there is no measure `hight`; did you mean `height`?"),
        ("x of velocty of ring", "there is no measure `velocty`; did you mean `velocity`?"),
        ("rotation of ring", "there is no measure `rotation`; did you mean `turning`?"),
        ("strain of ring", "did you mean `max strain`, `min strain` or `mean strain`?"),
        ("centre of mass of ring", "there is no measure `centre`; did you mean `centroid`?"),
        ("ring", "there is no measure `ring`; the measures are centroid, height"),
        ("", 'there is no measure `""`; the measures are'),
        ("of ring", 'there is no measure `""`; the measures are'),
        ("height of", "height is measured as `height of A`"),
        ("height between a and b", "height is measured as `height of A`"),
        ("height ring", "`height ring` is no measure; write `height of A`"),
        ("distance from a to b", "`distance from a to b` is no measure; write `distance between A and B`"),
        ("gap", "gap is measured as `gap between A and B`"),
        ("gap of a", "gap is measured as `gap between A and B`"),
        ("gap between a", "gap is measured as `gap between A and B`"),
        ("gap between a and b and c", "gap is measured as `gap between A and B`"),
        ("energy of ring", "energy is measured as `energy`"),
        ("x of height of ring", "height is one number and has no x"),
        ("x between a and b", "name what `x` is of, as in `x of relative velocity …`"),
        ("height of bonds.ring", "height is not measured of bonds; write `height of A`"),
        (
            "contacts of bonds.ring",
            "contacts is not measured of bonds; write `contacts of A`, `contacts of collisions.NAME`",
        ),
    ],
)
def test_what_cannot_be_read_is_said_with_what_could(text: str, message: str) -> None:
    with pytest.raises(MeasureSyntaxError) as error:
        parse_measure(text)
    assert message in str(error.value)


@pytest.mark.parametrize("text", ["height of ring 3", "height of ring[", "gap between a and b[1.5]", "speed of []"])
def test_what_is_no_selection_is_said_as_in_a_scene(text: str) -> None:
    with pytest.raises(SelectionSyntaxError):
        parse_measure(text)


@given(st.text())
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        measure = parse_measure(text)
    except (MeasureSyntaxError, SelectionSyntaxError):
        return
    assert parse_measure(str(measure)) == measure
