"""The smoothing time: the balance between a calm camera and a small deviation from the ideal.

Movements of the ideal that are shorter than the smoothing time are smoothed away. In the cost of a motion the
squared jerk has the sixth power of this time as weight, the squared acceleration the fourth, and the squared
rate the second. All kinds of shots use the same rule.
"""

from typing import Final

NORMAL_S: Final = 0.5
SMOOTHINGS: Final = {"low": 0.25, "normal": NORMAL_S, "high": 1.5}
"""Seconds."""
SHORTEST_S, LONGEST_S = 0.1, 3.0


def written(seconds: float) -> str:
    """Return a smoothing time as mission text: its name, or seconds."""
    return next((name for name, time in SMOOTHINGS.items() if time == seconds), f"{seconds:g} s")
