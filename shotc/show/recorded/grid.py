"""Takes control points from tracks, and bounds the distance between their spline and the tracks.

The control points of a cubic B-spline are c_k = p(s_k), with a track p and uniform times s_k of its file, the
same for all drones. Over uniform breaks, derivatives of the spline are means of the track's own, so a track
within the limits gives a spline within the limits (the variation-diminishing spline of Schoenberg; de Boor,
*A Practical Guide to Splines*, ch. XI). Where a flight stops, three of the points are equal.

The distance is proved for any breaks. With the basis N_k(t), the common clock is s(t) = sum N_k(t) s_k. Let L
be the polyline through (s_k, c_k). One piece depends on four control points, s_0 to s_3. L has corners only
at s_1 and s_2, where its slope changes by J_1 and J_2. Because sum N_k (s_k - s) = 0, a line is reproduced
exactly, and |q(t) - L(s(t))| <= |J_1| e_1(t) + |J_2| e_2(t), with e_m = sum N_k (s_k - s_m)_+ - (s - s_m)_+.
Neither term decreases in t, so their values at the ends of short spans bound e_m from above. The distance of
L from the track follows from control points: on each span between breaks of either, the difference is a
cubic. If the clock is that of the file, q(t) - p(t) is a cubic as well, and this bound is smaller.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import numpy as np
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.fleet_spline import DEGREE, knots, pieces, places
from shotc.geom.proof import norm
from shotc.show.recorded.tracks import RecordedTrack

PIECE_S = 0.25
"""Least time between control points by the file's clock."""
PIECE_SPANS = 64
"""Spans of a piece, in which the distance from the polyline is bounded."""
TINY_S = 1e-9


def step_of(step: float, slower: float = 1.0) -> float:
    """Return the time between control points, s, a whole number of the file's row intervals.

    step : interval of the file's rows, s
    slower : duration of the flight over that of the file
    """
    ideal = PIECE_S / slower
    return ideal if step <= 0.0 else step * max(1, round(ideal / step))


def sources(start: float, end: float, step: float, rests: tuple[bool, bool]) -> Array:
    """Return the times of a file from which control points are taken, (K,), non-decreasing.

    rests : whether all drones rest at the start and at the end; then the flight has the file's clock there.
        Else the flight stops there, and its clock starts one step later
    """
    count = max(ceil((end - start) / step - TINY_S), 1)
    first, last = (2 if rest else 1 for rest in rests)
    inner = start + step * np.arange(first, count - last + 1)
    return np.concatenate([np.full(DEGREE, start), inner, np.full(DEGREE, end)])


def points_of(tracks: Sequence[RecordedTrack], times: Array) -> Array:
    """Return the positions of all drones at times (K,) of the file, (n, K, 3)."""
    return np.stack([track.curve(times) for track in tracks])


def bound(tracks: Sequence[RecordedTrack], times: Array, breaks: Array, coef: Array) -> float:
    """Return the largest distance between a flight and its tracks, proved, m.

    times : of the file, for its control points, shape (K,)
    breaks, coef : of the flight, shapes (P + 1,) and (n, K, 3)
    """
    if np.allclose(times[DEGREE:-DEGREE], breaks[2:-2], rtol=0.0, atol=TINY_S):
        own = pieces(breaks, coef)
        return max(_off(track.curve, Piecewise(breaks, row)) for track, row in zip(tracks, own, strict=True))
    off = _from_polyline(times, breaks, coef)
    off = off + np.array(
        [_off_track(track.curve, times, row) for track, row in zip(tracks, coef, strict=True)]
    )
    return float(off.max())


def _off(curve: Piecewise, flown: Piecewise) -> float:
    """Return a bound of the distance between a flight and its track at the same time, m."""
    inner = curve.breaks[(curve.breaks > flown.start) & (curve.breaks < flown.end)]
    marks = _apart(np.concatenate([flown.breaks, inner]))
    return float(norm(between(curve, marks) - between(flown, marks)).max())


def _apart(marks: Array) -> Array:
    """Return times in order, without near duplicates."""
    rising = np.unique(marks)
    return np.asarray(rising[np.concatenate([[True], np.diff(rising) > TINY_S])])


def _from_polyline(times: Array, breaks: Array, coef: Array) -> Array:
    """Return bounds of the distance of every drone from its polyline at the same time of the
    file, (n,), m.
    """
    share = np.linspace(0.0, 1.0, PIECE_SPANS + 1)
    at = breaks[:-1, None] + share * np.diff(breaks)[:, None]
    clock = _scalar(breaks, times, at)
    bends = [_excess(breaks, times, (at, clock), m) for m in (1, 2)]
    gaps = np.diff(times)
    safe = np.where(gaps > TINY_S, gaps, np.inf)
    slopes = np.diff(coef, axis=1) / safe[None, :, None]
    steps = norm(np.diff(slopes, axis=1))
    one, other = steps[:, :-1], steps[:, 1:]
    worst = np.zeros(len(coef))
    for k in range(PIECE_SPANS):
        worst = np.maximum(worst, (one * bends[0][:, k] + other * bends[1][:, k]).max(axis=1))
    return worst


def _scalar(breaks: Array, values: Array, at: Array) -> Array:
    """Return the spline of scalar control points (K,) at times (P, M)."""
    row = np.repeat(values[None, :, None], 3, axis=2)
    return np.asarray(places(breaks, row, at.ravel())[0, :, 0].reshape(at.shape))


def _excess(breaks: Array, times: Array, of: tuple[Array, Array], m: int) -> Array:
    """Return an upper bound of e_m of the module's docstring for every piece and span, (P, SPANS), s."""
    at, clock = of
    share = np.linspace(0.0, 1.0, at.shape[1])
    four = np.lib.stride_tricks.sliding_window_view(times, 4)
    corner = four[:, m : m + 1]
    above = np.maximum(four - corner, 0.0)
    mean = np.einsum("pms,ps->pm", _basis(breaks, share), above)
    excess = mean[:, 1:] - np.maximum(clock[:, :-1] - corner, 0.0)
    return np.asarray(np.maximum(excess, 0.0))


def _basis(breaks: Array, share: Array) -> Array:
    """Return the four basis functions of every piece at fractions of it, (P, M, 4)."""
    at = breaks[:-1, None] + share * np.diff(breaks)[:, None]
    inside = np.clip(at, breaks[:-1, None], np.nextafter(breaks[1:, None], -np.inf))
    matrix = BSpline.design_matrix(inside.ravel(), knots(breaks), DEGREE)
    values: Array = np.array(matrix.data, dtype=np.float64).reshape(*at.shape, DEGREE + 1)
    return values


def _off_track(curve: Piecewise, times: Array, points: Array) -> float:
    """Return a bound of the distance of one drone's polyline from its track at the same time of
    the file, m.
    """
    start, end = float(times[0]), float(times[-1])
    keys, first = np.unique(times, return_index=True)
    inner = curve.breaks[(curve.breaks > start) & (curve.breaks < end)]
    marks = _apart(np.concatenate([keys, inner]))
    line = np.stack([np.interp(marks, keys, points[first, k]) for k in range(3)], axis=1)
    straight = line[:-1, None] + np.linspace(0.0, 1.0, 4)[:, None] * np.diff(line, axis=0)[:, None]
    return float(norm(between(curve, marks) - straight).max(initial=0.0))


def between(curve: Piecewise, marks: Array) -> Array:
    """Return the control points (M, 4, 3) of a cubic on the spans between marks, each inside a piece.

    They are values of the piece's blossom (Farin, *Curves and Surfaces for CAGD*, ch. 4). After its last
    break a curve is constant.
    """
    low, high = np.minimum(marks[:-1], curve.end), np.minimum(marks[1:], curve.end)
    piece = np.clip(
        np.searchsorted(curve.breaks, (low + high) / 2.0, side="right") - 1, 0, len(curve.ctrl) - 1
    )
    origin, width = curve.breaks[piece], np.diff(curve.breaks)[piece]
    u, v = (low - origin) / width, (high - origin) / width
    ctrl = curve.ctrl[piece]
    return np.stack([_blossom(ctrl, args) for args in ((u, u, u), (u, u, v), (u, v, v), (v, v, v))], axis=1)


def _blossom(ctrl: Array, at: Sequence[Array]) -> Array:
    """Return the blossom of cubics (M, 4, 3) at three arguments, (M,) each."""
    for share in at:
        x = share[:, None, None]
        ctrl = (1.0 - x) * ctrl[:, :-1] + x * ctrl[:, 1:]
    return np.asarray(ctrl[:, 0])
