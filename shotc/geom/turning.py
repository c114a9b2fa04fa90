"""An upper bound on the rotation of a target along its track between any two times.

The course is the direction of the motion over HEADING_SPAN_S to either side, m(t) = p(t + 1) - p(t - 1).
Between the track's rows, shifted by a second either way, m moves along a straight line. So its angle is
monotonic and changes by the difference of its ends. Where m is shorter than MOVES_M the course keeps its last
value; it may jump where that starts or ends, or at a row.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.track import HEADING_SPAN_S, MOVES_M, Track
from shotc.geom.track_array import places
from shotc.geom.vec import wrapped


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """The accumulated rotation since the first of some times, rad.

    A jump by half a turn does not change a box and counts as 0.
    times : rising, (M,); before, after : rotation before and after a jump at each time, (M,)
    leaves : course just after each time but the last, (M - 1,); moves : whether it follows the motion, (M -
        1,)
    """

    track: Track
    times: Array
    before: Array
    after: Array
    leaves: Array
    moves: Mask

    def at(self, t: Array) -> tuple[Array, Array]:
        """Return the rotation at times (M,) in the known range, before and after a jump, (M,) each."""
        k = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.times) - 1)
        piece = np.minimum(k, len(self.moves) - 1)
        turned = _course(self.track, t) - self.leaves[piece]
        swept = np.where(self.moves[piece], np.abs(turned if self.track.headings else wrapped(turned)), 0.0)
        within = self.after[k] + swept
        on = self.times[k] == t
        return np.where(on, self.before[k], within), np.where(on, self.after[k], within)


def turning(track: Track, start: float, end: float) -> Turning:
    """Return the rotation of a body along a track between two times, seconds; start < end."""
    rows = np.array(track.times)
    if track.headings:
        times = _within(rows, start, end)
        course = _course(track, times)
        moves, leaves, comes = np.ones(len(times) - 1, dtype=np.bool_), course[:-1], course[1:]
        swept = np.abs(comes - leaves)
    else:
        times = _within(np.concatenate([rows, rows - HEADING_SPAN_S, rows + HEADING_SPAN_S]), start, end)
        times = _within(np.concatenate([times, _slow(track, times)]), start, end)
        middle = 0.5 * (times[:-1] + times[1:])
        moves = np.asarray(np.hypot(*_moved(track, middle).T) >= MOVES_M)
        course = _course(track, times)
        still = np.array([0.0 if m else track.heading(float(t)) for t, m in zip(middle, moves, strict=True)])
        leaves, comes = np.where(moves, course[:-1], still), np.where(moves, course[1:], still)
        swept = np.abs(wrapped(comes - leaves))
    steps = np.concatenate([[0.0], np.abs(wrapped(2.0 * (leaves[1:] - comes[:-1]))) / 2.0, [0.0]])
    after = np.concatenate([[0.0], np.cumsum(swept)]) + np.cumsum(steps)
    return Turning(track, times, after - steps, after, leaves, moves)


def _course(track: Track, t: Array) -> Array:
    """Return a track's headings at times (M,), or its directions of motion without them, rad, (M,)."""
    if track.headings:
        return np.asarray(np.interp(t, np.array(track.times), np.array(track.headings)))
    x, y = _moved(track, t).T
    return np.asarray(np.arctan2(y, x))


def _moved(track: Track, t: Array) -> Array:
    """Return the displacements over ground within HEADING_SPAN_S around times (M,), (M, 2), metres."""
    return np.asarray(places(track, t + HEADING_SPAN_S)[:, :2] - places(track, t - HEADING_SPAN_S)[:, :2])


def _slow(track: Track, times: Array) -> Array:
    """Return the times at which the motion falls below MOVES_M or rises above it, by roots of quadratics."""
    m = _moved(track, times)
    along, first = np.diff(m, axis=0), m[:-1]
    p, q = (along**2).sum(axis=1), 2 * (along * first).sum(axis=1)
    r = (first**2).sum(axis=1) - MOVES_M**2
    under = q * q - 4 * p * r
    real = (under >= 0) & (p > 0)
    shares = [(-q[real] + sign * np.sqrt(under[real])) / (2 * p[real]) for sign in (-1.0, 1.0)]
    at = [times[:-1][real] + share * np.diff(times)[real] for share in shares]
    return np.concatenate([t[(s > 0) & (s < 1)] for t, s in zip(at, shares, strict=True)])


def _within(times: Array, start: float, end: float) -> Array:
    return np.unique(np.concatenate([[start, end], times[(times > start) & (times < end)]]))
