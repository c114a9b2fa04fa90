"""Monotone curves from keyframe to keyframe: angles of cameras that follow no target, and fields of view."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, quintic_hermite
from shotc.ir.keyframes import PlacedKeyframe

STEEPEST_RATIO = 1.25  # largest slope over the chord's, for a monotone quintic


def steady(at: Array, value: Array) -> Piecewise:
    """Return the C2 quintics through values at parameters, monotone between neighbours, one channel.

    Slopes are weighted harmonic means of the neighbouring chords' (Fritsch and Butland, A method for
    constructing local monotone piecewise cubic interpolants). They are limited so that quintics with zero
    second derivative at their ends stay monotone. Turns of constant rate are reproduced.

    at : shape (K,), increasing, K >= 2
    value : shape (K,)
    """
    h = np.diff(at)
    slope = _slopes(h, np.diff(value) / h)
    step = (h / 5.0)[:, None] * np.array([0.0, 1.0, 2.0])
    left = value[:-1, None] + step * slope[:-1, None]
    right = value[1:, None] - step[:, ::-1] * slope[1:, None]
    return Piecewise(at, np.concatenate([left, right], axis=1)[:, :, None])


def _slopes(h: Array, chord: Array) -> Array:
    if len(h) == 1:
        return np.repeat(chord, 2)
    h0, h1, d0, d1 = h[:-1], h[1:], chord[:-1], chord[1:]
    least = np.minimum(np.abs(d0), np.abs(d1))
    agree = d0 * d1 > 0
    safe0, safe1 = np.where(agree, np.abs(d0), 1.0), np.where(agree, np.abs(d1), 1.0)
    mean = 3 * (h0 + h1) / ((2 * h1 + h0) / safe0 + (h1 + 2 * h0) / safe1)
    inner = np.where(agree, np.sign(d0) * np.minimum(mean, STEEPEST_RATIO * least), 0.0)
    ends = (_end(chord[0], inner[0]), _end(chord[-1], inner[-1]))
    return np.concatenate([ends[:1], inner, ends[1:]])


def _end(chord: float, inner: float) -> float:
    """Return the slope at an outer end: that of a turn with a constant change of rate, within its limits."""
    return float(
        np.sign(chord) * np.clip((3 * abs(chord) - abs(inner)) / 2, 0.0, STEEPEST_RATIO * abs(chord))
    )


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
