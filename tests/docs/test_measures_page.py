"""Every measure has its row on the page, with its unit, and the page names no other."""

from __future__ import annotations

import re
from pathlib import Path

from atomsim.measures.events import SENTENCES
from atomsim.scene.language.measures import COMPONENTS, QUANTITIES

PAGE = (Path(__file__).parents[2] / "docs" / "measures.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^### (.*?)\n(.*?)(?=^##)", PAGE, re.MULTILINE | re.DOTALL))


def rows(section: str) -> dict[str, tuple[str, str]]:
    """Return the measures that a section defines, each with its formula and its unit."""
    found = {}
    for names, formula, unit in re.findall(r"^\| (`.*?`) \| (.*) \| (\S+) \|$", SECTIONS[section], re.MULTILINE):
        found |= dict.fromkeys(re.findall(r"`(.*?)`", names), (formula, unit))
    return found


def test_every_measure_is_defined_where_it_belongs() -> None:
    of, between = rows("Of one selection"), rows("Between two selections")
    assert set(of) == {*COMPONENTS, *(name for name, quantity in QUANTITIES.items() if quantity.of)}
    assert set(between) == {name for name, quantity in QUANTITIES.items() if quantity.between}
    whole = {name for name, quantity in QUANTITIES.items() if not (quantity.of or quantity.between)}
    assert set(rows("Of everything")) == whole


def test_units_and_vectors_are_those_of_the_vocabulary() -> None:
    for section in SECTIONS:
        for name, (formula, unit) in rows(section).items():
            quantity = QUANTITIES.get(name, QUANTITIES["centroid"])
            assert unit == (quantity.unit or "none"), name
            assert ("a vector" in formula) == (quantity.is_vector and name not in COMPONENTS), name


def test_every_event_is_defined() -> None:
    table = PAGE.split("## Events")[1].split("\n- ")[0]
    assert re.findall(r"^\| ([a-z ]+) \| (?!it happens)", table, re.MULTILINE) == list(SENTENCES)
