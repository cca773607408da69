"""Coverage-guided fuzzing of loader, compiler and forecast: every text ends in a scene or in its mistakes.

    make fuzz                                        # five minutes
    python tests/fuzz/fuzz_scene.py -max_total_time=60

What it begins with is made anew each time from the scenes of the repository; only what it finds is kept, by libFuzzer,
as `crash-…`, `timeout-…` or `oom-…` in the present folder. Needs the extra `fuzz`.
"""

from __future__ import annotations

import random
import re
import sys
import tempfile
import warnings
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["atomsim"]):
    from atomsim.cli.describe import describe_model
    from atomsim.compiler import compile_scene, room, selections
    from atomsim.core.pairs import near
    from atomsim.errors import SceneError
    from atomsim.scene import loads
    from atomsim.scene.field_docs import field_docs

ROOT = Path(__file__).parents[2]

MEMORY = 1 << 24
"""What the compiler is told is free: a scene that takes long only because it is large teaches nothing."""

NUMBERS = [
    "0",
    "-1",
    "1",
    "2",
    "7",
    "0.5",
    "1e-3",
    "1e-320",
    "1e308",
    "-1e308",
    "1e15",
    "999999999999999",
    ".nan",
    ".inf",
]
TOKEN = re.compile(r"[A-Za-z_-]+|[-+.0-9e]+|[^\sA-Za-z0-9]|\s+")


def seeds() -> list[bytes]:
    """Return every scene of the repository, broken ones too."""
    return [
        path.read_bytes()
        for pattern in ("scenes", "docs/examples", "tests")
        for path in (ROOT / pattern).rglob("*.yaml")
    ]


def words() -> list[str]:
    """Return the words of the language: its keys, its shapes, rules and kinds, and what can stand for a group."""
    keys = {key for fields in field_docs().values() for key in fields}
    return [
        *keys,
        *re.findall(r"[a-z-]{3,}", " ".join(text.decode(errors="ignore") for text in seeds())),
        "all",
        "a[0]",
        "null",
    ]


WORDS = words()


def replaced(data: bytes, max_size: int, seed: int) -> bytes:
    """Change one token of a text, or leave the change to libFuzzer: texts that stay scenes reach the compiler."""
    dice = random.Random(seed)
    tokens = TOKEN.findall(data.decode(errors="ignore"))
    if not tokens or dice.random() < 0.3:
        return bytes(atheris.Mutate(data, max_size))
    for _ in range(dice.choice([1, 1, 2, 4, 8])):
        place, other = dice.randrange(len(tokens)), dice.randrange(len(tokens))
        if dice.random() < 0.1:
            tokens[place:place] = tokens[other : other + dice.randrange(40)]
        elif tokens[place][0] in "-+.0123456789":
            tokens[place] = dice.choice(NUMBERS)
        elif tokens[place].isidentifier():
            tokens[place] = dice.choice(WORDS)
        else:
            tokens[place] = tokens[other]
    return "".join(tokens).encode()[:max_size]


def ends_well(data: bytes) -> None:
    """Load, compile and describe a text; any exception but a list of one-line mistakes is a finding."""
    try:
        loaded = loads(data.decode(errors="replace"), "fuzz.yaml")
        model, state = compile_scene(loaded)
    except SceneError as error:
        if not error.problems or not all(str(problem).isprintable() for problem in error.problems):
            raise AssertionError(f"not one printable line per mistake: {error}") from error
        return
    try:
        describe_model(model, state, loaded.scene.rounds, loaded.scene.record_every)
    except MemoryError:
        return  # told by the command line


def main() -> None:
    """Fuzz until a finding or the time given."""
    warnings.simplefilter("error")  # NumPy's would reach the user
    for module in (room, selections, near):
        module.free_memory = lambda: MEMORY
    near.LARGE = selections.LARGE = 1 << 20
    with tempfile.TemporaryDirectory() as folder:
        for number, seed in enumerate(seeds()):
            (Path(folder) / f"{number}.yaml").write_bytes(seed)
        limits = ["-timeout=20", "-rss_limit_mb=2048", "-max_len=8192", "-print_final_stats=1"]
        atheris.Setup([sys.argv[0], *limits, *sys.argv[1:], folder], ends_well, custom_mutator=replaced)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
