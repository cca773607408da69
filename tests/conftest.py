"""The environment of tests; hypothesis with the same examples every time, or, with ATOMSIM_LONG=1, many new ones."""

from __future__ import annotations

import os

from hypothesis import HealthCheck, settings

for _name in [name for name in os.environ if name.startswith(("NUMBA_", "MPL")) and name != "NUMBA_CACHE_DIR"]:
    del os.environ[_name]  # settings of whoever runs the tests are no part of them

settings.register_profile("same", derandomize=True, deadline=None, max_examples=60, database=None)
settings.register_profile(
    "long", deadline=None, max_examples=3000, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
settings.load_profile("long" if os.environ.get("ATOMSIM_LONG") == "1" else "same")
