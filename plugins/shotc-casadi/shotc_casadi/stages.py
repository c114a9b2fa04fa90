"""The stages of a shot: its nodes along the reference path, and an initial guess of the motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from shotc.plugin_api import MovingLeg
from shotc.plugin_api.refiner import Array, Drone, PlacedShot, rough_times
from shotc_casadi.place_times import place_times

USUAL_STAGES = 100
STAGES_PER_INTERVAL = 12
MOST_STAGES = 400
APART_SHARE = 1e-9  # of a path: places nearer to each other are the same


@dataclass(frozen=True, slots=True, eq=False)
class Stages:
    """Nodes of one shot.

    s : path parameter, shape (N + 1,)
    t : seconds of the initial guess (without holds), shape (N + 1,)
    pins : indices of the nodes where the position binds: keyframes of the author, rests and ends
    """

    s: Array
    t: Array
    pins: np.ndarray


def stages(leg: MovingLeg, placed: PlacedShot, drone: Drone, count: int | None) -> Stages:
    """Return nodes at equal times under a simple speed profile, with one at every place that binds.

    count : number of stages, or None for as many as those places need
    """
    curve = leg.curve
    assert curve is not None
    pins = _pins(leg, placed)
    count = count or int(np.clip(STAGES_PER_INTERVAL * (len(pins) - 1), USUAL_STAGES, MOST_STAGES))
    deadlines = place_times(leg)
    fine, t = rough_times(drone, leg, leg.most if deadlines else leg.pace)
    if deadlines:
        t = deadlines.kept(fine, t, leg.pace)
    knots = np.interp(pins, fine, t)
    shares = _shares(knots, count)
    parts = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(knots[:-1], knots[1:], shares, strict=True)
    ]
    at = np.append(np.concatenate(parts), knots[-1])
    s = PchipInterpolator(t, fine)(at)
    index = np.concatenate([[0], np.cumsum(shares)])
    s[index] = pins
    return Stages(s, at, index)


def _pins(leg: MovingLeg, placed: PlacedShot) -> Array:
    put = {m.s for m in leg.marks if placed.keyframes[m.index].placed}
    every = sorted(put | {stop.s for stop in leg.stops} | {leg.curve.start, leg.curve.end})
    apart = APART_SHARE * (every[-1] - every[0])
    return np.array([s for i, s in enumerate(every) if i == 0 or s > every[i - 1] + apart])


def _shares(knots: Array, count: int) -> np.ndarray:
    """Distribute stages over the intervals by their duration, at least two each."""
    references = count * np.diff(knots) / (knots[-1] - knots[0])
    shares = np.maximum(2, np.floor(references)).astype(int)
    while shares.sum() < count:
        shares[int((references - shares).argmax())] += 1
    return np.asarray(shares)
