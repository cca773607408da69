"""What is installed from a wheel works outside a checkout; the lock names what `pyproject.toml` asks for."""

from __future__ import annotations

import re
import sys
import tarfile
import tomllib
import zipfile
from email import message_from_bytes
from pathlib import Path

import pytest
from support.process import finish

ROOT = Path(__file__).parents[2]
LOCKS = ("run", "dev", "lowest")


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the wheel and the source archive of this checkout."""
    folder = tmp_path_factory.mktemp("dist")
    done = finish("build", "-d", folder, program=(sys.executable, "-m", "hatchling"), cwd=ROOT)
    assert done.returncode == 0, done
    return folder


def test_the_wheel_works_where_nothing_lies_beside_it(built: Path, tmp_path: Path) -> None:
    (wheel,) = built.glob("*.whl")
    installed = tmp_path / "installed"
    zipfile.ZipFile(wheel).extractall(installed)
    work = tmp_path / "work"
    work.mkdir()

    def atomsim(*arguments: str) -> str:
        done = finish(*arguments, cwd=work, PYTHONPATH=str(installed), HOME=str(tmp_path))
        assert (done.returncode, done.stderr) == (0, ""), done
        return done.stdout

    assert str(installed) in atomsim()
    assert "  rods " in atomsim("scenes")
    atomsim("new", "rods")
    assert str(installed) in (work / "rods.yaml").read_text().splitlines()[0]
    atomsim("run", "rods.yaml", "--rounds", "10", "--backend", "numpy")
    atomsim("render", "out.h5", "--size", "60x60")
    assert (work / "out.png").is_file()
    assert atomsim("schema") == (ROOT / "atomsim" / "scene" / "scene.schema.json").read_text(encoding="utf-8")


def test_the_page_of_a_package_index_has_no_links_that_break(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith("/METADATA")]
        page = str(message_from_bytes(archive.read(name)).get_payload())
    assert "pip install atomsim" in page
    assert re.findall(r"\]\((?!https?:)", page) == []


def test_the_source_archive_has_the_tests_and_not_our_ci(built: Path) -> None:
    (source,) = built.glob("*.tar.gz")
    with tarfile.open(source) as archive:
        tops = {Path(name).parts[1] for name in archive.getnames()}
    assert {"atomsim", "docs", "scenes", "tests", "requirements", "Makefile"} <= tops
    assert ".ci" not in tops


def locked(name: str) -> dict[str, str]:
    """Return the versions that a file of the lock names; of several, the first."""
    text = (ROOT / "requirements" / f"{name}.txt").read_text()
    return dict(reversed(re.findall(r"^([a-z0-9-]+)==(\S+)", text, re.MULTILINE)))


@pytest.mark.parametrize("name", LOCKS)
def test_a_lock_serves_from_any_mirror_and_knows_every_hash(name: str) -> None:
    text = (ROOT / "requirements" / f"{name}.txt").read_text()
    assert "://" not in text
    assert "index" not in text
    for entry in re.split(r"\n(?=\S)", text):
        assert re.match(r"[a-z0-9-]+==\S+( ; .*)? \\\n    --hash=sha256:", entry), entry


def test_the_lock_covers_what_the_project_asks_for() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]

    def names(requirements: list[str]) -> set[str]:
        return {re.split(r"[^A-Za-z0-9-]", line)[0].lower() for line in requirements}

    run, dev, lowest = (locked(name) for name in LOCKS)
    assert names(project["dependencies"]) <= run.keys()
    assert names([*project["dependencies"], *project["optional-dependencies"]["dev"]]) <= dev.keys() & lowest.keys()
    assert {name: version for name, version in dev.items() if name in run} == run
    for line in project["dependencies"]:
        name, bound = line.split(">=")
        assert lowest[name] == bound, "run: make lock"
