"""The field of view along a shot, from keyframe to keyframe."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, quintic_hermite
from shotc.ir.keyframes import PlacedKeyframe


def lens_line(keyframes: Sequence[PlacedKeyframe], at: Array) -> Piecewise:
    """Return the field of view over s: monotone between keyframes, with zero slope at placed ones.

    Generated keyframes between which the zoom continues have the slope of the parabola through them and their
    neighbours (at the ends, through the last three). It is at most 5/4 of the smaller slope of the two
    neighbouring chords: then the control points of the quintics stay in order.

    at : path parameters of the keyframes, (K,), not decreasing
    """
    keys = [i for i in range(len(at)) if i == 0 or at[i] > at[i - 1]]
    s, wide = at[keys], np.array([keyframes[i].hfov for i in keys])
    slope = np.zeros(len(keys))
    if len(keys) > 2:
        placed = np.array([keyframes[i].placed for i in keys])
        secant = np.diff(wide) / np.diff(s)
        before, after = np.concatenate([secant[:1], secant]), np.concatenate([secant, secant[-1:]])
        goes_on = ~placed & (before * after > 0.0)
        wished = np.gradient(wide, s, edge_order=2)
        most = 1.25 * np.minimum(np.abs(before), np.abs(after))
        slope = np.where(goes_on, np.sign(before) * np.clip(np.sign(before) * wished, 0.0, most), 0.0)
    still = np.zeros((len(keys), 1))
    return quintic_hermite(s, wide[:, None], slope[:, None], still)
