"""Pages of the docs as blocks that can be run, in order, in a folder; knows nothing of what the pages say.

What a fence of a page means:

    yaml      a file; its first line is its name: `# lift.yaml`
    console   commands after `$ `, then what they print; `…` stands for anything, no line at all for "does not matter"
    sh        commands alone, one a line; `make` is not run, but its target must exist
    python    a program, or, where it begins with `>>>`, a doctest; a page has one namespace
    text      none of these

Commands of a page share a folder, which holds a copy of `scenes/`, and begin where the last one ended: one that fails
must be followed by `$ echo $?`. A scene that no command names is run for a few rounds, so that nothing goes untried.
A picture `docs/figures/…` or `figures/…` is one that the page draws; `./docs/figures/…` is one of another page.
"""

from __future__ import annotations

import contextlib
import doctest
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import atomsim

ROOT = Path(__file__).parent.parent

PAGES = (
    ROOT / "README.md",
    ROOT / "ARCHITECTURE.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "CHANGELOG.md",
    *sorted((ROOT / "docs").glob("*.md")),
)
"""All pages, README first."""

LANGUAGES = ("yaml", "console", "sh", "python", "text")

ROUNDS = 20
"""How far a scene is run that no command runs."""

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_PICTURE = re.compile(r"!\[[^\]]*\]\((?:docs/)?figures/([^)]+)\)")


class PageError(Exception):
    """Something on a page is not so; the message begins with page and line."""


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block: where its text begins, its language, its text."""

    page: Path
    line: int
    language: str
    text: str

    def error(self, message: str) -> PageError:
        """Return an error that names the place."""
        return PageError(f"{self.page.relative_to(ROOT)}:{self.line}: {message}")


def blocks(page: Path) -> list[Block]:
    """Return the fenced blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    return [Block(page, text.count("\n", 0, match.start()) + 2, match[1], match[2]) for match in _FENCE.finditer(text)]


def pictures(page: Path) -> list[str]:
    """Return the names of the pictures that a page shows, in order."""
    return _PICTURE.findall(page.read_text(encoding="utf-8"))


def run_page(page: Path, folder: Path) -> None:
    """Run every block of a page.

    Args:
        page: the page.
        folder: an empty folder; afterwards it holds what the page made.

    Raises:
        PageError: a block fails or prints something else than it shows.
    """
    shutil.copytree(ROOT / "scenes", folder / "scenes")
    session = _Session(folder)
    found = blocks(page)
    for block in found:
        session.run(block)
    commands = " ".join(block.text for block in found if block.language in ("console", "sh", "python"))
    for block in found:
        if block.language == "yaml" and _file_name(block) not in commands:
            _try_scene(block, folder)


class _Session:
    """What lasts from block to block: the folder, the exit code of the last command, the names of the programs."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._exit_code = 0
        self._last = ""
        self._names: dict[str, Any] = {"__name__": "__main__"}
        self._environment = {
            "HOME": str(Path.home()),
            "PATH": os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"])),
            "COLUMNS": "120",
        }

    def run(self, block: Block) -> None:
        """Run one block."""
        match block.language:
            case "yaml":
                (self._folder / _file_name(block)).write_text(block.text, encoding="utf-8")
            case "console":
                for command, expected in _commands(block):
                    self._command(block, command, expected)
                self._require_success(block)
            case "sh":
                for command in block.text.splitlines():
                    self._command(block, command, None)
                    self._require_success(block)
            case "python":
                with contextlib.chdir(self._folder):
                    self._python(block)

    def _command(self, block: Block, command: str, expected: str | None) -> None:
        """Run one command and compare what it prints."""
        if command.startswith("make "):
            _require_target(block, command.removeprefix("make "))
            return
        if command != "echo $?":
            self._require_success(block)
        done = subprocess.run(
            ["bash", "-c", f"(exit {self._exit_code}); {command}"],
            cwd=self._folder,
            env=self._environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            encoding="utf-8",
            timeout=120,
        )
        self._exit_code = done.returncode
        self._last = f"`{command}` ended with exit code {done.returncode} and printed:\n{done.stdout}"
        if expected is not None and not _matches(expected, done.stdout):
            raise block.error(f"{self._last}\nbut the page shows:\n{expected}")

    def _require_success(self, block: Block) -> None:
        if self._exit_code:
            raise block.error(self._last)

    def _python(self, block: Block) -> None:
        """Run a program, or compare what a doctest says."""
        if not block.text.startswith(">>>"):
            exec(compile("\n" * (block.line - 1) + block.text, str(block.page), "exec"), self._names)
            return
        test = doctest.DocTestParser().get_doctest(block.text, self._names, block.page.name, None, block.line)
        report: list[str] = []
        doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=report.append, clear_globs=False)
        self._names.update(test.globs)
        if report:
            raise block.error("".join(report))


def _file_name(block: Block) -> str:
    """Return the name that the first line of a file gives it."""
    name = re.match(r"# ([\w-]+\.yaml)\b", block.text)
    if name is None:
        raise block.error("the first line of a scene is its name, as in `# lift.yaml`")
    return name[1]


def _commands(block: Block) -> Iterator[tuple[str, str | None]]:
    """Yield each command of a console block with the text shown below it."""
    for part in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
        command, _, shown = part.partition("\n")
        yield command, shown or None


def _matches(expected: str, printed: str) -> bool:
    """Tell whether a text is the expected one, in which `…` stands for anything."""
    pattern = re.escape(expected.rstrip())
    return re.fullmatch(pattern.replace("…", ".*?"), printed.rstrip(), re.DOTALL) is not None


def _require_target(block: Block, target: str) -> None:
    if not re.search(rf"^{target}:", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE):
        raise block.error(f"the Makefile has no target {target}")


def _try_scene(block: Block, folder: Path) -> None:
    """Run a scene for a few rounds."""
    try:
        model, state = atomsim.compile(atomsim.load(folder / _file_name(block)))
        for _ in atomsim.simulate(model, state, ROUNDS):
            pass
    except atomsim.AtomsimError as error:
        raise block.error(str(error)) from error
