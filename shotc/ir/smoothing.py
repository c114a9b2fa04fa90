"""How calm a camera is flown, against how near it stays to what is asked: one time for every kind of shot.

Movements of the ideal that are shorter than the smoothing time are smoothed away. In the cost of a motion a
squared jerk weighs by its sixth power, a squared acceleration by its fourth, a squared rate by its square.
"""

from typing import Final

NORMAL_S: Final = 0.5
SMOOTHINGS: Final = {"low": 0.25, "normal": NORMAL_S, "high": 1.5}
"""Seconds."""
SHORTEST_S, LONGEST_S = 0.1, 3.0


def written(seconds: float) -> str:
    """Return a smoothing as a mission writes it: by its name, or in seconds."""
    return next((name for name, time in SMOOTHINGS.items() if time == seconds), f"{seconds:g} s")
