"""Arguments of `render` and `render_frames` that will not do: each ends in a message with the argument and a remedy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import atomsim

SCENE = "atomsim: 1\ntime_step: 0.1\nrounds: 20\ngroups: {ball: {shape: atoms, positions: [[0, 0, 0]]}}\n"


@pytest.fixture
def out(tmp_path, monkeypatch) -> str:
    monkeypatch.chdir(tmp_path)
    atomsim.run(atomsim.loads(SCENE), "out.h5")
    return "out.h5"


CAMERA = "azimuth and elevation, such as (30, 20), or front, side or top, or keys and values as in a scene"

MISTAKES: list[tuple[dict[str, Any], str]] = [
    ({"trajectories": []}, "trajectories: needs the name of a file, or a list of such names (got [])"),
    ({"trajectories": 5}, "trajectories: needs the name of a file, or a list of such names (got 5)"),
    ({"trajectories": [None]}, "trajectories: needs the name of a file (got None)"),
    ({"trajectories": None}, "trajectories: needs the name of a file, or a list of such names (got None)"),
    ({"picture": None}, "picture: needs the name of a file (got None)"),
    ({"picture": ""}, "picture: needs the name of a file (got '')"),
    ({"rounds": []}, "rounds: needs whole numbers, such as [0, 250], or a text, such as 0-2000:100 (got [])"),
    ({"rounds": ()}, "rounds: needs whole numbers, such as [0, 250], or a text, such as 0-2000:100 (got ())"),
    ({"rounds": 10}, "rounds: needs whole numbers, such as [0, 250], or a text, such as 0-2000:100 (got 10)"),
    ({"rounds": [0, -1]}, "rounds: needs a whole number of 0 or more (got -1)"),
    ({"rounds": [0.5]}, "rounds: needs a whole number of 0 or more (got 0.5)"),
    ({"rounds": ["0"]}, "rounds: needs a whole number of 0 or more (got '0')"),
    ({"rounds": "first"}, "rounds are written 0,250,500 or 0-2000:100 (from, to, every) or -20 (the last twenty "),
    ({"rounds": [21]}, "out.h5: there is no round 21; it ends at round 20"),
    ({"size": (640,)}, "size: needs width and height in pixels, such as (640, 480) (got (640,))"),
    ({"size": 640}, "size: needs width and height in pixels, such as (640, 480) (got 640)"),
    ({"size": (64.5, 48)}, "size: needs width and height in pixels, such as (640, 480) (got (64.5, 48))"),
    ({"size": "640"}, "size is written 640x480, in pixels, or 8x6cm; got 640"),
    ({"size": "800x600cm"}, "a frame must be from 16 to 4096 pixels wide and high (got 94488x70866)"),
    ({"dpi": 5}, "dpi: needs a whole number from 20 to 2400 (got 5)"),
    ({"dark": "no"}, "dark: needs True or False (got 'no')"),
    ({"transparent": 1}, "transparent: needs True or False (got 1)"),
    ({"size": (0, 48)}, "a frame must be from 16 to 4096 pixels wide and high (got 0x48)"),
    ({"size": (-64, 48)}, "a frame must be from 16 to 4096 pixels wide and high (got -64x48)"),
    ({"camera": 30}, f"camera: needs {CAMERA} (got 30)"),
    ({"camera": (30, 20, 10)}, f"camera: needs {CAMERA} (got (30, 20, 10))"),
    ({"camera": (None, 20)}, f"camera: needs {CAMERA} (got (None, 20))"),
    ({"camera": {1: 2}}, f"camera: needs {CAMERA} (got {{1: 2}})"),
    ({"camera": (np.nan, 20)}, "camera.azimuth: needs a finite number (got .nan)"),
    ({"camera": "back"}, 'camera.view: needs front, side or top (got "back")'),
    ({"camera": {"widht": 3}}, "camera.widht: unknown key `widht`; did you mean `width`?"),
    ({"camera": {"width": -3}}, "camera.width: needs a number above 0 (got -3)"),
    ({"camera": {"look_at": "ball"}}, 'camera.look_at: needs [x, y, z] (got "ball")'),
    ({"camera": {"look_at": [0, 0, 2e9]}}, "camera: look_at must be within ±1e+09 (got [0.0, 0.0, 2000000000.0])"),
    ({"camera": {"follow": "bell"}}, "camera.follow: there is no group `bell`; did you mean `ball`?"),
    ({"camera": {"follow": "ball[1]"}}, "out.h5: camera.follow: `ball[1]` is out of range: ball has 1 there, 0 to 0"),
    (
        {"camera": {"follow": "ball", "look_at": [0, 0, 0]}},
        "camera: say one of `look_at`, `follow` and `close_up`: where",
    ),
    ({"camera": {"view": "side", "azimuth": 3}}, "camera: `view` stands for azimuth and elevation; leave one or"),
    ({"camera": []}, f"camera: needs {CAMERA} (got [])"),
    ({"camera": ["side", None]}, f"camera: needs {CAMERA} (got ['side', None])"),
    ({"camera": ["side", "back"]}, 'camera.view: needs front, side or top (got "back")'),
    ({"camera": {"close_up": "bell"}}, "camera.close_up: there is no group `bell`; did you mean `ball`?"),
    ({"camera": {"field_of_view": 150}}, "camera.field_of_view: needs 120 or less (got 150)"),
    ({"camera": {"up": "w", "width": "wide"}}, 'camera.up: needs x, y or z (got "w")\ncamera.width: needs a number ('),
    ({"notice": "loud"}, "notice: needs a function (got 'loud')"),
    ({"report": 1}, "report: needs a function (got 1)"),
]


@pytest.mark.parametrize(("wrong", "message"), MISTAKES, ids=lambda part: str(part)[:40])
def test_what_will_not_do_is_named_with_a_remedy(out, wrong, message):
    arguments = {"trajectories": out, "picture": "out.png", "size": (32, 24), **wrong}
    with pytest.raises(atomsim.InputError) as caught:
        atomsim.render(arguments.pop("trajectories"), arguments.pop("picture"), **arguments)
    assert str(caught.value).startswith(message)
    arguments = {"trajectories": out, "picture": "film", "size": (32, 24), **wrong}
    with pytest.raises(atomsim.InputError) as caught:
        atomsim.render_frames(arguments.pop("trajectories"), arguments.pop("picture"), **arguments)
    assert str(caught.value).startswith(message.replace("picture", "folder"))
    assert [path.name for path in Path().iterdir() if path.suffix != ".h5" and any(path.iterdir())] == []


def test_what_will_do(out):
    """Paths and numbers of any kind; a text for rounds is that of the command line."""
    size = np.array([32, 24])
    atomsim.render(Path(out), Path("one.png"), rounds=np.array([0, 20]), size=size, camera=np.array([30.0, 20.0]))
    atomsim.render((out,), "two.png", rounds="0,20", size=(32, 24), camera=(30, 20))
    atomsim.render([out], "three.png", rounds=range(0, 21, 20), size=[32, 24], camera=[30, 20])
    assert Path("one.png").read_bytes() == Path("two.png").read_bytes() == Path("three.png").read_bytes()
    side = {"view": "side", "look_at": np.array([0.0, 0, 0]), "width": np.float64(9)}
    atomsim.render(out, "four.png", rounds=[0], size=(32, 24), camera=side)
    exact = {"azimuth": 0, "elevation": 0, "look_at": [0, 0, 0], "width": 9.0}
    atomsim.render(out, "five.png", rounds=[0], size=(32, 24), camera=exact)
    assert Path("four.png").read_bytes() == Path("five.png").read_bytes()
    heard: list[tuple[int, int]] = []
    files = atomsim.render_frames(out, "film", rounds="-2", size=(32, 24), report=lambda *count: heard.append(count))
    assert [file.name for file in files] == ["round-10.png", "round-20.png"]
    assert heard == [(0, 2), (1, 2), (2, 2)]
