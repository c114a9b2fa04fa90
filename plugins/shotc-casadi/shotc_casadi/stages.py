"""The stages of a shot: where along the reference path the nodes stand, and a first guess of the motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from shotc.geom.bernstein import Array
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import Drone
from shotc.ir.path import Leg
from shotc.passes.parameterize_time.grid import evened, rough_profile
from shotc.passes.parameterize_time.leg import plan_of
from shotc.passes.parameterize_time.limits import ceiling_of
from shotc.passes.parameterize_time.move import axes_of

STAGES = 100
PER_INTERVAL = 12
MOST = 400
APART = 1e-9  # of a path: places nearer to each other are one
LEAST_SPEED = 1e-3  # m/s


@dataclass(frozen=True, slots=True, eq=False)
class Stages:
    """Nodes of one shot.

    s, t : shape (N + 1,), path parameter and seconds (without holds) of the first guess
    pins : indices of the nodes at keyframes and stops, ends included
    bound : those of them at which the position binds: the author put it there, or the drone rests
    """

    s: Array
    t: Array
    pins: np.ndarray
    bound: np.ndarray


def stages(leg: Leg, placed: PlacedShot, drone: Drone, count: int | None) -> Stages:
    """Return nodes evenly in time under a simple speed profile, with one at every keyframe and stop.

    count : how many stages, or None for as many as the keyframes need
    """
    curve = leg.curve
    assert curve is not None
    pins = _pins(leg)
    count = count or int(np.clip(PER_INTERVAL * (len(pins) - 1), STAGES, MOST))
    fine, t = _profile(leg, drone)
    knots = np.interp(pins, fine, t)
    shares = _shares(knots, count)
    parts = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(knots[:-1], knots[1:], shares, strict=True)
    ]
    at = np.append(np.concatenate(parts), knots[-1])
    s = PchipInterpolator(t, fine)(at)
    index = np.concatenate([[0], np.cumsum(shares)])
    s[index] = pins
    binding = {m.s for m in leg.marks if placed.keyframes[m.index].placed} | {stop.s for stop in leg.stops}
    bound = np.array([any(abs(pin - b) <= APART * pins[-1] for b in binding) for pin in pins])
    return Stages(s, at, index, index[bound])


def _pins(leg: Leg) -> Array:
    assert leg.curve is not None
    every = sorted(
        {m.s for m in leg.marks} | {stop.s for stop in leg.stops} | {leg.curve.start, leg.curve.end}
    )
    apart = APART * (every[-1] - every[0])
    return np.array([s for i, s in enumerate(every) if i == 0 or s > every[i - 1] + apart])


def _shares(knots: Array, count: int) -> np.ndarray:
    """Share stages out among the intervals by their time, at least two each."""
    wanted = count * np.diff(knots) / (knots[-1] - knots[0])
    shares = np.maximum(2, np.floor(wanted)).astype(int)
    while shares.sum() < count:
        shares[int((wanted - shares).argmax())] += 1
    return np.asarray(shares)


def _profile(leg: Leg, drone: Drone) -> tuple[Array, Array]:
    """Return parameters and seconds: the time pass's own first guess, from stop to stop."""
    curve = leg.curve
    assert curve is not None
    pace = leg.pace if leg.duration is None else 1.0
    ceiling = ceiling_of(drone).scaled(pace)
    at, times = [np.array([curve.start])], [np.zeros(1)]
    for start, end in plan_of(leg).spans:
        s, b = rough_profile(curve, start, end, axes_of(curve, (start, end), ceiling))
        root = np.sqrt(evened(b))
        t = np.cumsum(2 * np.diff(s) / np.maximum(root[1:] + root[:-1], LEAST_SPEED))
        at.append(s[1:])
        times.append(times[-1][-1] + t)
    t = np.concatenate(times)
    if leg.duration is not None:
        t *= (leg.duration - sum(stop.hold for stop in leg.stops)) / t[-1]
    return np.concatenate(at), t
