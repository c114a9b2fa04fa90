"""The knots of a shot on its own clock: a way into its motion, the film, and a way out."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import arrivals, is_keyed
from shotc.ir.mission import Drone, MissionIR, Shot

PIECE = 0.5  # seconds of a piece of the spline, of a shot that is not very long
FEWEST, MOST = 16, 240  # pieces of the film
SHARE = 0.6  # of the drone's acceleration and jerk that the ways in and out are laid out for
SETTLE = 1.0  # seconds that they have beyond that
PARTS = 4  # pieces at least from a keyframe to the next, so that a smooth way bends between them
ROUNDING = 1e-9  # seconds
STEP = 0.5  # seconds over which the speed at the ends of a shot is measured


@dataclass(frozen=True, slots=True, eq=False)
class Clock:
    """Knots over mission time.

    breaks : shape (P + 1,), seconds; start, end : of the film, two of them
    """

    breaks: Array
    start: float
    end: float

    @property
    def filmed(self) -> Mask:
        """Whether each piece belongs to the film, shape (P,)."""
        middle = 0.5 * (self.breaks[:-1] + self.breaks[1:])
        return np.asarray((middle > self.start) & (middle < self.end))


def clock_of(mission: MissionIR, drone: Drone, shot: Shot, start: float) -> Clock:
    """Return the knots of a shot whose first frame is at ``start``."""
    duration = shot.timing.duration or 0.0
    end = start + duration
    pieces = int(min(MOST, max(FEWEST, ceil(duration / PIECE))))
    step = duration / pieces
    before = lead_in(mission, drone, shot, start)
    after = _lead(drone, _speed(mission, shot, start, end, -STEP))
    first, last = (max(4, ceil(lead / max(step, PIECE))) for lead in (before, after))
    breaks = np.concatenate(
        [
            np.linspace(start - before, start, first + 1)[:-1],
            _filmed(shot, start, step) if is_keyed(shot) else np.linspace(start, end, pieces + 1),
            np.linspace(end, end + after, last + 1)[1:],
        ]
    )
    return Clock(breaks, start, end)


def _filmed(shot: Shot, start: float, step: float) -> Array:
    """Return the knots of a film told by keyframes: each is reached and left at one of them.

    step : seconds of a piece where there is no reason for a shorter one
    """
    duration = shot.timing.duration or 0.0
    stops = [(t, t + k.hold) for t, k in zip(arrivals(shot), shot.keyframes, strict=True)]
    ends = sorted({0.0, duration, *(min(t, duration) for stop in stops for t in stop)})
    kept = ends[:1] + [b for a, b in pairwise(ends) if b - a > ROUNDING]
    kept[-1] = duration
    knots = [
        start + np.linspace(a, b, max(PARTS, ceil((b - a) / step)), endpoint=False) for a, b in pairwise(kept)
    ]
    return np.append(np.concatenate(knots), start + duration)


def lead_in(mission: MissionIR, drone: Drone, shot: Shot, start: float) -> float:
    """Return the seconds that the drone sets out before the first frame of a shot."""
    return _lead(drone, _speed(mission, shot, start, start, STEP))


def _speed(mission: MissionIR, shot: Shot, start: float, t: float, step: float) -> float:
    a, b = (np.array(ideal_place(mission, shot, start, u)) for u in (t, t + step))
    return float(np.linalg.norm(b - a)) / abs(step)


def _lead(drone: Drone, speed: float) -> float:
    """Return the seconds in which a drone comfortably gets from rest to a speed."""
    limits = drone.limits
    most = min(speed, limits.speed)
    return SETTLE + most / (SHARE * limits.acceleration) + limits.acceleration / limits.jerk
