"""The compiler and the stepper give the bits of the loop oracle: on the paper's scenes and on one with everything."""

from __future__ import annotations

import pytest
from support.everything import EVERYTHING
from support.oracle import World, build
from support.running import PAPER_SCENES, after, digest_of, paper_scene, scene_of

from atomsim.compiler import compile_scene
from atomsim.core.model import State
from atomsim.core.numpy_backend.stepper import NumpyStepper
from atomsim.core.observables import Observer
from atomsim.scene import LoadedScene
from atomsim.scene.declarations import sections

CONTACT_ROUNDS = {
    "rods": (190, 260),
    "rod-thread": (190, 260),
    "threads": (190, 260),
    "balls": (140, 240),
    "ring": (0, 60),
    "ring-elastic": (0, 60),
    "ring-soft": (0, 60),
}
"""Rounds of each paper scene in which atoms touch."""


def go_on(world: World, state: State) -> None:
    """Let the oracle go on from a state of the stepper."""
    world.position = [tuple(row) for row in state.position.tolist()]
    world.velocity = [tuple(row) for row in state.velocity.tolist()]
    world.round_index = state.round_index


@pytest.mark.parametrize("name", PAPER_SCENES)
def test_paper_scene_starts_as_in_the_oracle(name: str) -> None:
    scene = paper_scene(name)
    model, state = compile_scene(LoadedScene(scene))
    world = build(scene.model_dump())
    assert digest_of(state) == world.digest()
    world.advance(20)
    assert digest_of(after(model, state, 20)) == world.digest()


@pytest.mark.parametrize("name", PAPER_SCENES)
def test_paper_scene_in_contact_is_the_oracle_bit_for_bit(name: str) -> None:
    scene = paper_scene(name)
    start, stop = CONTACT_ROUNDS[name]
    model, state = compile_scene(LoadedScene(scene))
    world = build(scene.model_dump())
    observer = Observer(model)
    stepper = NumpyStepper(model, state)
    stepper.advance(start)
    go_on(world, stepper.state())
    contacts = 0
    for _ in range(start, stop, 5):
        stepper.advance(5)
        world.advance(5)
        assert digest_of(stepper.state()) == world.digest(), f"differs by round {world.round_index}"
        contacts += observer.observe(stepper.state()).contacts
    assert contacts > 0, "a window without contacts shows nothing about collisions"


def test_everything_at_once_is_the_oracle_bit_for_bit() -> None:
    scene = scene_of(**EVERYTHING)
    model, state = compile_scene(LoadedScene(scene))
    world = build(scene.model_dump())
    assert digest_of(state) == world.digest()
    stepper = NumpyStepper(model, state)
    for _ in range(40):
        stepper.advance(1)
        world.advance(1)
        assert digest_of(stepper.state()) == world.digest(), f"differs at round {world.round_index}"
    assert world.is_finite()


def test_everything_expands_to_the_pairs_of_the_oracle() -> None:
    scene = scene_of(**EVERYTHING)
    model, _ = compile_scene(LoadedScene(scene))
    world = build(scene.model_dump())
    for table, pairs in zip(model.bonds, world.bonds, strict=True):
        found = zip(table.first.tolist(), table.second.tolist(), table.rest_squared.tolist(), strict=True)
        assert list(found) == pairs, table.origin.name


@pytest.mark.parametrize("section", ["groups", "bonds", "forces"])
def test_everything_has_every_word(section: str) -> None:
    """So whatever a backend forgets is found where it is compared on all of it."""
    key = sections()[section].key
    assert {entry[key] for entry in EVERYTHING[section].values()} == set(sections()[section].words)


def test_every_declaration_of_everything_changes_the_run() -> None:
    whole = digest_of(after(*compile_scene(LoadedScene(scene_of(**EVERYTHING))), 40))
    for section in ("bonds", "collisions", "forces"):
        for name in EVERYTHING[section]:
            rest = {other: entry for other, entry in EVERYTHING[section].items() if other != name}
            without = scene_of(**{**EVERYTHING, section: rest})
            assert digest_of(after(*compile_scene(LoadedScene(without)), 40)) != whole, f"{section}.{name} is idle"


def test_oracle_notices_one_bit() -> None:
    scene = paper_scene("ring")
    _, state = compile_scene(LoadedScene(scene))
    world = build(scene.model_dump())
    x, y, z = world.position[7]
    world.position[7] = (x, y, z + 2.0**-50)
    assert digest_of(state) != world.digest()
