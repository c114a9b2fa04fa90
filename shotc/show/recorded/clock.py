"""Slows down a recorded flight where its drones would exceed a limit, equally for all drones.

The control points stay, and the intervals between breaks grow. A piece grows by the need of the drones'
control points on it: a velocity's by its ratio to the limit, an acceleration's by the square root of its
ratio, a jerk's by the cube root, because derivatives decrease in this way with time. Before and after a slow
part, the logarithm of the clock's rate changes linearly, by 1 in ``EASE_RATIO`` times the duration of braking
from full speed, with rounded corners. So the clock's own acceleration is small, and its contribution
decreases as pieces grow. This is repeated until no control point of any derivative exceeds a limit, which
proves all limits for all times. Stretching all pieces equally needs no repetition. The shorter result of both
is taken.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE, knots
from shotc.ir.limits import Limits

EASE_RATIO = 0.5
"""Time in which the clock's rate changes by a factor of e, over the time of braking from full speed."""
SMOOTHED_PIECES = 2
"""Pieces on either side over which the logarithm of a stretch is averaged."""
MOST_ROUNDS = 200
SLACK_SHARE = 1e-9
"""Share of a limit by which rounding may exceed it."""
OVER_SHARE = 1e-4
"""Share by which pieces grow beyond their lack, so that the iterations end."""
LEEWAY_SHARE = 0.05
"""Largest share of a limit that is granted for the rounding of a file."""


class Need(NamedTuple):
    """The drone that needs most time: its row, the limit's name, its value there, the limit, the piece.

    factor : by which the piece would have to last longer
    """

    drone: int
    limit: str
    value: float
    most: float
    piece: int
    factor: float


class RecordedClock(NamedTuple):
    """The breaks of the flight, s, and what needed more time than the file has, or None."""

    breaks: Array
    need: Need | None


def clocked(coef: Array, step: float, limits: Limits, rounding: float) -> RecordedClock:
    """Return the clock of a flight.

    coef : control points, shape (n, K, 3)
    step : duration of every piece by the file's clock, s
    rounding : how far the file's rounding may move positions, m
    """
    granted = _granted(limits, step, rounding)
    count = coef.shape[1] - DEGREE
    widths = np.full(count, step)
    need = worst(widths, coef, granted)
    if need.factor <= 1.0 + SLACK_SHARE:
        return RecordedClock(_breaks(widths), None)
    alike = widths * need.factor * (1.0 + OVER_SHARE)
    stretched = _stretched(widths, coef, granted)
    best = alike if stretched is None or stretched.sum() >= alike.sum() else stretched
    return RecordedClock(_breaks(best), need)


def _breaks(widths: Array) -> Array:
    return np.round(np.concatenate([[0.0], np.cumsum(widths)]), 9)


def _granted(limits: Limits, step: float, rounding: float) -> Limits:
    """Return limits increased by what rounded positions may add: this is noise of the file, not of the
    flight.
    """
    noise = 2.0 * rounding / step
    share = [1.0 + min(noise / most, LEEWAY_SHARE) for most in (limits.speed, limits.climb, limits.descent)]
    bent = 1.0 + min(2.0 * noise / step / limits.usable_acceleration, LEEWAY_SHARE)
    jerked = 1.0 + min(4.0 * noise / step**2 / limits.jerk, LEEWAY_SHARE)
    return limits._replace(
        speed=limits.speed * share[0],
        climb=limits.climb * share[1],
        descent=limits.descent * share[2],
        acceleration=limits.usable_acceleration * bent,
        jerk=limits.jerk * jerked,
    )


def _stretched(widths: Array, coef: Array, limits: Limits) -> Array | None:
    """Return the pieces' durations, stretched locally, or None if the iterations do not end."""
    slope = widths[0] / (EASE_RATIO * limits.speed / limits.usable_acceleration)
    grown = np.zeros(len(widths))
    for _ in range(MOST_ROUNDS):
        lacks = needs(widths * np.exp(grown), coef, limits)
        if lacks.max() <= 1.0 + SLACK_SHARE:
            return np.asarray(widths * np.exp(grown))
        aim = grown + np.log(np.maximum(lacks, 1.0)) + OVER_SHARE * (lacks > 1.0 + SLACK_SHARE)
        grown = np.maximum(grown, _eased(aim, slope))
    return None


def _eased(aim: Array, slope: float) -> Array:
    """Return a curve above ``aim`` (P,) that changes by at most ``slope`` per piece, with rounded corners.

    It is the moving average of local maxima of the least such curve, so it is not below ``aim``.
    """
    index = np.arange(len(aim)) * slope
    rising = np.maximum.accumulate(aim + index) - index
    falling = np.maximum.accumulate((aim - index)[::-1])[::-1] + index
    hull = np.pad(np.maximum(rising, falling), 2 * SMOOTHED_PIECES, mode="edge")
    window = np.lib.stride_tricks.sliding_window_view(hull, 2 * SMOOTHED_PIECES + 1).max(axis=1)
    return np.asarray(
        np.convolve(window, np.full(2 * SMOOTHED_PIECES + 1, 1.0 / (2 * SMOOTHED_PIECES + 1)), "valid")
    )


def needs(widths: Array, coef: Array, limits: Limits) -> Array:
    """Return the factor by which every piece lacks time, (P,), at most 1 if it does not."""
    ratios = np.zeros(len(widths))
    for order, share in _shares(widths, coef, limits):
        # Pieces k - 2 to k affect the control point between k and k + 1; the middle ones are stretched.
        most = share.max(axis=0)
        for back in {1: (1,), 2: (1, 0), 3: (0,)}[order]:
            piece = np.clip(np.arange(len(most)) - back, 0, len(widths) - 1)
            np.maximum.at(ratios, piece, most)
    return ratios


def worst(widths: Array, coef: Array, limits: Limits) -> Need:
    """Return the drone and the limit that need most time.

    widths : of the pieces, (P,), seconds; coef : (n, P + 3, 3), metres
    """
    best = Need(0, "speed", 0.0, limits.speed, 0, 0.0)
    for order, share in _shares(widths, coef, limits):
        drone, k = (int(i) for i in np.unravel_index(int(np.argmax(share)), share.shape))
        if share[drone, k] > best.factor:
            piece = int(np.clip(k - (order == 1), 0, len(widths) - 1))
            value = _derivative(widths, coef[drone : drone + 1], order)[0, k]
            used = _used(value, order, limits)
            best = Need(drone, used.limit, used.size, used.most, piece, float(share[drone, k]))
    return best


class _Used(NamedTuple):
    """A limit in words, the size of what it limits, and the limit itself, SI."""

    limit: str
    size: float
    most: float


def _used(value: Array, order: int, limits: Limits) -> _Used:
    """Return the limit of a derivative that is used most; value : shape (3,)."""
    if order == 1:
        across, up = float(np.hypot(value[0], value[1])), float(value[2])
        each = [
            _Used("speed", across, limits.speed),
            _Used("climb", up, limits.climb),
            _Used("descent", -up, limits.descent),
        ]
        return max(each, key=lambda one: one.size / one.most)
    size = float(np.linalg.norm(value))
    if order == 2:
        return _Used("acceleration", size, limits.usable_acceleration)
    return _Used("jerk", size, limits.jerk)


def _shares(widths: Array, coef: Array, limits: Limits) -> list[tuple[int, Array]]:
    """Return, for each derivative, the factors of time that its control points need, (n, R)."""
    shares = []
    for order in (1, 2, 3):
        values = _derivative(widths, coef, order)
        if order == 1:
            across = np.hypot(values[..., 0], values[..., 1]) / limits.speed
            up, down = values[..., 2] / limits.climb, -values[..., 2] / limits.descent
            shares.append((1, np.maximum(across, np.maximum(up, down))))
            continue
        size = np.sqrt(np.einsum("nrd,nrd->nr", values, values))
        limit = limits.usable_acceleration if order == 2 else limits.jerk
        shares.append((order, np.asarray((size / limit) ** (1.0 / order))))
    return shares


def _derivative(widths: Array, coef: Array, order: int) -> Array:
    """Return the control points of a derivative, (n, K - order, 3), like ``fleet_spline.differences``."""
    t, values = knots(np.concatenate([[0.0], np.cumsum(widths)])), coef
    for k in range(order):
        degree = DEGREE - k
        inner = t[k : len(t) - k]
        spans = inner[degree + 1 : len(inner) - 1] - inner[1 : len(inner) - degree - 1]
        values = np.diff(values, axis=1) * (degree / spans)[None, :, None]
    return np.asarray(values)
