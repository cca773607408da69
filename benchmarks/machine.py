"""Where and when something was measured; measures nothing itself."""

from __future__ import annotations

import os
import platform
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from benchmarks.timing import Results

PACKAGES = ("numpy", "numba", "h5py", "openmm", "jax", "warp-lang")


def describe(quick: bool) -> Results:
    """Return the processor, the system, the versions of all that takes part, and how busy the machine is."""
    return {
        "quick": quick,
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "load": round(os.getloadavg()[0], 2),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "packages": {name: found for name in PACKAGES if (found := _version(name))},
    }


def sentence(machine: Results) -> str:
    """Write it for people."""
    packages = ", ".join(f"{name} {number}" for name, number in machine["packages"].items())
    quick = "Quick and rough numbers. " if machine["quick"] else ""
    return (
        f"{quick}Measured on {machine['date']} on {machine['processor']}, {machine['cores']} cores, "
        f"{machine['system']}, with a load of {machine['load']} at the beginning. "
        f"Python {machine['python']}, {packages}."
    )


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
