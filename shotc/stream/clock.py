"""The clock of a flight. Deadlines are absolute, so delays do not add up."""

from __future__ import annotations

import time
from typing import Protocol

RATE_HZ = 50
PERIOD_S = 1.0 / RATE_HZ


class FlightClock(Protocol):
    """Seconds that only increase, from any zero."""

    def now(self) -> float:
        """Return the time."""
        ...

    def wait_until(self, moment: float) -> None:
        """Return at ``moment``, or at once if it has passed."""
        ...

    def utc(self) -> float:
        """Return the time of day, POSIX seconds."""
        ...


class WallClock:
    """The monotonic clock of the machine."""

    def now(self) -> float:
        """Return the time."""
        return time.monotonic()

    def wait_until(self, moment: float) -> None:
        """Sleep until ``moment``."""
        left = moment - time.monotonic()
        if left > 0:
            time.sleep(left)

    def utc(self) -> float:
        """Return the time of day, POSIX seconds."""
        return time.time()
