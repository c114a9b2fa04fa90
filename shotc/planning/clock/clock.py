"""The knots of a shot on its own clock: run-up, film, and run-out."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.ease import MOST_PARTS
from shotc.geom.pieces import Mask
from shotc.ir.drone import LensRange
from shotc.ir.keyed import arrivals, is_keyed, zoom_parts
from shotc.ir.mission import Shot
from shotc.planning.clock.run_up import Link, RunUp

PIECE_S = 0.5  # seconds of a piece, where the shot is not very long
FEWEST_PIECES, MOST_PIECES = 16, 240  # pieces of the film
FINE_S = 0.4  # seconds of a piece before or after the film
LEAST_PIECES = 5  # fewest pieces before or after the film; fewer need more time
PIECES_PER_KEYFRAME = 4  # least pieces between two keyframes, so that a smooth curve can bend
ROUNDING_S = 1e-9  # seconds


@dataclass(frozen=True, slots=True, eq=False)
class Clock:
    """Knots over mission time.

    breaks : shape (P + 1,), seconds
    start, end : of the film, seconds; both are among the breaks
    """

    breaks: Array
    start: float
    end: float

    @property
    def filmed(self) -> Mask:
        """Whether each piece belongs to the film, shape (P,)."""
        middle = 0.5 * (self.breaks[:-1] + self.breaks[1:])
        return np.asarray((middle > self.start) & (middle < self.end))


def clock_of(shot: Shot, start: float, ways: tuple[RunUp | Link, RunUp], lens: LensRange | None) -> Clock:
    """Return the knots of a shot whose first frame is at ``start``.

    ways : run-up and run-out
    lens : zoom range of its camera
    """
    duration = shot.timing.duration or 0.0
    end = start + duration
    pieces = int(min(MOST_PIECES, max(FEWEST_PIECES, ceil(duration / PIECE_S))))
    before, after = (run_up.seconds for run_up in ways)
    first, last = (max(LEAST_PIECES, ceil(seconds / FINE_S)) for seconds in (before, after))
    breaks = np.concatenate(
        [
            np.linspace(start - before, start, first + 1)[:-1],
            _filmed(shot, start, duration / pieces, lens)
            if is_keyed(shot)
            else np.linspace(start, end, pieces + 1),
            np.linspace(end, end + after, last + 1)[1:],
        ]
    )
    return Clock(breaks, start, end)


def _filmed(shot: Shot, start: float, step: float, lens: LensRange | None) -> Array:
    """Return the knots of a film with keyframes.

    A knot lies where a keyframe is reached, where it is left, and at the ends of the parts in which the lens
    zooms.

    step : seconds of a piece where no keyframe needs a shorter one
    """
    duration = shot.timing.duration or 0.0
    stops = [(t, t + k.hold) for t, k in zip(arrivals(shot), shot.keyframes, strict=True)]
    ends = sorted({0.0, duration, *(min(t, duration) for stop in stops for t in stop)})
    distinct = ends[:1] + [b for a, b in pairwise(ends) if b - a > ROUNDING_S]
    distinct[-1] = duration
    zooms = list(zip((leave for _, leave in stops), zoom_parts(shot, lens), strict=False))
    knots = []
    for a, b in pairwise(distinct):
        parts = next((n or MOST_PARTS for leave, n in zooms if abs(leave - a) <= ROUNDING_S), 1)
        count = parts * ceil(max(PIECES_PER_KEYFRAME, ceil((b - a) / step)) / parts)
        knots.append(start + np.linspace(a, b, count, endpoint=False))
    return np.append(np.concatenate(knots), start + duration)
