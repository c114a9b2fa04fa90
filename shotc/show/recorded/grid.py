"""Control points taken from tracks, and how far the spline that they make is from these.

The control points c_k = p(s_k) of a cubic B-spline, p a track and s_k evenly rising times of its file, one
set for all drones. Over even breaks its derivatives are means of the track's own, so that what keeps its
limits keeps them (the variation-diminishing spline of Schoenberg; de Boor, *A Practical Guide to Splines*,
ch. XI). Where a flight stops, three of them are equal.

How far it is off, proved for any breaks. With N_k(t) the basis, the common clock is s(t) = sum N_k(t) s_k.
Let L be the polyline through (s_k, c_k). On one piece four control points count, s_0 to s_3, and L has
corners at s_1 and s_2 only, whose slopes step by J_1, J_2. As sum N_k (s_k - s) = 0, a line is met exactly,
and |q(t) - L(s(t))| <= |J_1| e_1(t) + |J_2| e_2(t), e_m = sum N_k (s_k - s_m)_+ - (s - s_m)_+, both terms of
which do not fall in t: their values at the ends of short spans bound e_m from above. How far L is from the
track follows from control points: on each span between breaks of either, the difference is a cubic. Where the
clock is that of the file, so is q(t) - p(t), which is nearer.
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
"""Seconds of the file's clock from control point to control point, at least."""
PIECE_SPANS = 64
"""Of a piece, in which the distance from the polyline is bounded."""
TINY_S = 1e-9


def step_of(step: float, slower: float = 1.0) -> float:
    """Return seconds between control points for a file whose rows are a step apart, s: whole steps of it.

    slower : by how much the flight takes longer than the file
    """
    wanted = PIECE_S / slower
    return wanted if step <= 0.0 else step * max(1, round(wanted / step))


def sources(start: float, end: float, step: float, rests: tuple[bool, bool]) -> Array:
    """Return the times of a file that control points are taken from, (K,), rising.

    rests : whether everybody rests at the start and at the end; then the clock of the flight is the file's.
    Else the flight stops there, and its clock sets out one step later
    """
    count = max(ceil((end - start) / step - TINY_S), 1)
    first, last = (2 if rest else 1 for rest in rests)
    inner = start + step * np.arange(first, count - last + 1)
    return np.concatenate([np.full(DEGREE, start), inner, np.full(DEGREE, end)])


def points_of(tracks: Sequence[RecordedTrack], times: Array) -> Array:
    """Return where all drones are at times of the file, (n, K, 3)."""
    return np.stack([track.curve(times) for track in tracks])


def bound(tracks: Sequence[RecordedTrack], times: Array, breaks: Array, coef: Array) -> tuple[float, int]:
    """Return how far a flight is from the tracks at most, metres, and whose it is.

    times : of the file, of its control points; breaks, coef : of the flight
    """
    if np.allclose(times[DEGREE:-DEGREE], breaks[2:-2], rtol=0.0, atol=TINY_S):
        own = pieces(breaks, coef)
        off = np.array(
            [_off(track.curve, Piecewise(breaks, row)) for track, row in zip(tracks, own, strict=True)]
        )
        worst = int(np.argmax(off))
        return float(off[worst]), worst
    off = _from_polyline(times, breaks, coef)
    off = off + np.array(
        [_off_track(track.curve, times, row) for track, row in zip(tracks, coef, strict=True)]
    )
    worst = int(np.argmax(off))
    return float(off[worst]), worst


def _off(curve: Piecewise, flown: Piecewise) -> float:
    """Return how far a flight is from its track at the same time, at most, metres."""
    inner = curve.breaks[(curve.breaks > flown.start) & (curve.breaks < flown.end)]
    marks = _apart(np.concatenate([flown.breaks, inner]))
    return float(norm(between(curve, marks) - between(flown, marks)).max())


def _apart(marks: Array) -> Array:
    """Return times in their order, without those that are next to the same."""
    rising = np.unique(marks)
    return np.asarray(rising[np.concatenate([[True], np.diff(rising) > TINY_S])])


def _from_polyline(times: Array, breaks: Array, coef: Array) -> Array:
    """Return how far every drone is from its polyline at the same time of the file, at most, (n,), metres."""
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
    """Return on every piece and span an upper bound of e_m of the module's docstring, (P, SPANS), s."""
    at, clock = of
    share = np.linspace(0.0, 1.0, at.shape[1])
    four = np.lib.stride_tricks.sliding_window_view(times, 4)
    corner = four[:, m : m + 1]
    above = np.maximum(four - corner, 0.0)
    mean = np.einsum("pms,ps->pm", _basis(breaks, share), above)
    found = mean[:, 1:] - np.maximum(clock[:, :-1] - corner, 0.0)
    return np.asarray(np.maximum(found, 0.0))


def _basis(breaks: Array, share: Array) -> Array:
    """Return the four basis functions of every piece at shares of it, (P, M, 4)."""
    at = breaks[:-1, None] + share * np.diff(breaks)[:, None]
    inside = np.clip(at, breaks[:-1, None], np.nextafter(breaks[1:, None], -np.inf))
    matrix = BSpline.design_matrix(inside.ravel(), knots(breaks), DEGREE)
    found: Array = np.array(matrix.data, dtype=np.float64).reshape(*at.shape, DEGREE + 1)
    return found


def _off_track(curve: Piecewise, times: Array, points: Array) -> float:
    """Return how far the polyline of one drone is from its track at the same time of the file, metres."""
    start, end = float(times[0]), float(times[-1])
    keys, first = np.unique(times, return_index=True)
    inner = curve.breaks[(curve.breaks > start) & (curve.breaks < end)]
    marks = _apart(np.concatenate([keys, inner]))
    line = np.stack([np.interp(marks, keys, points[first, k]) for k in range(3)], axis=1)
    straight = line[:-1, None] + np.linspace(0.0, 1.0, 4)[:, None] * np.diff(line, axis=0)[:, None]
    return float(norm(between(curve, marks) - straight).max(initial=0.0))


def between(curve: Piecewise, marks: Array) -> Array:
    """Return the control points (M, 4, 3) of a cubic on the spans between marks, of which each is in a piece.

    They are values of the blossom of the piece (Farin, *Curves and Surfaces for CAGD*, ch. 4); after its last
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


def _blossom(ctrl: Array, at: tuple[Array, Array, Array]) -> Array:
    for share in at:
        x = share[:, None, None]
        ctrl = (1.0 - x) * ctrl[:, :-1] + x * ctrl[:, 1:]
    return np.asarray(ctrl[:, 0])
