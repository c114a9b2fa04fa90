"""Where the cameras of shots on their own clocks would be, all at once and one by one."""

from __future__ import annotations

SEEDS = range(40)
