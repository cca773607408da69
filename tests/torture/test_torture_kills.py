"""Real processes killed at random moments: some dozen, or hundreds and on both backends with ATOMSIM_LONG=1."""

from __future__ import annotations

import importlib.util
import json
import os
import sys
from pathlib import Path

import pytest
from support.process import finish

IS_LONG = os.environ.get("ATOMSIM_LONG") == "1"
N_KILLS = 500 if IS_LONG else 14
HAS_NUMBA = importlib.util.find_spec("numba") is not None


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_a_run_killed_many_times_becomes_the_uninterrupted_one() -> None:
    backends = ["numpy", "numba"] if IS_LONG and HAS_NUMBA else ["numpy"]
    done = finish(
        str(N_KILLS), "1", *backends, program=(sys.executable, Path(__file__).with_name("shooting.py")), timeout=3600
    )
    assert done.returncode == 0, done.stderr
    counts = json.loads(done.stdout)
    print(counts)
    assert sum(count for what, count in counts.items() if what.startswith("ended by")) >= N_KILLS
    assert counts["files finished"] >= 1
    assert counts["resumed"] > N_KILLS // 4
