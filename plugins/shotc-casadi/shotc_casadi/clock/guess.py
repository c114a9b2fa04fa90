"""An initial guess that looks past occluders: over them or to either side.

Straight behind an occluder no way out of its shadow is shorter than another, so the guess has to choose.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import Array, Drone, IntArray, Mask, quintic_hermite
from shotc_casadi.clock.occluders import Occluder, occlusion_at
from shotc_casadi.clock.references import ClockReferences

CLEAR_DV = -0.1  # of d_v, which a guess reaches if it can
TRIES_PER_SIDE = 20  # steps to each side, up to the usual distance to the subject
BRIDGED_S = 1.0  # hidden intervals with a shorter gap between them are passed on one side, seconds
SPREAD_S = 3.0  # least time in which the guess moves aside before such an interval, and back after it
STEP_PEAKS = (15 / 8, 10 / sqrt(3), 60.0)
"""Largest derivatives of order 1 to 3 of a minimum-jerk step of 1 in a time of 1."""


def guess_past(
    curve: Piecewise,
    references: ClockReferences,
    occluders: Sequence[Occluder],
    filmed: Mask,
    drone: Drone,
) -> Piecewise:
    """Return a position curve that moves aside where the subject is hidden in the film; its ends stay.

    It moves aside no faster than the limits allow, so near an end it may still be hidden.
    """
    if not occluders:
        return curve
    breaks = curve.breaks
    hidden = filmed & (occlusion_at(occluders, references, curve(breaks)) > 0.0)
    values = [curve(breaks), *(curve.derivative(order)(breaks) for order in (1, 2))]
    at = np.flatnonzero(hidden)
    for run in np.split(at, np.flatnonzero(np.diff(breaks[at]) > BRIDGED_S) + 1) if len(at) else []:
        detour = _way_out(curve(breaks), references, occluders, run)
        seconds = least_time(detour, drone)
        bump = step_aside(breaks, (float(breaks[run[0]]), float(breaks[run[-1]])), seconds)
        for order in range(3):
            values[order] = values[order] + bump[order][:, None] * detour
    return quintic_hermite(breaks, *values)


def _way_out(eyes: Array, references: ClockReferences, occluders: Sequence[Occluder], run: IntArray) -> Array:
    """Return the shortest offset out of the shadow for all nodes of a run, W, metres, shape (3,)."""
    ray = (references.target[run, :3] - eyes[run]).mean(axis=0)
    side = np.array([-ray[1], ray[0], 0.0]) / max(float(np.hypot(ray[0], ray[1])), 1e-6)
    best, least = np.zeros(3), float(occlusion_at(occluders, references, eyes)[run].max())
    for far in references.usual * np.arange(1, TRIES_PER_SIDE + 1) / TRIES_PER_SIDE:
        for detour in (far * np.array([0.0, 0.0, 1.0]), far * side, -far * side):
            occlusion = float(occlusion_at(occluders, references, eyes + detour)[run].max())
            if occlusion < least:
                best, least = detour, occlusion
        if least < CLEAR_DV:
            break
    return best


def least_time(detour: Array, drone: Drone) -> float:
    """Return the time of a minimum-jerk step by an offset, shape (3,), and back that keeps the limits, s."""
    limits, distance = drone.limits, float(np.linalg.norm(detour))
    steps = (
        (STEP_PEAKS[0] * float(np.hypot(*detour[:2])) / limits.speed, 1),
        (STEP_PEAKS[0] * abs(float(detour[2])) / min(limits.climb, limits.descent), 1),
        (STEP_PEAKS[1] * distance / limits.usable_acceleration, 2),
        (STEP_PEAKS[2] * distance / limits.jerk, 3),
    )
    return max(SPREAD_S, *(float(ratio ** (1.0 / order)) for ratio, order in steps))


def step_aside(breaks: Array, span: tuple[float, float], seconds: float) -> list[Array]:
    """Return a smooth step to 1 up to a time span and back after it, with its first two derivatives, (M,)
    each.

    seconds : of each step. One that would begin before the curve, or end after it, reaches into the span.
    """
    seconds = min(seconds, 0.5 * float(breaks[-1] - breaks[0]))
    begin, end = np.clip(span, breaks[0] + seconds, breaks[-1] - seconds)
    before, after = (begin - breaks) / seconds, (breaks - end) / seconds
    rising = before > after
    x = np.clip(np.maximum(before, after), 0.0, 1.0)
    rate = np.where(rising, -1.0, 1.0) / seconds
    inside = (x > 0.0) & (x < 1.0)
    step = np.polynomial.Polynomial([1.0, 0.0, 0.0, -10.0, 15.0, -6.0])
    slopes = (np.where(inside, step.deriv(order)(x) * rate**order, 0.0) for order in (1, 2))
    return [step(x), *slopes]
