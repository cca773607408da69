"""The command: measures what is asked for, prints tables, keeps the numbers as JSON; knows nothing of any section."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from benchmarks.machine import describe, sentence
from benchmarks.sections import SECTIONS, all_answers
from benchmarks.tables import answers_table
from benchmarks.timing import Results


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the benchmark."""
    options = _options(arguments)
    results: Results = {"machine": describe(options.quick)}
    print(sentence(results["machine"]))
    for name in options.only:
        begin = time.perf_counter()
        results[name] = SECTIONS[name].measure(options.quick)
        print(f"\n{SECTIONS[name].markdown(results[name])}", flush=True)
        print(f"{name}: measured in {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    print(f"\n{answers_table(all_answers(results)).markdown()}")
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="How fast atomsim is.")
    parser.add_argument("--quick", action="store_true", help="small and rough, in less than a minute")
    parser.add_argument("--only", type=_sections, default=list(SECTIONS), help=f"some of {','.join(SECTIONS)}")
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="keep the numbers, for python -m benchmarks.page FILE"
    )
    return parser.parse_args(arguments)


def _sections(names: str) -> list[str]:
    chosen = names.split(",")
    if unknown := [name for name in chosen if name not in SECTIONS]:
        raise argparse.ArgumentTypeError(f"there is no section {unknown[0]}; choose from {','.join(SECTIONS)}")
    return [name for name in SECTIONS if name in chosen]
