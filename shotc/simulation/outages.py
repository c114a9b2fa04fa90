"""When receivers have no satellite positions. Plain Python: the command line reads it without numpy."""

from __future__ import annotations

from typing import NamedTuple


class Outage(NamedTuple):
    """An interval without satellite positions, seconds of mission time.

    who : name of the drone or target that has none; "" for all of them
    """

    start: float
    end: float
    who: str = ""
