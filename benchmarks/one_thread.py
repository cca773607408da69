"""What tells libraries to use one thread, so that engines and not cores are compared; loads none of them."""

from __future__ import annotations

import os

ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
}
"""Environment variables; libraries read them when they are loaded."""


def environment_of_a_user() -> dict[str, str]:
    """Return the environment of this process without them."""
    return {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
