"""The messages that docs/troubleshooting.md quotes are those of the code, and none of the code's is left out."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
GAP = "…"
SOURCES = sorted(path for path in (ROOT / "atomsim").rglob("*.py") if "css_colors" not in path.name)

RAISED = {
    "InputError", "RunError", "BlowUpError", "DamageError", "odd", "SelectionError", "RuleError", "MemoryError",
    "SelectionSyntaxError", "MeasureSyntaxError", "MeasureError", "PydanticCustomError", "Complaint", "Mistake",
    "Problem", "problem", "refused", "_refused", "_refuse", "_complain", "_unreadable", "refuse_together",
}  # fmt: skip
"""By these a message leaves the code."""

SHORTEST = 5
"""Letters from which on a fixed part of a message says something."""


def strings(node: ast.AST) -> Iterator[str]:
    """Yield the fixed parts of every text in a piece of code."""
    for child in ast.walk(node):
        if isinstance(child, ast.Constant) and isinstance(child.value, str):
            yield re.sub(r"\{[^{}]*\}", GAP, child.value).replace("{{", "{").replace("}}", "}")


def fixed_parts(message: str) -> list[str]:
    """Return what of a message on the page stands in the code word for word."""
    return [part.strip(" :)") for part in message.split(GAP) if part.strip(" :)")]


def quoted() -> list[str]:
    """Return the messages of the page: the code in the first column of its tables, and what else it quotes."""
    rows = [line.split(" | ")[0].removeprefix("| ") for line in PAGE.splitlines() if line.startswith("| `")]
    first = [row.strip().strip("`").strip() for row in rows]
    odd = re.search(r"the reason in brackets tells what is odd: (.*); or what", PAGE, re.IGNORECASE)
    assert odd is not None
    return [*first, *re.findall("`([^`]*)`", odd[1])]


@pytest.fixture(scope="module")
def code() -> str:
    """Every fixed text of the package."""
    return "\n".join(text for path in SOURCES for text in strings(ast.parse(path.read_text(encoding="utf-8"))))


def test_every_message_on_the_page_is_one_of_the_code(code: str) -> None:
    messages = quoted()
    assert len(messages) > 130
    assert [message for message in messages if not all(part in code for part in fixed_parts(message))] == []


def raised() -> Iterator[tuple[str, str]]:
    """Yield every place where a message leaves the code, and the fixed parts of the message."""
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            name = getattr(node.func, "id", getattr(node.func, "attr", None)) if isinstance(node, ast.Call) else None
            if isinstance(node, ast.Call) and name in RAISED:
                text = GAP.join(text for argument in node.args for text in strings(argument) if " " in text)
                if len(text.replace(GAP, "").strip(" :`")) >= SHORTEST:
                    yield f"{path.name}:{node.lineno}", text


def test_no_message_of_the_code_is_missing_on_the_page() -> None:
    messages = list(raised())
    assert len(messages) > 100
    known = [parts for message in quoted() if max(map(len, parts := fixed_parts(message))) >= SHORTEST]
    missing = [
        (place, text) for place, text in messages if not any(all(part in text for part in parts) for parts in known)
    ]
    assert missing == []


@pytest.mark.parametrize(
    "heading", ["show", "render", "measure", "plot", "compare", "verify", "recover", "run", "check", "golden"]
)
def test_every_command_has_its_part(heading: str) -> None:
    assert re.search(rf"^##.*{heading}", PAGE, re.MULTILINE)
