"""How many processes can work side by side here."""

from __future__ import annotations

import sys
from os import cpu_count, sched_getaffinity


def cores() -> int:
    """Return how many cores this process may use."""
    return len(sched_getaffinity(0)) if sys.platform == "linux" else cpu_count() or 1
