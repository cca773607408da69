"""`python -m benchmarks`: every library is told to use one thread, before it is loaded, and the benchmark begins."""

from __future__ import annotations

import os

from benchmarks.one_thread import ONE_THREAD

if __name__ == "__main__":
    os.environ.update(ONE_THREAD)
    from benchmarks.bench import main

    main()
