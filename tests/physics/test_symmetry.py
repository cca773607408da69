"""Mirror images run as mirror images to the last bit; the order of groups matters only where sums change order."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.running import after, atoms_at, compiled, digest_of, paper_scene

from atomsim.compiler import compile_scene
from atomsim.core.digest import state_digest
from atomsim.core.model import Floats, Model, State
from atomsim.core.observables import Observer
from atomsim.scene import LoadedScene

MIRRORS = [(-1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, -1.0), (-1.0, -1.0, -1.0)]


def mirrored(state: State, mirror: tuple[float, float, float]) -> State:
    return State(state.round_index, state.position * mirror, state.velocity * mirror)


@pytest.mark.parametrize("mirror", MIRRORS)
@pytest.mark.parametrize("name", ["rods", "threads"])
def test_mirrored_strings_run_as_mirror_images(name: str, mirror: tuple[float, float, float]) -> None:
    """No law knows left from right, and IEEE arithmetic is symmetric in the sign: 300 rounds, contacts among them."""
    model, state = compile_scene(LoadedScene(paper_scene(name)))
    image = after(model, mirrored(state, mirror), 300)
    assert digest_of(mirrored(image, mirror)) == digest_of(after(model, state, 300))


@pytest.mark.parametrize("mirror", MIRRORS)
def test_mirrored_forces_run_as_mirror_images(mirror: tuple[float, float, float]) -> None:
    """A scene written down mirrored, with every force from outside; an axis is mirrored as axes are."""
    straight, image = compiled(**motley((1.0, 1.0, 1.0))), compiled(**motley(mirror))
    assert Observer(straight[0]).observe(straight[1]).contacts > 0
    for n_rounds in (0, 1, 30, 100):
        expected = digest_of(after(*straight, n_rounds))
        assert digest_of(mirrored(after(*image, n_rounds), mirror)) == expected
    unlike = compiled(**motley((1.0, 1.0, 1.0)), jitter={"amplitude": 1e-12})
    assert digest_of(after(*unlike, 100)) != digest_of(after(*straight, 100))


def motley(mirror: tuple[float, float, float]) -> dict[str, Any]:
    """Write a scene with every kind of force, seen in a mirror."""

    def seen(*vector: float) -> list[float]:
        return [sign * part for sign, part in zip(mirror, vector, strict=True)]

    def seen_axis(*axis: float) -> list[float]:
        handedness = mirror[0] * mirror[1] * mirror[2]
        return [handedness * part for part in seen(*axis)]

    return {
        "groups": {
            "rod": {"shape": "string", "count": 7, "step": seen(0.9, 0.2, -0.1), "centre": seen(0.2, 0.1, 0.3)},
            "ground": {
                "shape": "plane",
                "counts": [4, 3],
                "step_x": seen(1.4, 0.1, 0),
                "step_y": seen(0, 0.1, 1.5),
                "centre": seen(0.1, -1.4, 0),
            },
            "ball": atoms_at(tuple(seen(1, 2.1, 0.3)), velocity=seen(0.1, -0.9, 0.1)),
        },
        "bonds": {
            "rod": {"within": "rod", "rule": "neighbour", "reach": 2},
            "ground": {"within": "ground", "rule": "distance-threshold", "threshold": 2, "metric": "grid"},
        },
        "collisions": {"contact": {"among": ["rod", "ground", "ball"]}},
        "forces": {
            "air": {"kind": "damping", "coefficient": 0.01},
            "weight": {"kind": "gravity", "acts_on": ["rod", "ball"], "impulse": seen(0.001, -0.01, 0.002)},
            "kick": {"kind": "push", "acts_on": "rod[0]", "impulse": seen(0.1, 0.2, -0.1), "until_round": 5},
            "shake": {"kind": "oscillate", "acts_on": "ball", "impulse": seen(0.01, 0, 0.02), "period": 9},
            "turn": {"kind": "torque", "acts_on": "rod", "axis": seen_axis(0.1, 1, 0.2), "magnitude": 0.05},
            "leash": {"kind": "tether", "acts_on": "ball", "target": seen(2, 2, 2), "rest": 1.5},
            "rest": {"kind": "hold", "acts_on": "ground[0, :]"},
        },
    }


def test_x_and_y_may_be_exchanged_but_not_y_and_z() -> None:
    """d² is (dx·dx + dy·dy) + dz·dz: exchanging the first two terms changes no bit, the last two round differently."""
    model, state = compile_scene(LoadedScene(paper_scene("rods")))
    expected = after(model, state, 300)

    def exchanged(state: State, order: list[int]) -> State:
        return State(state.round_index, state.position[:, order], state.velocity[:, order])

    image = exchanged(after(model, exchanged(state, [1, 0, 2]), 300), [1, 0, 2])
    assert digest_of(image) == digest_of(expected)
    image = exchanged(after(model, exchanged(state, [0, 2, 1]), 300), [0, 2, 1])
    assert digest_of(image) != digest_of(expected)
    assert np.abs(image.position - expected.position).max() < 1e-9


def by_group(model: Model, state: State) -> dict[str, tuple[Floats, Floats]]:
    """Return position and velocity of every group."""
    spans = {group.name: slice(group.start, group.stop) for group in model.groups}
    return {name: (state.position[span], state.velocity[span]) for name, span in spans.items()}


def reordered(data: dict[str, Any], names: list[str]) -> dict[str, Any]:
    return {**data, "groups": {name: data["groups"][name] for name in names}}


def test_order_of_groups_never_shows_where_partners_share_a_group() -> None:
    """In every table here each atom has its partners in one group, so no sum changes its order: the same bits."""
    data = motley((1.0, 1.0, 1.0))
    data["collisions"] = {
        "rod": {"between": ["rod", "ground"]},
        "ball": {"between": ["ball", "ground"]},
        "both": {"between": ["rod", "ball"]},
    }
    one, other = compiled(**data), compiled(**reordered(data, ["ball", "ground", "rod"]))
    expected, found = (by_group(model, after(model, state, 200)) for model, state in (one, other))
    for name, arrays in expected.items():
        assert state_digest(*found[name]) == state_digest(*arrays), name


def test_order_of_groups_rounds_where_partners_are_in_several() -> None:
    """Here the middle atom adds its partners up in the order of the groups: the same but for rounding."""
    data: dict[str, Any] = {
        "groups": {
            "left": atoms_at((-1.3, 0.1, 0.2), (-1.1, 0.7, -0.9)),
            "middle": atoms_at((0, 0, 0.1)),
            "right": atoms_at((1.2, 0.3, 0), (0.8, -0.9, 0.4)),
        },
        "bonds": {"web": {"within": "all", "rule": "all-pairs", "rest": 1.5}},
    }
    one, other = compiled(**data), compiled(**reordered(data, ["middle", "right", "left"]))
    expected, found = (by_group(model, after(model, state, 50)) for model, state in (one, other))
    differences = [np.abs(found[name][0] - position).max() for name, (position, _) in expected.items()]
    assert 0.0 < max(differences) < 1e-12
