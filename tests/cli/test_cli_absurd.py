"""Scenes that ask for too much, in every way there is: an error in words, in bounded time and memory."""

from __future__ import annotations

import resource
import time
from pathlib import Path

import pytest
from support.process import finish

HEAD = "atomsim: 1\ntime_step: 0.01\nrounds: 100\n"
CROWD = "groups:\n  a: {shape: block, counts: [70, 70, 70], spacing: 0.01}\n"
PAIR = "groups:\n  a: {shape: string, count: 2, step: [3, 0, 0]}\n"
LARGEST_MEMORY = 2 << 30


def groups(shape: str) -> str:
    return f"groups:\n  a: {{{shape}}}\n"


REFUSED = {
    "count": (groups("shape: string, count: 1000000000000, step: [3, 0, 0]"), "1,000,000,000,000 atoms need"),
    "ring": (groups("shape: ring, count: 1000000000000, radius: 9"), "1,000,000,000,000 atoms need"),
    "plane": (groups("shape: plane, counts: [1000000, 1000000], step_x: [3, 0, 0], step_y: [0, 3, 0]"), "atoms need"),
    "block": (groups("shape: block, counts: [1000000000, 1000000000, 1000000000], spacing: 3"), "atoms need"),
    "spacing": (
        groups("shape: polygon, corners: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], spacing: 1e-300"),
        "3,000,000,000,000,000 atoms need",
    ),
    "all pairs": (CROWD + "bonds: {b: {within: a, rule: all-pairs}}", "58,824,328,500 bonds need about 5.9 TB"),
    "across": (CROWD + "bonds: {b: {between: [a, all], rule: all-pairs}}", "117,649,000,000 bonds need"),
    "reach": (CROWD + "bonds: {b: {within: a, rule: neighbour, reach: 1000000000000}}", "117,649,000,000 bonds need"),
    "many declarations": (
        groups("shape: string, count: 3000, step: [3, 0, 0]")
        + "bonds:\n"
        + "".join(f"  b{number}: {{within: a, rule: all-pairs}}\n" for number in range(2000)),
        "bonds, with those before, need about",
    ),
    "threshold": (CROWD + "bonds: {b: {within: a, rule: distance-threshold, threshold: 5}}", "binds too much: about"),
    "threshold across": (
        CROWD + "bonds: {b: {between: [a, all], rule: distance-threshold, threshold: 1e300}}",
        "pairs are near each other, too many for memory",
    ),
    "grid": (CROWD + "bonds: {b: {within: a, rule: distance-threshold, metric: grid, threshold: 1e9}}", "too many for"),
    "listed": (PAIR + "bonds: {b: {within: a, rule: pairs, pairs: [[0, 999999999999]]}}", "index 999999999999 is out"),
    "numbers": (groups("shape: block, counts: [9, 9, 9], spacing: 1e308"), "too large to compute with"),
    "nesting": ("groups: " + "[" * 100_000, "nested more than 32 deep"),
    "aliases": ("groups:\n  a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
        f"  {new}: &{new} [*{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}]\n"
        for old, new in zip("abcdefg", "bcdefgh", strict=True)
    ), "stands for more than 1,000,000 values"),
}  # fmt: skip


def checked(command: str, scene: str, folder: Path) -> tuple[int, str]:
    """Run a command on a scene under a limit of memory; return its exit code and messages."""
    (folder / "s.yaml").write_text(HEAD + scene)
    began = time.monotonic()
    done = finish(
        command,
        "s.yaml",
        cwd=folder,
        before=lambda: resource.setrlimit(resource.RLIMIT_AS, (LARGEST_MEMORY, LARGEST_MEMORY)),
        OPENBLAS_NUM_THREADS="1",
    )
    assert time.monotonic() - began < 60  # a second or two on a machine with nothing else to do
    assert "Traceback" not in done.stderr
    assert "Warning" not in done.stderr
    return done.returncode, done.stderr


@pytest.mark.parametrize("way", REFUSED)
def test_a_scene_that_asks_for_too_much(tmp_path, way):
    scene, message = REFUSED[way]
    code, text = checked("check", scene, tmp_path)
    assert (code, text.count("\n")) == (2, 1), text
    assert text.startswith("s.yaml:")
    assert message in text


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_crowd_that_collides(tmp_path, command):
    code, text = checked(command, CROWD + "collisions: {c: {within: a}}", tmp_path)
    assert code == 1
    assert text.startswith("collisions.c (s.yaml:6): about ")
    assert text.endswith(" pairs are near each other, too many for memory\n")


@pytest.mark.parametrize(
    "numbers",
    [
        {"rounds: 100": "rounds: 1000000000000000\nrecord_every: 1"},
        {"rounds: 100": "rounds: 1000000000\nrecord_every: 1", "count: 2": "count: 1000"},
    ],
)
def test_a_trajectory_larger_than_any_disk(tmp_path, numbers):
    scene = HEAD + PAIR
    for old, new in numbers.items():
        scene = scene.replace(old, new)
    (tmp_path / "s.yaml").write_text(scene)
    done = finish("run", "s.yaml", cwd=tmp_path)
    assert done.returncode == 1
    message = done.stderr.splitlines()[-1]
    assert message.startswith("out.h5: needs ")
    assert message.endswith(" are free; record fewer frames with a larger record_every")
    assert [path.name for path in tmp_path.iterdir()] == ["s.yaml"]


@pytest.mark.parametrize(
    "scene",
    [
        CROWD + "bonds: {b: {within: a, rule: distance-threshold, threshold: 1e-300}}",
        CROWD + "jitter: {amplitude: 1e-3, seed: 999999999999999}",
        CROWD + "forces:\n" + "".join(f"  f{i}: {{kind: damping, coefficient: 0.1}}\n" for i in range(1000)),
        "groups:\n"
        + "".join(f"  g{i}: {{shape: atoms, positions: [[{3 * i}, 0, 0]]}}\n" for i in range(1000))
        + f"collisions: {{c: {{among: [{', '.join(f'g{i}' for i in range(1000))}]}}}}",
    ],
    ids=["a tiny threshold", "jitter on many", "many forces on many", "among many groups"],
)
def test_what_is_only_much_is_done(tmp_path, scene):
    """What once took minutes or gigabytes, though it asks for little."""
    code, text = checked("check", scene, tmp_path)
    assert (code in (0, 2), "nothing is bound" in text) == (True, code == 2), text
