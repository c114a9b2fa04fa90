"""The motion of a target for many times at once, and curves as seen from it."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict
from shotc.geom.track import Track


def places(track: Track, t: Array) -> Array:
    """Return where the target is at times of shape (M,), metres; shape (M, 3)."""
    times, points = np.array(track.times), np.array(track.points)
    inside = np.column_stack([np.interp(t, times, points[:, k]) for k in range(3)])
    return np.asarray(inside + np.maximum(t - times[-1], 0.0)[:, None] * np.array(track.after))


def seen_from(curve: Piecewise, track: Track) -> Piecewise:
    """Return a curve of channels x, y, z less the motion, exactly, on breaks that hold the track's rows.

    A target moves evenly between rows, so on each piece both are polynomials.
    """
    rows = np.array(track.times)
    inside = rows[(rows > curve.start) & (rows < curve.end)]
    near = np.searchsorted(curve.breaks, inside)
    gap = np.minimum(
        np.abs(curve.breaks[np.minimum(near, len(curve.breaks) - 1)] - inside),
        inside - curve.breaks[near - 1],
    )
    breaks = np.union1d(curve.breaks, inside[gap > 1e-9 * (curve.end - curve.start)])
    own = restrict(curve, breaks)
    ends = places(track, breaks)
    share = np.linspace(0.0, 1.0, own.degree + 1)[:, None]
    return Piecewise(breaks, own.ctrl - (ends[:-1, None] + share * (ends[1:] - ends[:-1])[:, None]))
