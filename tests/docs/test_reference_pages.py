"""Generated pages are fresh and complete, links lead somewhere, and what pages name exists."""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import pytest
import typer
from make_reference import EXAMPLES, generated
from pages import PAGES, ROOT

import atomsim
from atomsim.cli.app import app
from atomsim.scene.declarations import sections
from atomsim.scene.field_docs import field_docs

WORDS = [word for section in sections().values() for word in section.words]

EXTRA_EXAMPLES = {
    "within",
    "between",
    "among",
    "except_bound",
    "from",
    "towards",
    "foundation",
    "copies",
    "rotate",
    "spin",
    "jitter",
    "render",
    "follow",
    "close_up",
    "selections",
    "expect",
    "extends",
    "silence",
}


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("path", generated(), ids=lambda path: path.name)
def test_generated_file_is_fresh(path: Path) -> None:
    assert path.read_text(encoding="utf-8") == generated()[path], f"{path.name} is stale; run: make reference"


@pytest.mark.parametrize("word", WORDS)
def test_every_shape_rule_and_kind_has_a_section_and_an_example(word: str) -> None:
    section = text_of("docs/scene-reference.md").split(f"### `{word}`\n")[1].split("\n##")[0]
    assert re.search(rf"(shape|rule|kind): {word}\b", section)


def test_every_field_is_in_the_reference() -> None:
    reference = text_of("docs/scene-reference.md")
    for fields in field_docs().values():
        for name, doc in fields.items():
            assert re.search(rf"^\| `{name}` \|.*{re.escape(doc.description)} \|$", reference, re.MULTILINE), name


def test_every_example_has_its_own_name_and_place() -> None:
    names = {path.stem for path in EXAMPLES.iterdir()}
    assert names == {*WORDS, *EXTRA_EXAMPLES}
    for name in names:
        assert (EXAMPLES / f"{name}.yaml").read_text(encoding="utf-8").startswith(f"# {name}.yaml")
        assert text_of("docs/scene-reference.md").count(f"# {name}.yaml") == 1


def commands(command: Any, name: str = "atomsim") -> Iterator[tuple[str, Any]]:
    inner = getattr(command, "commands", {})
    yield from () if inner else [(name, command)]
    for word, child in inner.items():
        yield from commands(child, f"{name} {word}")


@pytest.mark.parametrize(("name", "command"), list(commands(typer.main.get_command(app))))
def test_every_command_and_option_is_on_the_page(name: str, command: Any) -> None:
    section = text_of("docs/commands.md").split(f"## `{name}`\n")[1].split("\n## ")[0]
    for parameter in command.params:
        if parameter.param_type_name == "option" and parameter.name != "help":
            assert all(f"`{option}`" in section for option in parameter.opts)


@pytest.mark.parametrize("error", [atomsim.AtomsimError, atomsim.InputError, atomsim.BlowUpError])
def test_exit_codes_are_in_the_table(error: type[atomsim.AtomsimError]) -> None:
    assert re.search(rf"^\| {error.exit_code} \|", text_of("docs/commands.md"), re.MULTILINE)


def anchors(page: Path) -> set[str]:
    """Return what the headings of a page are called in links, as GitHub does it."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if target.startswith("https://"):
            continue
        name, _, anchor = target.partition("#")
        found = (page.parent / name) if name else page
        assert found.exists(), f"{page.name} links to {target}"
        assert not anchor or anchor in anchors(found), f"{page.name} links to {target}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_what_is_named_exists(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for path in re.findall(r"`((?:atomsim|docs|tests|scenes)/[\w./-]+)`", text):
        assert (ROOT / path).exists(), f"{page.name} names {path}"
    for name in re.findall(r"`(atomsim(?:\.\w+)+)`", text):
        module, _, attribute = name.rpartition(".")
        try:
            importlib.import_module(name)
        except ModuleNotFoundError:
            assert hasattr(importlib.import_module(module), attribute), f"{page.name} names {name}"


def test_every_page_can_be_reached_from_the_first() -> None:
    first = text_of("README.md")
    for page in PAGES[1:]:
        assert f"]({page.relative_to(ROOT)})" in first


def test_every_equation_names_who_computes_it() -> None:
    rows = re.findall(r"^\| .*\| (\S.*) \|$", text_of("docs/theory.md").split("## What follows")[0], re.MULTILINE)
    named = [row for row in rows if row not in ("---", "computed by")]
    assert len(named) > 15
    assert all(re.fullmatch(r"`atomsim\.core(\.\w+){2,}`", row) for row in named)


def type_of(dataset: h5py.Dataset) -> str:
    """Return the type of a dataset as the page writes it; all texts are of fixed length."""
    text = h5py.check_string_dtype(dataset.dtype)
    if text is None:
        return str(dataset.dtype)
    assert text.length is not None
    return {"ascii": "ASCII", "utf-8": "UTF-8"}[text.encoding]


def test_trajectory_page_names_every_dataset(tmp_path: Path) -> None:
    atomsim.run(atomsim.load(ROOT / "scenes" / "rods.yaml", ["rounds=1"]), tmp_path / "out.h5")
    shared = re.compile(r"(velocity|observables/\w+)/(step|time)$")
    found: set[str] = set()

    def visit(name: str, item: h5py.Dataset | h5py.Group) -> None:
        if isinstance(item, h5py.Dataset) and not shared.search(name):
            found.add(f"/{name}")

    rows = re.findall(r"^\| `(/[\w/]+)` \| ([^ ]+)", text_of("docs/trajectory-file.md"), re.MULTILINE)
    with h5py.File(tmp_path / "out.h5") as file:
        file.visititems(visit)
        assert [(path, type_of(file[path])) for path, _ in rows] == rows
    page = {path for path, _ in rows}
    assert found - {"/particles/trajectory/position/step", "/particles/trajectory/position/time"} <= page
    assert page <= found | {"/particles/trajectory/position/step", "/particles/trajectory/position/time"}
