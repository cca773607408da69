"""Random small scenes of every kind, as Python data; knows the language, not what scenes come to."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import strategies as st

Data = dict[str, Any]

lengths = st.floats(-4, 4) | st.integers(-4, 4).map(float)
vectors = st.tuples(lengths, lengths, lengths)
small_vectors = st.tuples(*[st.floats(-0.5, 0.5)] * 3)
axes = st.sampled_from(["x", "y", "z"]) | vectors.filter(any)
steps = st.tuples(st.floats(0.3, 1.5), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
counts = st.integers(1, 4)


@st.composite
def scenes(draw: st.DrawFn) -> Data:
    """Draw the sections of a scene; some put atoms that meet at the same place, which no scene may."""
    names = ["a", "b", "c"][: draw(st.integers(1, 3))]
    drawn = {name: draw(groups()) for name in names}
    choices = selections(drawn)
    return {
        "groups": drawn,
        "time_step": draw(st.sampled_from([0.01, 0.05, 0.1, 0.25])),
        "jitter": draw(st.none() | st.fixed_dictionaries({"amplitude": st.just(1e-3), "seed": st.integers(0, 99)})),
        "bonds": draw(declarations(bonds(choices))),
        "collisions": draw(declarations(collisions(choices))),
        "forces": draw(declarations(forces(choices))),
    }


def declarations(entries: st.SearchStrategy[Data]) -> st.SearchStrategy[dict[str, Data]]:
    """Name up to three entries."""
    return st.lists(entries, max_size=3).map(lambda drawn: {f"entry_{i}": entry for i, entry in enumerate(drawn)})


def groups() -> st.SearchStrategy[Data]:
    """Draw a group of any shape, placed, turned and moving."""
    shapes = [
        {"shape": st.just("string"), "count": st.integers(1, 7), "step": steps},
        {"shape": st.just("string"), "count": st.integers(1, 7), "step": steps, "from": vectors},
        {
            "shape": st.just("string"),
            "count": st.integers(2, 7),
            "from": vectors,
            "to": st.tuples(*[st.floats(5, 9)] * 3),
        },
        {
            "shape": st.just("string"),
            "spacing": st.floats(1, 4),
            "from": vectors,
            "to": st.tuples(*[st.floats(5, 7)] * 3),
        },
        {"shape": st.just("ball"), "radius": st.floats(0.5, 1.5), "spacing": st.floats(1, 3), "hollow": st.booleans()},
        {
            "shape": st.just("ring"),
            "count": st.integers(1, 8),
            "radius": st.floats(0.5, 3),
            "axis": st.sampled_from("xyz"),
        },
        {"shape": st.just("polygon"), "corners": st.lists(vectors, min_size=3, max_size=4), "spacing": st.floats(1, 3)},
        {"shape": st.just("plane"), "counts": st.tuples(counts, counts), "step_x": steps, "step_y": vectors},
        {
            "shape": st.just("block"),
            "counts": st.tuples(counts, counts, st.integers(1, 2)),
            "spacing": st.floats(0.4, 2),
        },
        {"shape": st.just("atoms"), "positions": st.lists(vectors, min_size=1, max_size=6)},
    ]
    turns = st.fixed_dictionaries({"axis": axes, "degrees": st.floats(-180, 180)})
    placing = {
        "centre": vectors,
        "rotate": turns | st.lists(turns, max_size=2),
        "velocity": small_vectors,
        "spin": st.fixed_dictionaries({"axis": axes, "rate": st.floats(-1, 1)}),
        "copies": copies() | st.lists(copies(), max_size=2),
    }
    movable = {key: drawn for key, drawn in placing.items() if key != "centre"}
    return st.one_of(
        [st.fixed_dictionaries(shape, optional=movable if "from" in shape else placing) for shape in shapes]
    )


def copies() -> st.SearchStrategy[Data]:
    """Draw copies along a line or about an axis."""
    along = {"count": st.integers(1, 3), "step": vectors}
    about = {"count": st.integers(1, 3), "axis": axes}
    return st.fixed_dictionaries(along) | st.fixed_dictionaries(
        about, optional={"through": vectors, "degrees": st.floats(-180, 180)}
    )


def is_copied(group: Data) -> bool:
    """Tell whether a group has more than one copy."""
    copies = group.get("copies", [])
    return math.prod(each["count"] for each in ([copies] if isinstance(copies, dict) else copies)) > 1


def selections(drawn: dict[str, Data]) -> st.SearchStrategy[Any]:
    """Draw a selection of one or more expressions."""
    whole = st.sampled_from([*drawn, "all", *(f"{name}.0" for name, group in drawn.items() if is_copied(group))])
    parts = st.tuples(st.sampled_from([*drawn]), st.sampled_from(["[0]", "[-1]", "[::2]", "[1:]", "[:3]"])).map("".join)
    grids = [name for name, group in drawn.items() if group["shape"] == "plane"]
    tiles = st.tuples(st.sampled_from(grids), st.sampled_from(["[0, :]", "[:, -1]", "[::2, 0]"])).map("".join)
    one = whole | parts | tiles if grids else whole | parts
    return one | st.lists(one, min_size=1, max_size=3)


def bonds(choices: st.SearchStrategy[Any]) -> st.SearchStrategy[Data]:
    """Draw a bond declaration of any rule."""
    where = st.fixed_dictionaries({"within": choices}) | st.fixed_dictionaries({"between": st.tuples(choices, choices)})
    inside = st.fixed_dictionaries({"within": choices})
    rest = {"rest": st.just("initial") | st.floats(0, 2)}
    pairs = st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=1, max_size=4)
    closed = {"closed": st.booleans(), **rest}
    rules = [
        (where, st.fixed_dictionaries({"rule": st.just("all-pairs")}, optional=rest)),
        (where, st.fixed_dictionaries({"rule": st.just("pairs"), "pairs": pairs}, optional=rest)),
        (where, thresholds("space", rest)),
        (inside, thresholds("grid", rest)),  # only planes and blocks have one
        (inside, st.fixed_dictionaries({"rule": st.just("neighbour"), "reach": counts}, optional=closed)),
    ]
    return st.one_of([st.tuples(place, rule).map(lambda both: {**both[0], **both[1]}) for place, rule in rules])


def thresholds(metric: str, rest: dict[str, Any]) -> st.SearchStrategy[Data]:
    """Draw the rule that binds what is near."""
    required = {"rule": st.just("distance-threshold"), "metric": st.just(metric), "threshold": st.floats(0.8, 3)}
    return st.fixed_dictionaries(required, optional=rest)


def collisions(choices: st.SearchStrategy[Any]) -> st.SearchStrategy[Data]:
    """Draw a collision declaration of any form."""
    bound = {"except_bound": st.booleans() | st.integers(1, 3)}
    return (
        st.fixed_dictionaries({"within": choices}, optional={"min_gap": counts, **bound})
        | st.fixed_dictionaries({"between": st.tuples(choices, choices)}, optional=bound)
        | st.fixed_dictionaries({"among": st.lists(choices, min_size=2, max_size=3)}, optional=bound)
    )


def forces(choices: st.SearchStrategy[Any]) -> st.SearchStrategy[Data]:
    """Draw a force of any kind."""
    kinds: dict[str, tuple[Data, Data]] = {
        "damping": ({"coefficient": st.floats(0, 1)}, {}),
        "gravity": ({"impulse": small_vectors}, {}),
        "push": ({"impulse": small_vectors, "from_round": st.integers(0, 4)}, {"until_round": st.integers(5, 9)}),
        "push towards": (
            {"towards": choices | vectors, "magnitude": st.floats(-1, 1), "from_round": st.integers(0, 4)},
            {"until_round": st.integers(5, 9)},
        ),
        "hold": ({}, {}),
        "oscillate": (
            {"impulse": small_vectors, "period": st.floats(0.5, 20)},
            {"phase": st.floats(-math.pi, math.pi)},
        ),
        "torque": ({"axis": axes, "magnitude": st.floats(-1, 1)}, {"about": choices}),
        "tether": ({"target": vectors | st.just("initial")}, {"rest": st.just("initial") | st.floats(0, 2)}),
    }
    return st.one_of(
        [
            st.fixed_dictionaries(
                {"kind": st.just(kind.split()[0]), **required}, optional={"acts_on": choices, **optional}
            )
            for kind, (required, optional) in kinds.items()
        ]
    )
