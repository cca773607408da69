"""Damaged and hostile trajectories through every command that reads one: one line and exit code 2, or the truth."""

from __future__ import annotations

import os
import random
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import pytest

from atomsim.compiler import compile_scene
from atomsim.core.digest import state_digest
from atomsim.core.simulate import simulate
from atomsim.scene import loads
from atomsim.trajectory import End, Header, Recorder, Trajectory, journal_path

IS_LONG = os.environ.get("ATOMSIM_LONG") == "1"
N_MUTATIONS = 1500 if IS_LONG else 25

SCENE = """\
atomsim: 1
time_step: 0.05
rounds: 30
groups:
  left: {shape: string, count: 4, step: [1.5, 0, 0], velocity: [0, 1, 0]}
  right: {shape: ring, count: 3, radius: 2, centre: [0, 5, 0]}
bonds:
  left: {within: left, rule: neighbour}
collisions:
  contact: {between: [left, right]}
"""

COMMANDS = {
    "show": ("show", "out.h5"),
    "show --scene": ("show", "out.h5", "--scene"),
    "render": ("render", "out.h5", "--size", "32x24", "--rounds", "0"),
    "compare": ("compare", "out.h5", "good.h5"),
    "verify": ("verify", "out.h5"),
    "recover": ("recover", "out.h5"),
    "resume": ("run", "--resume", "out.h5", "--rounds", "40", "-q", "--backend", "numpy"),
}


def record(path: Path, scene: str = SCENE, *, finish: bool = True, **changes: Any) -> Path:
    """Record a run of a scene, with other things in the header than the truth."""
    loaded = loads(SCENE)
    model, state = compile_scene(loaded)
    header = Header.of(
        model, group_color=["#000000"] * 2, scene_text=scene, scene_name="s.yaml", rounds=30, record_every=10
    )
    with Recorder.begin(path, replace(header, **changes)) as recorder:
        for frame in simulate(model, state, 30, 10):
            recorder.append(frame)
        if finish:
            recorder.finish(End("finished"))
    return path if finish else journal_path(path)


def mutated(data: bytes, dice: random.Random) -> bytes:
    """Cut a file short, flip bits, overwrite a range, or copy one range over another."""
    changed = bytearray(data)
    here, there, length = dice.randrange(len(data)), dice.randrange(len(data)), dice.choice([1, 4, 8, 64, 512])
    match dice.randrange(4):
        case 0:
            del changed[here:]
        case 1:
            for _ in range(dice.choice([1, 1, 2, 8, 64])):
                changed[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        case 2:
            changed[here : here + length] = dice.choice([dice.randbytes(length), bytes(length), b"\xff" * length])
        case 3:
            changed[here : here + length] = data[there : there + length]
    return bytes(changed)


@pytest.mark.timeout(7200)
@pytest.mark.parametrize("kind", ["finished", "journal"])
def test_damage_of_any_kind_through_every_command(cli, kind):
    good = record(Path("good.h5")).read_bytes()
    source = record(Path("out.h5"), finish=kind == "finished")
    data = source.read_bytes()
    dice = random.Random(1)
    codes: Counter[str] = Counter()
    for number in range(N_MUTATIONS):
        damaged = mutated(data, dice)
        for name, command in COMMANDS.items():
            for left in (Path("out.h5"), Path("out.h5.part"), Path("out.png")):
                left.unlink(missing_ok=True)
            source.write_bytes(damaged)
            began = time.monotonic()
            result = cli(*command)
            assert time.monotonic() - began < 60, (number, name)
            codes[f"{name}: {result.code}"] += 1
            _check(result, name, (number, name))
            if name in ("show", "verify", "compare", "render") or result.code == 2:
                assert source.read_bytes() == damaged, (number, name)
    assert Path("good.h5").read_bytes() == good
    print(dict(codes))
    assert codes["verify: 2"] > N_MUTATIONS // 10
    assert sum(count for name, count in codes.items() if name.endswith(": 0")) > N_MUTATIONS // 10


def _check(result: Any, name: str, where: Any) -> None:
    """A command on a damaged file is right, or says in one line why not; a journal may have lost its end."""
    assert result.code in (0, 1, 2), (where, result)
    if result.code == 2:
        assert result.out == "", where
        assert result.err.rstrip("\n").splitlines()[-1].startswith("out.h5"), (where, result.err)
    if result.code == 1:
        is_short = name == "compare" and "is only in the second" in result.out
        assert is_short or "holds no frame yet" in result.err, (where, result)


LIES: dict[str, tuple[dict[str, Any], str]] = {
    "no scene": (
        {"scene": "nothing"},
        "damaged, or not a trajectory of atomsim (the scene inside: s.yaml:1:1: a scene is a mapping of keys such as "
        '`groups:` (got "nothing"))',
    ),
    "a broken scene": (
        {"scene": SCENE.replace("count: 4", "count: [")},
        "damaged, or not a trajectory of atomsim (the scene inside: s.yaml:5:",
    ),
    "code for a scene": (
        {"scene": "!!python/object/apply:os.system ['touch owned']"},
        "damaged, or not a trajectory of atomsim (the scene inside: s.yaml:1:1: ",
    ),
    "a scene that extends another": (
        {"scene": "extends: scenes/rods.yaml"},
        "damaged, or not a trajectory of atomsim (the scene inside: s.yaml:1:1: extends: only a scene file can extend",
    ),
    "other atoms": (
        {"scene": SCENE.replace("count: 4", "count: 5")},
        "damaged, or made to mislead: the scene inside has other atoms than the frames",
    ),
    "a trillion atoms": (
        {"scene": SCENE.replace("count: 4", "count: 1000000000000")},
        "damaged, or made to mislead: the scene inside has other atoms than the frames",
    ),
    "other groups": (
        {"scene": SCENE.replace("count: 4", "count: 3").replace("shape: ring, count: 3", "shape: ring, count: 4")},
        "damaged, or made to mislead: the scene inside has other groups than the frames",
    ),
    "other names": (
        {"scene": SCENE.replace("left", "lift")},
        "damaged, or made to mislead: the scene inside has other groups than the frames",
    ),
    "other bonds": (
        {"scene": SCENE.replace("rule: neighbour", "rule: all-pairs")},
        "damaged, or made to mislead: the scene inside has other bonds than the frames",
    ),
    "another time step": (
        {"scene": SCENE.replace("0.05", "0.06")},
        "damaged, or made to mislead: the scene inside has other time steps than the frames",
    ),
    "other rounds to record": (
        {"scene": SCENE + "record_every: 7\n"},
        "damaged, or made to mislead: the scene inside has other rounds to record than the frames",
    ),
    "a color for atoms that are not there": (
        {"scene": SCENE + "render: {colors: {'left[9]': red}}\n"},
        "damaged, or not a trajectory of atomsim (the scene inside: ",
    ),
    "a scene that does not compile": (
        {"scene": SCENE.replace("within: left", 'within: "left[9]"')},
        "damaged, or not a trajectory of atomsim (the scene inside: s.yaml:8:10: bonds.left.within: `left[9]` is out",
    ),
}


DRAWN_ALL_THE_SAME = ("other bonds", "another time step", "other rounds to record", "a scene that does not compile")
"""Lies about what a picture does not show: nobody compiles a stranger's scene to draw it."""


@pytest.mark.parametrize("name", LIES)
def test_a_scene_inside_that_lies(cli, name):
    changes, message = LIES[name]
    record(Path("out.h5"), **changes)
    before = Path("out.h5").read_bytes()
    for command in ("verify", "resume", *(["render"] if name not in DRAWN_ALL_THE_SAME else [])):
        result = cli(*COMMANDS[command])
        assert (result.code, result.out) == (2, ""), command
        assert result.err.startswith(f"out.h5: {message}"), (command, result.err)
        assert result.err.count("\n") == 1
    assert cli("show", "out.h5").code == 0
    assert Path("out.h5").read_bytes() == before
    assert sorted(path.name for path in Path().iterdir()) == ["out.h5", "scenes"]


@pytest.mark.parametrize("name", DRAWN_ALL_THE_SAME)
def test_a_picture_believes_only_what_it_shows(cli, name, monkeypatch):
    def refuse(*_):
        raise AssertionError("compiled")

    record(Path("out.h5"), **LIES[name][0])
    monkeypatch.setattr("atomsim.compiler.compile._Compiler.compile", refuse)
    assert cli(*COMMANDS["render"]).code == 0


def test_a_frame_with_a_forged_digest_is_found_by_computing_it_again(cli):
    """Whoever changes a frame can name it by a new digest, but cannot make the scene give it."""
    record(Path("out.h5"))
    with Trajectory("out.h5") as honest:
        frames, header = list(honest), honest.header
    forged = frames[2].position.copy()
    forged[5, 1] += 1e-12
    digest = state_digest(forged, frames[2].velocity)
    frames[2] = replace(frames[2], state=replace(frames[2].state, position=forged), digest=digest)
    Path("out.h5").unlink()
    with Recorder.begin("out.h5", header) as recorder:
        for frame in frames:
            recorder.append(frame)
        recorder.finish(End("finished"))
    assert cli("show", "out.h5").code == 0
    with Trajectory("out.h5") as trajectory:
        trajectory.verify()
    result = cli("verify", "out.h5")
    assert (result.code, result.err) == (1, "")
    assert result.out == (
        "different: round 20: position of 1 of 7 atoms differs, first right[1] (atom 5), "
        "most right[1] (atom 5) by 1e-12 (first: the file; second: computed now)\n"
    )


@pytest.mark.parametrize(
    ("rounds", "first"),
    [((0, 10, 30), "round 20 is only in the second"), ((0, 10, 15, 20, 30), "round 15 is only in the first")],
)
def test_frames_left_out_or_put_in_are_found(cli, rounds, first):
    loaded = loads(SCENE)
    model, state = compile_scene(loaded)
    header = Header.of(
        model, group_color=["#000000"] * 2, scene_text=SCENE, scene_name="s.yaml", rounds=30, record_every=10
    )
    with Recorder.begin("out.h5", header) as recorder:
        for frame in simulate(model, state, 30, 5):
            if frame.round_index in rounds:
                recorder.append(frame)
        recorder.finish(End("finished"))
    result = cli("verify", "out.h5")
    assert result.code == 1
    assert result.out == f"different: {first} (first: the file; second: computed now)\n"


def test_a_tampered_number_is_found_by_every_reader(cli):
    record(Path("out.h5"))
    with h5py.File("out.h5", "r+") as file:
        file["particles/trajectory/velocity/value"][1, 2, 0] += 1e-9
    for name in ("verify", "compare"):
        result = cli(*(COMMANDS[name] if name == "verify" else ("compare", "out.h5", "out.h5")))
        assert (result.code, result.out) == (2, "")
        assert result.err == "out.h5: damaged: the state at round 10 does not match its digest\n"
