"""The motion of a target at arrays of times, and curves relative to it."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict
from shotc.geom.track import HEADING_SPAN_S, MOVES_M, Track


def places(track: Track, t: Array) -> Array:
    """Return the positions of the target at times (M,), metres, shape (M, 3)."""
    times, points = np.array(track.times), np.array(track.points)
    inside = np.column_stack([np.interp(t, times, points[:, k]) for k in range(3)])
    return np.asarray(inside + np.maximum(t - times[-1], 0.0)[:, None] * np.array(track.after))


def headings(track: Track, t: Array) -> Array:
    """Return the headings of the target at times (M,), rad, shape (M,); as ``Track.heading``."""
    if track.headings:
        return np.array([track.heading(float(u)) for u in t])
    moved = places(track, t + HEADING_SPAN_S)[:, :2] - places(track, t - HEADING_SPAN_S)[:, :2]
    angles = np.arctan2(moved[:, 1], moved[:, 0])
    for k in np.flatnonzero(np.hypot(moved[:, 0], moved[:, 1]) < MOVES_M):
        angles[k] = track.heading(float(t[k]))
    return np.asarray(angles)


def seen_from(curve: Piecewise, track: Track) -> Piecewise:
    """Return a curve of channels x, y, z minus the motion, exactly, on breaks that include the track's rows.

    A target has constant velocity between rows, so on each piece both are polynomials. If a row is close to a
    break, the piece may be too short for a derivative by its control points; use ``rate_seen_from`` for it.
    """
    own = restrict(curve, _common(curve, track))
    ends = places(track, own.breaks)
    share = np.linspace(0.0, 1.0, own.degree + 1)[:, None]
    return Piecewise(own.breaks, own.ctrl - (ends[:-1, None] + share * (ends[1:] - ends[:-1])[:, None]))


def rate_seen_from(curve: Piecewise, track: Track) -> Piecewise:
    """Return the derivative of a curve of channels x, y, z minus the velocity of the motion, exactly."""
    own = restrict(curve.derivative(), _common(curve, track))
    middle = 0.5 * (own.breaks[:-1] + own.breaks[1:])
    return Piecewise(own.breaks, own.ctrl - velocities(track, middle)[:, None])


def velocities(track: Track, t: Array) -> Array:
    """Return the velocities of the target at times (M,), m/s, shape (M, 3); at a row, that after it."""
    times, points = np.array(track.times), np.array(track.points)
    slopes = np.diff(points, axis=0) / np.diff(times)[:, None]
    stretches = np.concatenate([np.zeros((1, 3)), slopes, [track.after]])
    return np.asarray(stretches[np.searchsorted(times, t, side="right")])


def _common(curve: Piecewise, track: Track) -> Array:
    rows = np.array(track.times)
    return np.union1d(curve.breaks, rows[(rows > curve.start) & (rows < curve.end)])
