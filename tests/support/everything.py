"""One scene that uses every shape, placement, selection, rule, metric, kind of collision and kind of force."""

from __future__ import annotations

from typing import Any

GROUPS: dict[str, Any] = {
    "thread": {"shape": "string", "count": 9, "step": [0.7, 0.1, 0], "velocity": [0.3, 0, -0.2]},
    "wheel": {
        "shape": "ring",
        "count": 11,
        "radius": 2.5,
        "axis": "y",
        "centre": [1, 2.2, 0.5],
        "rotate": [{"axis": "z", "degrees": 30}, {"axis": [1, 2, -0.5], "degrees": -70}],
        "spin": {"axis": [0.3, 1, 0], "rate": 0.4},
        "velocity": [0, -0.5, 0],
    },
    "hoop": {"shape": "ring", "count": 5, "radius": 1.1, "axis": "x", "centre": [-3, 1, 1]},
    "triangle": {
        "shape": "polygon",
        "corners": [[0, 0, 0], [3, 0, 0.5], [0.5, 2.6, 0]],
        "spacing": 0.8,
        "centre": [-2, -3.5, 0],
        "velocity": [0.1, 0.8, 0],
    },
    "floor": {
        "shape": "plane",
        "counts": [6, 5],
        "step_x": [1.3, 0, 0.1],
        "step_y": [0, 0.2, 1.4],
        "centre": [0, -1.7, 0],
        "rotate": {"axis": "x", "degrees": 5},
    },
    "brick": {"shape": "block", "counts": [3, 2, 4], "spacing": 0.9, "centre": [3, 0.5, 2], "velocity": [-1, 0, -0.5]},
    "loose": {
        "shape": "atoms",
        "positions": [[4, -2, 1], [5.2, -2.1, 1.3], [4.1, -0.6, 2.2]],
        "velocity": [-0.5, 0, 0],
    },
    "moved": {
        "shape": "atoms",
        "positions": [[0, 0, 0], [1, 0.5, 0], [0.3, 1.1, 0.2]],
        "centre": [-4, 2, -2],
        "rotate": {"axis": "y", "degrees": 200},
        "spin": {"axis": "x", "rate": -1},
    },
    "leg": {
        "shape": "string",
        "from": [5, 5, 0],
        "to": [8, 6, 1],
        "spacing": 0.8,
        "velocity": [0.2, 0, 0.1],
        "copies": [
            {"count": 2, "step": [0, 0, -2.5]},
            {"count": 3, "axis": [0.2, 0, 1], "through": [6, 4, 0], "degrees": 50},
        ],
    },
    "foot": {
        "shape": "ball",
        "radius": 0.9,
        "spacing": 1.1,
        "centre": [8.5, 6.5, 1],
        "copies": [{"count": 2, "step": [0, 0, -2.5]}, {"count": 3, "axis": "z"}],
    },
    "shell": {"shape": "ball", "radius": 1.6, "spacing": 1, "hollow": True, "centre": [-6, -4, 1]},
    "rope": {"shape": "string", "from": [-7, -4, 3], "step": [0.3, 0.2, 0.6], "count": 4},
    "turned": {
        "shape": "atoms",
        "positions": [[6, 0, 0], [7, 0.5, 0]],
        "rotate": {"axis": "z", "degrees": 45},
    },
}

BONDS: dict[str, Any] = {
    "thread": {"within": "thread", "rule": "neighbour"},
    "wheel": {"within": "wheel", "rule": "neighbour", "reach": 3},
    "open": {"within": ["hoop", "triangle"], "rule": "neighbour", "closed": False, "rest": 0.9},
    "bent": {"within": "thread[::2]", "rule": "neighbour", "reach": 2, "closed": True, "rest": 1.5},
    "grid": {"within": ["floor", "brick"], "rule": "distance-threshold", "threshold": 1.5, "metric": "grid"},
    "patch": {"within": "floor[1:4, :3]", "rule": "distance-threshold", "threshold": 3, "metric": "grid", "rest": 0},
    "near": {"within": "all", "rule": "distance-threshold", "threshold": 0.95},
    "glue": {"between": ["brick", ["loose", "moved[0]"]], "rule": "distance-threshold", "threshold": 2.5},
    "weld": {"between": [["loose", "moved"], ["moved", "turned"]], "rule": "all-pairs"},
    "stiff": {"within": "brick[0, :, 1:]", "rule": "all-pairs"},
    "legs": {"within": ["leg", "leg.2[::2]"], "rule": "neighbour", "reach": 2},
    "ankles": {"between": ["leg[-1]", ["foot[0]", "foot[-1]"]], "rule": "all-pairs", "rest": 1.1},
    "hips": {"between": ["shell", "leg[0]"], "rule": "pairs", "pairs": [[0, 0], [5, 0]]},
    "feet": {"within": "foot", "rule": "distance-threshold", "threshold": 1.3},
    "tied": {"between": ["leg.0[-1]", "leg.1[-1]"], "rule": "all-pairs"},
    "listed": {"within": "triangle", "rule": "pairs", "pairs": [[0, 4], [4, 0], [2, 5]]},
    "cross": {"between": ["wheel", "floor[-1, -1]"], "rule": "pairs", "pairs": [[10, 0], [3, 0]], "rest": 2},
}

COLLISIONS: dict[str, Any] = {
    "own": {"within": ["thread", "wheel"], "min_gap": 3},
    "loose": {"within": "loose"},
    "contact": {"between": ["floor", ["thread", "wheel", "brick[:, 0, :]"]]},
    "overlap": {"between": [["loose", "moved"], ["moved", "turned"]]},
    "rest": {"among": ["triangle", "thread[2:7]", "hoop", ["brick", "loose"]]},
    "legs": {"within": ["leg", "rope"], "min_gap": 2},
    "feet": {"among": ["foot.0", "foot.1", ["foot.2", "shell"]]},
    "unbound": {"within": ["triangle", "brick"], "except_bound": True},
    "far": {"between": ["all", ["wheel", "thread"]], "except_bound": 3},
}

FORCES: dict[str, Any] = {
    "ground": {"kind": "hold", "acts_on": ["floor[0, :]", "hoop[0]"]},
    "air": {"kind": "damping", "coefficient": 0.02},
    "weight": {"kind": "gravity", "acts_on": ["brick", "wheel"], "impulse": [0, -0.01, 0.003]},
    "kick": {"kind": "push", "acts_on": "thread[-1]", "impulse": [0, 0.2, 0], "from_round": 3, "until_round": 9},
    "wind": {"kind": "push", "acts_on": "moved", "impulse": [0.01, 0, 0], "from_round": 5},
    "shake": {"kind": "oscillate", "acts_on": "floor[:, 0]", "impulse": [0.02, 0.05, 0], "period": 7, "phase": 0.5},
    "motor": {"kind": "torque", "acts_on": "wheel", "axis": [0.2, 1, 0], "magnitude": 0.5},
    "crank": {"kind": "torque", "acts_on": "wheel[0:3]", "axis": "y", "magnitude": -0.2, "about": ["wheel", "hoop"]},
    "steps": {"kind": "torque", "acts_on": "leg", "axis": "x", "magnitude": 0.3},
    "kicks": {"kind": "torque", "acts_on": "foot[1:]", "axis": "z", "magnitude": 0.1, "about": "leg[0]"},
    "draw": {"kind": "push", "acts_on": ["brick", "loose"], "towards": [0, 0, 1], "magnitude": 0.02, "from_round": 4},
    "close": {"kind": "push", "acts_on": "leg[-1]", "towards": "shell", "magnitude": 0.03, "until_round": 30},
    "part": {"kind": "push", "acts_on": "leg[0]", "towards": "foot", "magnitude": -0.02},
    "bed": {"kind": "tether", "acts_on": ["shell[::3]", "floor"], "target": "initial"},
    "leash": {"kind": "tether", "acts_on": ["turned", "loose[0]"], "target": [6, 1, 0]},
    "anchor": {"kind": "tether", "acts_on": "hoop", "target": [-3, 1, 1], "rest": 0.5},
}

EVERYTHING: dict[str, Any] = {
    "groups": GROUPS,
    "time_step": 0.03,
    "jitter": {"amplitude": 1e-3, "seed": 7},
    "bonds": BONDS,
    "collisions": COLLISIONS,
    "forces": FORCES,
}
