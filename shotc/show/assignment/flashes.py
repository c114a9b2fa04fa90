"""Detects flashes of a whole fleet, which can cause seizures, as WCAG 2.2, 2.3.1 counts them.

A flash is a pair of opposing changes of relative luminance by at least a tenth of the maximum, the darker of
which is below 0.8. More than three in any second are too many. The mean of the lights is judged, so lights
that sparkle individually do not count.
"""

from __future__ import annotations

from bisect import bisect_left
from math import ceil
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.effects import LIGHT_RATE_HZ
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.light_colors import tick_colors
from shotc.ir.mission import MissionIR
from shotc.rounding import as_minutes

LUMINANCE_WEIGHTS = (0.2126, 0.7152, 0.0722)
"""Weights of red, green and blue light."""
CHANGE_LUMINANCE, BRIGHT_LUMINANCE = 0.1, 0.8
MOST_FLASHES_PER_S = 3
"""Most flashes in any second."""
SAMPLED_LIGHTS = 200
"""Sampled lights of a fleet, uniformly by number; all of a smaller fleet."""
BATCH_TIMES = 500
"""Samples that are evaluated together."""


class Flashes(NamedTuple):
    """The most flashes in any second, and the start of that second, seconds."""

    number: int
    time: float


def flashing(mission: MissionIR, flight: FleetTrajectory) -> list[Diagnostic]:
    """Return the warning on a fleet that flashes more than three times in a second."""
    if not flight.lights.looks:
        return []
    worst = most_flashes(luminance(flight))
    if worst.number <= MOST_FLASHES_PER_S:
        return []
    shots = (p.shot for p in flight.phases if p.shot is not None and p.end > worst.time)
    display = mission.display(next(shots, flight.shown[-1].display))
    return [
        Diagnostic(
            "D102",
            f"the lights flash {worst.number} times in a second",
            (mission.origins.value((*display.path, "id")),),
            (
                f"the second begins at {as_minutes(worst.time)}; all lights together are judged",
                f"more than {MOST_FLASHES_PER_S} flashes in a second can set off seizures (WCAG 2.3.1)",
            ),
            f"slow the effect to a period of {1.0 / MOST_FLASHES_PER_S + 0.005:.2f} s or more, "
            "or lower its `opacity`",
        )
    ]


def luminance(flight: FleetTrajectory) -> Array:
    """Return the mean relative luminance of a fleet's lights at each light tick, 0 to 1, shape (T,)."""
    some = slice(None, None, max(1, len(flight.coef) // SAMPLED_LIGHTS))
    ticks = np.arange(ceil(float(flight.breaks[-1]) * LIGHT_RATE_HZ) + 1)
    parts = [
        tick_colors(flight, ticks[k : k + BATCH_TIMES], some).mean(axis=0)
        for k in range(0, len(ticks), BATCH_TIMES)
    ]
    return np.asarray(np.concatenate(parts) @ np.array(LUMINANCE_WEIGHTS) / 255.0)


def most_flashes(levels: Array) -> Flashes:
    """Return the most flashes in any second of a luminance at light ticks (T,)."""
    changes = _changes(levels)
    best = Flashes(0, 0.0)
    for k, first in enumerate(changes):
        inside = bisect_left(changes, first + LIGHT_RATE_HZ) - k
        if inside // 2 > best.number:
            best = Flashes(inside // 2, first / LIGHT_RATE_HZ)
    return best


def _changes(levels: Array) -> list[int]:
    """Return the ticks at which counted changes are complete; successive ones have opposite signs."""
    changes: list[int] = []
    low = high = float(levels[0])
    rising: bool | None = None
    for k, level in enumerate(levels.tolist()):
        low = low if rising else min(low, level)
        high = high if rising is False else max(high, level)
        if not rising and level >= low + CHANGE_LUMINANCE and low < BRIGHT_LUMINANCE:
            rising, high = True, level
            changes.append(k)
        elif rising is not False and level <= high - CHANGE_LUMINANCE and level < BRIGHT_LUMINANCE:
            rising, low = False, level
            changes.append(k)
    return changes
