"""The stages of a shot: where along the reference path the nodes stand, and a first guess of the motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.mission import Drone
from shotc.ir.path import CAM_PITCH, CAM_YAW, Leg

STAGES = 100
PER_INTERVAL = 12
MOST = 400
FINE = 20  # samples of the speed profile for each stage
SHARE = 0.7  # of the acceleration that a bend may take up in the guess; the rest is for changes of speed
GAIN = 1.4  # times acceleration times way: how fast speed squared may change; 2 would need endless jerk
LEAST_SPEED = 1e-3  # m/s


@dataclass(frozen=True, slots=True, eq=False)
class Stages:
    """Nodes of one shot.

    s, t : shape (N + 1,), path parameter and seconds (without holds) of the first guess
    pins : indices of the nodes at keyframes and stops, ends included
    """

    s: Array
    t: Array
    pins: np.ndarray


def stages(leg: Leg, drone: Drone, count: int | None) -> Stages:
    """Return nodes evenly in time under a simple speed profile, with one at every keyframe and stop.

    count : how many stages, or None for as many as the keyframes need
    """
    curve = leg.curve
    assert curve is not None
    pins = _pins(leg)
    count = count or int(np.clip(PER_INTERVAL * (len(pins) - 1), STAGES, MOST))
    fine = np.unique(np.concatenate([np.linspace(curve.start, curve.end, FINE * count + 1), pins]))
    t = _profile(leg, drone, fine)
    shares = _shares(np.interp(pins, fine, t), count)
    knots = np.interp(pins, fine, t)
    parts = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(knots[:-1], knots[1:], shares, strict=True)
    ]
    at = np.append(np.concatenate(parts), knots[-1])
    s = np.interp(at, t, fine)
    index = np.concatenate([[0], np.cumsum(shares)])
    s[index] = pins
    return Stages(s, at, index)


def _pins(leg: Leg) -> Array:
    assert leg.curve is not None
    every = sorted(
        {m.s for m in leg.marks} | {stop.s for stop in leg.stops} | {leg.curve.start, leg.curve.end}
    )
    apart = 1e-9 * (every[-1] - every[0])
    return np.array([s for i, s in enumerate(every) if i == 0 or s > every[i - 1] + apart])


def _shares(knots: Array, count: int) -> np.ndarray:
    """Share stages out among the intervals by their time, at least two each."""
    wanted = count * np.diff(knots) / (knots[-1] - knots[0])
    shares = np.maximum(2, np.floor(wanted)).astype(int)
    while shares.sum() < count:
        shares[int((wanted - shares).argmax())] += 1
    return np.asarray(shares)


def _profile(leg: Leg, drone: Drone, s: Array) -> Array:
    """Return seconds at parameters s: as fast as speed and rates allow, then braked for acceleration."""
    curve = leg.curve
    assert curve is not None
    pace = leg.pace if leg.duration is None else 1.0
    limits = drone.limits
    rate, bend = curve.derivative()(s), curve.derivative(2)(s)
    vertical = np.where(rate[:, 2] > 0, limits.climb, limits.descent)
    turn = np.minimum(
        drone.gimbal.rate / np.maximum(np.abs(rate[:, CAM_PITCH]), 1e-9),
        limits.yaw_rate / np.maximum(np.abs(rate[:, CAM_YAW]), 1e-9),
    )
    speed = pace * np.minimum.reduce(
        [
            limits.speed / np.maximum(np.hypot(rate[:, 0], rate[:, 1]), 1e-9),
            vertical / np.maximum(np.abs(rate[:, 2]), 1e-9),
            turn,
        ]
    )
    curved = np.maximum(np.linalg.norm(bend[:, :3], axis=1), 1e-9)
    square = np.minimum(speed**2, SHARE * pace * limits.acceleration / curved)
    square[np.isin(s, [stop.s for stop in leg.stops])] = 0.0
    gain = GAIN * pace * limits.acceleration * np.diff(s)
    for i in range(len(s) - 1):
        square[i + 1] = min(square[i + 1], square[i] + gain[i])
    for i in range(len(s) - 2, -1, -1):
        square[i] = min(square[i], square[i + 1] + gain[i])
    root = np.sqrt(square)
    t = np.concatenate([[0.0], np.cumsum(2 * np.diff(s) / np.maximum(root[1:] + root[:-1], LEAST_SPEED))])
    if leg.duration is not None:
        t *= (leg.duration - sum(stop.hold for stop in leg.stops)) / t[-1]
    return np.asarray(t)
