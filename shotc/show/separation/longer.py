"""Finds the least duration in which drones that pass too near can be kept apart, by planning the stretch
again.

A stretch from stop to stop does not depend on the rest of the flight. So the mission gives exactly this
result if that duration is written into it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Literal

import numpy as np

from shotc.geom.apart import keeps_separation
from shotc.geom.bernstein import Array
from shotc.geom.separation import closest
from shotc.ir.fleet import FleetTrajectory, FrameTimes
from shotc.ir.passes import PassContext
from shotc.ir.show import Fleet
from shotc.rounding import up
from shotc.show.separation.pushed import CONTROL_DECIMALS, PUSH_ROUNDS, pushed
from shotc.show.solvers.qcqp import DerivativeBounds, bounded, short

FACTORS = (1.5, 2.5, 4.0)
"""Factors on the duration, tried in order; if the last is not enough, the search fails."""

MOST_HALVINGS = 4
"""Durations tried between one that is not enough and one that is."""

MOST_ROUNDS = 3 * PUSH_ROUNDS
"""Iterations of all tries together, the cost of three failures; a try with enough room needs few."""


@dataclass(frozen=True, slots=True, eq=False)
class MoveBetweenStops:
    """The flight from one stop to the next.

    breaks : shape (P + 1,)
    reference : control points that the goals ask for, shape (n, P + 3, 3)
    shown : the picture at its end, None on the way home
    key : the mission's key of its duration
    from_pads : whether it starts over the pads
    """

    breaks: Array
    reference: Array
    shown: FrameTimes | None
    key: Literal["period", "transition"]
    from_pads: bool

    @staticmethod
    def of(flight: FleetTrajectory, breaks: Array, reference: Array) -> MoveBetweenStops:
        """Return the stretch between two stops of a flight, with its breaks and control points as above.

        breaks, reference : shapes (P + 1,) and (n, P + 3, 3)
        """
        start, end = float(breaks[0]) - 1e-9, float(breaks[-1]) + 1e-9
        inside = [picture for picture in flight.shown if start <= picture.start <= end]
        picture = inside[-1] if inside else None
        same = [
            s
            for s in inside
            if picture is not None and (s.display, s.picture) == (picture.display, picture.picture)
        ]
        from_pads = float(breaks[-1]) <= flight.shown[0].start + 1e-9
        return MoveBetweenStops(
            breaks, reference, picture, "period" if len(same) > 1 else "transition", from_pads
        )

    @property
    def pieces(self) -> int:
        """Return how many pieces share the written duration."""
        return 1 if self.key == "period" else len(self.breaks) - 1

    def lasting(self, seconds: float) -> Array:
        """Return breaks (P + 1,) for a written duration, as ``assign-goals`` makes them."""
        piece = seconds / self.pieces
        return np.array([round(float(self.breaks[0]) + k * piece, 9) for k in range(len(self.breaks))])


def longer(stretch: MoveBetweenStops, fleet: Fleet, ctx: PassContext) -> float | None:
    """Return the least duration found that is enough, s, rounded up to a hundredth, or None."""
    if stretch.shown is None:
        return None  # No key sets the duration of the way home.
    now = float(stretch.breaks[stretch.pieces] - stretch.breaks[0])
    trial, low = _Trial(stretch, fleet, ctx), now
    for factor in FACTORS:
        high = up(now * factor)
        if trial.enough(high):
            break
        low = high
    else:
        return None
    for _ in range(MOST_HALVINGS):
        middle = up(sqrt(low * high))
        if middle >= high or trial.left <= 0:
            break
        low, high = (low, middle) if trial.enough(middle) else (middle, high)
    return high


class _Trial:
    """Plans a stretch with other durations; left : remaining iterations."""

    def __init__(self, stretch: MoveBetweenStops, fleet: Fleet, ctx: PassContext) -> None:
        self.stretch, self.fleet, self.ctx = stretch, fleet, ctx
        self.left = MOST_ROUNDS

    def enough(self, seconds: float) -> bool:
        """Tell whether the drones are kept apart if the stretch has this duration."""
        stretch, fleet, ctx = self.stretch, self.fleet, self.ctx
        ctx.progress(f"keeping fleet {fleet.name} apart: would `{stretch.key}: {seconds:.2f}` do")
        breaks, bounds = stretch.lasting(seconds), DerivativeBounds(fleet.limits)
        result = bounded(breaks, stretch.reference, bounds)
        if len(result.failed):
            return False
        coef = short(breaks, result.coef, bounds, CONTROL_DECIMALS)
        if keeps_separation(closest(breaks, coef, fleet.apart).proven, fleet.apart.across):
            return True
        tried = pushed(breaks, coef, fleet, ctx.seed, min(PUSH_ROUNDS, self.left))
        self.left -= tried.rounds
        return tried.coef is not None
