"""Every command, scene and program on a page runs and prints what the page shows; pictures are what it draws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from make_figures import FIGURES
from pages import LANGUAGES, PAGES, ROOT, PageError, blocks, pictures, run_page
from PIL import Image

LARGEST_PICTURE = 400_000

FURTHEST = 1.0
"""How far pictures may be apart, of 255 on average: letters are drawn a little differently from machine to machine."""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_page_runs_and_draws_its_pictures(page: Path, tmp_path: Path) -> None:
    run_page(page, tmp_path)
    for name in pictures(page):
        with Image.open(tmp_path / name) as drawn, Image.open(FIGURES / name) as kept:
            assert drawn.size == kept.size, f"{name} is stale; `make figures` draws it again"
            one, other = (np.asarray(picture.convert("RGB"), dtype=float) for picture in (drawn, kept))
        assert np.abs(one - other).mean() < FURTHEST, f"{name} is stale; `make figures` draws it again"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_page_has_only_fences_that_are_run_or_plain(page: Path) -> None:
    assert {block.language for block in blocks(page)} <= set(LANGUAGES)
    assert page.read_text(encoding="utf-8").count("```") == 2 * len(blocks(page))


def test_figures_are_small_and_all_shown() -> None:
    kept = {path.name for path in FIGURES.iterdir()}
    assert kept == {name for page in PAGES for name in pictures(page)}
    assert all((FIGURES / name).stat().st_size < LARGEST_PICTURE for name in kept)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("```console\n$ echo one\ntwo\n```\n", "docs/page.md:2: `echo one` ended with exit code 0 and printed:\none"),
        ("```console\n$ false\n```\n", "`false` ended with exit code 1"),
        ("```console\n$ false\n$ echo on\n```\n", "`false` ended with exit code 1"),
        ("```console\n$ (exit 3)\n$ echo $?\n2\n```\n", "printed:\n3"),
        ("```sh\nmake coffee\n```\n", "the Makefile has no target coffee"),
        ("```sh\nfalse\n```\n", "`false` ended with exit code 1"),
        ("```yaml\natomsim: 1\n```\n", "the first line of a scene is its name"),
        ("```yaml\n# a.yaml\natomsim: 2\n```\n", "a.yaml:2:1: atomsim: this scene needs a newer atomsim"),
        ("```python\n>>> 1 + 1\n3\n```\n", "Expected:\n    3\nGot:\n    2"),
    ],
)
def test_page_that_is_wrong_is_found_out(
    text: str, complaint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "scenes").mkdir()
    (tmp_path / "run").mkdir()
    (tmp_path / "Makefile").write_text((ROOT / "Makefile").read_text())
    monkeypatch.setattr("pages.ROOT", tmp_path)
    page = tmp_path / "docs" / "page.md"
    page.write_text(text, encoding="utf-8")
    with pytest.raises(PageError) as error:
        run_page(page, tmp_path / "run")
    assert complaint in str(error.value)


def test_page_that_is_right_shares_folder_and_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scenes").mkdir()
    (tmp_path / "run").mkdir()
    monkeypatch.setattr("pages.ROOT", tmp_path)
    page = tmp_path / "page.md"
    page.write_text(
        "```console\n$ echo hello > a.txt\n$ (exit 3)\n$ echo $?\n3\n$ cat a.txt\nh…o\n```\n"
        "```python\nfrom pathlib import Path\n\ntext = Path('a.txt').read_text()\n```\n"
        "```python\n>>> text\n'hello\\n'\n```\n",
        encoding="utf-8",
    )
    run_page(page, tmp_path / "run")
    assert (tmp_path / "run" / "a.txt").exists()
