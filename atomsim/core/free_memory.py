"""How much memory is free; asked before anything large is allocated."""

from __future__ import annotations

import os
import sys
from pathlib import Path

GROUP = Path("/sys/fs/cgroup")
"""Where Linux tells what a container may take."""


def free_memory() -> int:
    """Return the bytes that can be allocated without swapping, as the system and its container estimate them."""
    return min(_free_in_system(), _free_in_group(GROUP))


def _free_in_system() -> int:
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass  # no Linux: count the whole memory, which at least stops the absurd
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def _free_in_group(group: Path) -> int:
    """Return what a container may still take, beside files kept for speed only; without a limit, any amount."""
    try:
        limit, used = (int((group / name).read_text()) for name in ("memory.max", "memory.current"))
        kept = dict(line.split() for line in (group / "memory.stat").read_text().splitlines())
        return max(0, limit - used + int(kept["inactive_file"]))
    except (OSError, ValueError, KeyError):
        return sys.maxsize


def readable_bytes(size: float) -> str:
    """Write a number of bytes for people.

    >>> readable_bytes(1_500_000), readable_bytes(999)
    ('1.5 MB', '999 B')
    """
    for unit in ("B", "kB", "MB", "GB", "TB"):
        if size < 1000:
            return f"{size:.0f} {unit}" if unit == "B" or size >= 100 else f"{size:.1f} {unit}"
        size /= 1000
    return f"{size:.0f} PB" if size < 1e6 else f"{size:.0e} PB"
