"""The scenes at hand: listed, copied to begin with, and what `atomsim` alone says."""

from __future__ import annotations

from pathlib import Path

import pytest

import atomsim
from atomsim.shipped import shipped


def test_alone_it_says_where_to_begin(cli):
    said = cli()
    assert (said.code, said.err) == (0, "")
    for step in ("atomsim scenes", "atomsim new rods", "atomsim run rods.yaml", "atomsim render out.h5"):
        assert f"  {step} " in said.out
    docs = said.out.rstrip().rpartition("A tutorial: ")[2]
    assert Path(docs).is_file()


def test_the_first_steps_as_they_are_told(cli):
    assert cli("new", "rods").out == "rods.yaml\nnext: atomsim run rods.yaml\n"
    assert cli("run", "rods.yaml", "--rounds", "20", "--backend", "numpy").code == 0
    assert cli("render", "out.h5", "--size", "60x60").out == "out.png\n"


def test_every_scene_at_hand_is_listed_with_its_title(cli):
    said = cli("scenes")
    files = [*shipped("scenes").glob("*.yaml"), *shipped("scenes").glob("recipes/*.yaml")]
    assert said.code == 0
    assert len(files) >= 13
    for path in files:
        title = atomsim.load(path).scene.title
        assert title
        assert any(line.split() == [path.stem, *title.split()] for line in said.out.splitlines()), path


@pytest.mark.parametrize("path", sorted(shipped("scenes").rglob("*.yaml")), ids=lambda path: path.stem)
def test_a_copy_is_the_same_scene_and_knows_the_schema(cli, path):
    if path.parent.name not in ("scenes", "recipes"):
        pytest.skip("not listed")
    assert cli("new", path.stem, "-o", "mine.yaml").code == 0
    assert atomsim.load("mine.yaml").scene == atomsim.load(path).scene
    modeline = Path("mine.yaml").read_text(encoding="utf-8").splitlines()[0]
    schema = modeline.rpartition("$schema=file://")[2]
    assert Path(schema).is_file()


def test_what_a_scene_extends_is_copied_beside_it(cli):
    assert cli("new", "ring-soft").out == "ring-soft.yaml\nring.yaml\nnext: atomsim run ring-soft.yaml\n"
    assert cli("new", "ring-elastic").code == 0  # the ring.yaml that is there is the same to the letter


def test_a_file_that_exists_is_kept(cli):
    Path("ring.yaml").write_text("mine\n")
    said = cli("new", "ring-soft")
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith("ring.yaml exists already")
    assert not Path("ring-soft.yaml").exists()
    assert Path("ring.yaml").read_text() == "mine\n"
    assert cli("new", "ring-soft", "--force").code == 0
    assert Path("ring.yaml").read_text() != "mine\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["rung"], "there is no scene `rung` at hand; did you mean `ring`?\n"),
        (["rods", "-o", "no/rods.yaml"], "no/rods.yaml: the folder no does not exist\n"),
    ],
)
def test_what_cannot_be_copied(cli, arguments, message):
    said = cli("new", *arguments)
    assert (said.code, said.out, said.err) == (2, "", message)
