"""Puts measured tables into docs/speed.md, and their picture beside it; measures nothing.

Run it with `python -m benchmarks.page docs/speed.json`. Tables stand between `<!-- name -->` and `<!-- /name -->`; what
is around them is written by hand.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from benchmarks.machine import sentence
from benchmarks.plot import draw
from benchmarks.sections import SECTIONS, all_answers
from benchmarks.tables import answers_table
from benchmarks.timing import Results

DOCS = Path(__file__).parent.parent / "docs"
PAGE, NUMBERS, PICTURE = DOCS / "speed.md", DOCS / "speed.json", DOCS / "speed.png"


def main() -> None:
    """Bring the page and its picture up to the numbers of a file."""
    results = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), results), encoding="utf-8")
    draw(results, PICTURE)


def filled(page: str, results: Results) -> str:
    """Return the text of the page with these results in it; tables of sections that were not measured stay.

    Raises:
        ValueError: the page has no place for a table.
    """
    texts = {"machine": sentence(results["machine"]) + "\n", "answers": answers_table(all_answers(results)).markdown()}
    texts |= {name: section.markdown(results[name]) for name, section in SECTIONS.items() if name in results}
    for name, text in texts.items():
        page = _replaced(page, name, text)
    return page


def _replaced(page: str, name: str, text: str) -> str:
    before, opening, rest = page.partition(f"<!-- {name} -->\n")
    _, closing, after = rest.partition(f"<!-- /{name} -->")
    if not closing:
        raise ValueError(f"the page has no place for {name}")
    return before + opening + text + closing + after


if __name__ == "__main__":
    main()
