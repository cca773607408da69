"""The time step that a scene without one is advised to begin with."""

from __future__ import annotations

import re

import pytest

from atomsim.compiler import compile_scene
from atomsim.errors import SceneError
from atomsim.findings.before.diagnose import examine
from atomsim.scene import LoadedScene
from atomsim.scene.loader import loads
from atomsim.tasks.begin import with_time_step

ROD = """\
atomsim: 1
rounds: 100
groups:
  rod: {shape: string, count: COUNT, step: [0.25, 0, 0], velocity: [SPEED, 0, 0]}
bonds:
  rod: {within: rod, rule: all-pairs}
collisions:
  own: {within: rod, min_gap: 8}
"""

ALONE = "τ, by which velocities move positions in each round [time]; begin with `time_step: 0.02`"


def advice(text: str) -> list[str]:
    """Return what is said of a scene that says no time step, beginning with each path."""

    def load_with(settings: tuple[str, ...]) -> LoadedScene:
        return loads(text, "a.yaml", settings)

    with pytest.raises(SceneError) as error:
        load_with(())
    return [f"{problem.path}: {problem.message}" for problem in with_time_step(error.value, load_with).problems]


def rod(count: int, speed: float = 0.1) -> str:
    return ROD.replace("COUNT", str(count)).replace("SPEED", str(speed))


@pytest.mark.parametrize(
    ("count", "speed", "limit", "begin"),
    [
        (70, 0.1, "0.0286", "0.01"),  # λmax = 140
        (40, 0.1, "0.05", "0.02"),
        (10, 0.1, "0.2", "0.05"),  # however soft it is
        (10, 40, "0.2", "0.01"),  # in which it moves by 0.5 at most
    ],
)
def test_half_of_what_the_stiffness_allows_or_less(count: int, speed: float, limit: str, begin: str) -> None:
    (said,) = advice(rod(count, speed))
    assert said == (
        "time_step: missing: τ, by which velocities move positions in each round [time]; "
        f"this scene is stable below {limit}: begin with `time_step: {begin}`"
    )
    loaded = loads(rod(count, speed) + f"time_step: {begin}\n", "a.yaml")
    assert examine(loaded, *compile_scene(loaded)).findings == ()


def test_missing_rounds_do_not_matter() -> None:
    step, rounds = advice(rod(70).replace("rounds: 100\n", ""))
    assert "begin with `time_step: 0.01`" in step
    assert rounds == "rounds: missing: Iteration rounds to run; begin with `rounds: 2000`"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("rule: all-pairs", "rule: all_pairs"),  # told as well, and what the scene is remains unknown
        ("within: rod, rule", "within: 'rod[70:]', rule"),  # does not compile
        ("bonds:\n  rod: {within: rod, rule: all-pairs}\n", ""),  # nothing sets a limit
    ],
)
def test_a_step_for_any_scene_where_that_of_the_scene_cannot_be_told(old: str, new: str) -> None:
    text = re.sub(r"collisions:\n.*", "", rod(70))
    assert old in text
    assert f"time_step: missing: {ALONE}" in advice(text.replace(old, new))


def test_other_mistakes_are_left_as_they_are() -> None:
    text = rod(70) + "time_step: 0\n"
    assert advice(text) == ["time_step: needs a number above 0 (got 0)"]
