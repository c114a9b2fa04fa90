"""The take-off of a fleet: all at once, or in layers where pads are nearer than the separation.

The pads of one layer are the horizontal separation apart, so its drones rise side by side. Each layer stops
one vertical separation above the next one. The highest layer rises first. The next one leaves its pads when
those before it are that far up, and never comes nearer to them. The fleet lands in reverse order, the lowest
layer first. While a drone stands on its pad its rotors are off; then the separation is twice the radius, and
the margin. This module is plain Python.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from shotc.geom.apart import ROUNDING_RATIO
from shotc.geom.colouring import coloured, conflicts, fewest_colours
from shotc.geom.pads import nearest_pair
from shotc.ir.limits import Vec3

if TYPE_CHECKING:
    from shotc.ir.show import Apart, Fleet

MOST_LAYERS = 64
"""Most layers of a take-off; pads that need more are an error (D001)."""


class TakeOff(NamedTuple):
    """The layers of a fleet.

    layer : of each pad, by its number; 0 is the highest
    heights : of the layers above their pads, metres, decreasing
    step : least vertical distance between two layers while both are in the air, metres
    """

    layer: tuple[int, ...]
    heights: tuple[float, ...]
    step: float

    @property
    def layered(self) -> bool:
        """Whether there is more than one layer."""
        return len(self.heights) > 1

    def top(self, pad: int) -> float:
        """Return how far the drone on a pad rises, metres."""
        return self.heights[self.layer[pad]]


def take_off_of(fleet: Fleet) -> TakeOff:
    """Return the layers in which a fleet takes off."""
    return _take_off(fleet.pads, fleet.apart, fleet.rise)


def bodies_of(fleet: Fleet) -> Apart:
    """Return the separation between two drones of which one stands on its pad, centre to centre, metres."""
    return fleet.apart._replace(shape="ellipsoid", horizontal=2 * fleet.radius, vertical=2 * fleet.radius)


@lru_cache(maxsize=16)
def _take_off(pads: tuple[Vec3, ...], apart: Apart, rise: float) -> TakeOff:
    level = [(x, y) for x, y, _ in pads]
    if nearest_pair(pads, apart) is None or fewest_colours(level, apart.across) > MOST_LAYERS:
        return TakeOff((0,) * len(pads), (rise,), 0.0)
    layer = coloured(level, apart.across)
    near = conflicts(level, apart.across)
    uneven = max((abs(pads[i][2] - pads[j][2]) for i, others in enumerate(near) for j in others), default=0.0)
    step = ROUNDING_RATIO * (apart.upright + uneven)
    count = max(layer) + 1
    return TakeOff(layer, tuple(rise + step * (count - 1 - k) for k in range(count)), step)
