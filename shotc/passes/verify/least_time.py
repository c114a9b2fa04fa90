"""An estimate of the least time that a drone takes along a flown way, from the shape of the way alone.

The way is measured in the time that it takes at the rate limits: each step counts the root of the sum of
squares of (change / rate limit) over the groups of channels. Along this measure s a speed u = ds/dt follows
from the limits: each group's rate, its acceleration across the way, its acceleration along the way from
either end (Bobrow et al., forward and backward), and its jerk from rest, which allows u^3 = 9/2 j s^2.

The time law of the flight does not matter, rests included: who flies the same way slower gets the same
estimate. Jerk between the ends does not count, so flights within the limits take somewhat longer.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.ir.drone import Drone
from shotc.ir.limits import Limits
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV

ESTIMATE_STEPS = 200
"""Steps of the estimate, and a quarter of the samples from which they are chosen."""

EASE_S = 0.2
"""Seconds over which accelerations of angles build up at the normal smoothing."""

POSITION_GROUPS = 2
"""Groups of channels that are positions; they come first."""

NO_WAY_S = 1e-7
"""Length of a way, in seconds at the rate limits, that counts as none."""

ROUNDING_TOLERANCE = 1e-12

Select = Callable[[Array], Array]


class _Group(NamedTuple):
    """Channels with common limits, of steps of all channels (M, 7).

    select : the steps of the group, (M, d); rates : the largest rates along them, (M,)
    """

    select: Select
    rates: Select
    acceleration: float
    jerk: float


class LeastTimes(NamedTuple):
    """The estimate along a flight: mission times and least times since its begin, seconds, shapes (M,)."""

    flown: Array
    least: Array

    def between(self, start: float, end: float) -> float:
        """Return the least time between two mission times, seconds."""
        first, last = np.interp([start, end], self.flown, self.least)
        return float(last - first)


def least_times(
    curve: Piecewise,
    span: tuple[float, float],
    drone: Drone,
    share: float,
    smoother: float = 1.0,
    *,
    turns: bool = True,
) -> LeastTimes:
    """Return the estimate along a flight between two mission times, from rest to rest.

    share : of the limits that may be used; smoother : as of ``Shot``
    turns : whether angles and the field of view count
    """
    groups = _groups(drone, share, smoother)[: None if turns else POSITION_GROUPS]
    times = _even_times(curve, span, groups)
    at = curve(times)
    steps = np.maximum(_steps(at, groups), ROUNDING_TOLERANCE)
    if len(times) < 3 or steps.sum() < NO_WAY_S:
        return LeastTimes(np.array(span), np.zeros(2))
    speed = _speeds(at, steps, groups)
    lasts = 2.0 * steps / np.maximum(speed[1:] + speed[:-1], ROUNDING_TOLERANCE)
    # From rest under constant jerk u grows as s^(2/3), so the time to s is 3 s / u.
    lasts[[0, -1]] *= 1.5
    return LeastTimes(times, np.concatenate([[0.0], np.cumsum(lasts)]))


def _groups(drone: Drone, share: float, smoother: float) -> tuple[_Group, ...]:
    limits, gimbal, lens = drone.limits, drone.gimbal, drone.lens
    ease = EASE_S * smoother
    push, rush = share * limits.usable_acceleration, share * limits.jerk / max(1.0, smoother)
    turn, swing = share * limits.yaw_acceleration, share * gimbal.acceleration
    zoom = lens.rate if lens is not None and lens.zooms else gimbal.rate
    angles = _Group(lambda c: c[:, [CAM_PITCH]], _always(share * gimbal.rate), swing, swing / ease)
    upright = share * limits.climb, share * limits.descent
    return (
        _Group(lambda c: c[:, :2], lambda c: share * _over_ground(limits, c), push, rush),
        _Group(lambda c: c[:, 2:3], lambda c: np.where(c[:, 2] > 0.0, *upright), push, rush),
        _Group(lambda c: c[:, [BODY_YAW]], _always(share * limits.yaw_rate), turn, turn / ease),
        angles._replace(select=lambda c: c[:, [CAM_YAW]] - c[:, [BODY_YAW]]),
        angles,
        angles._replace(select=lambda c: c[:, [HFOV]], rates=_always(share * zoom)),
    )


def _always(rate: float) -> Select:
    return lambda c: np.full(len(c), rate)


def _over_ground(limits: Limits, steps: Array) -> Array:
    """Return the largest speeds over ground in the directions of steps, (M,), m/s, in the known wind."""
    length = np.maximum(np.linalg.norm(steps[:, :2], axis=1), ROUNDING_TOLERANCE)
    east, north = limits.wind
    along = (steps[:, 0] * east + steps[:, 1] * north) / length
    across = (steps[:, 0] * north - steps[:, 1] * east) / length
    return np.asarray(along + np.sqrt(limits.speed**2 - across**2))


def _steps(at: Array, groups: tuple[_Group, ...]) -> Array:
    """Return the lengths of the steps between poses (M, 7) in seconds at the rate limits, shape (M - 1,)."""
    steps = np.diff(at, axis=0)
    moved = [np.linalg.norm(g.select(steps), axis=1) / g.rates(steps) for g in groups]
    return np.asarray(np.linalg.norm(moved, axis=0))


def _even_times(curve: Piecewise, span: tuple[float, float], groups: tuple[_Group, ...]) -> Array:
    """Return mission times at about even steps of the way, the ends among them."""
    inner = curve.breaks[(curve.breaks > span[0]) & (curve.breaks < span[1])]
    dense = np.union1d(np.linspace(*span, 4 * ESTIMATE_STEPS + 1), inner)
    way = np.concatenate([[0.0], np.cumsum(_steps(curve(dense), groups))])
    moves = np.concatenate([[True], np.diff(way) > ROUNDING_TOLERANCE * way[-1]])
    times = np.interp(np.linspace(0.0, way[-1], ESTIMATE_STEPS + 1), way[moves], dense[moves])
    times[[0, -1]] = span
    return np.unique(times)


def _speeds(at: Array, steps: Array, groups: tuple[_Group, ...]) -> Array:
    """Return the largest speeds u at poses (M, 7), at rest at both ends, shape (M,)."""
    way = np.concatenate([[0.0], np.cumsum(steps)])
    speed, along, rush = np.full(len(way), np.inf), np.full(len(steps), np.inf), np.full(len(steps), np.inf)
    moved = np.diff(at, axis=0)
    for group in groups:
        rate, most = group.select(moved) / steps[:, None], group.rates(moved)
        size = np.maximum(np.linalg.norm(rate, axis=1), ROUNDING_TOLERANCE)
        bend = np.linalg.norm(np.diff(rate, axis=0), axis=1) / (0.5 * (steps[1:] + steps[:-1]))
        speed[1:], speed[:-1] = (np.minimum(part, most / size) for part in (speed[1:], speed[:-1]))
        speed[1:-1] = np.minimum(
            speed[1:-1], np.sqrt(group.acceleration / np.maximum(bend, ROUNDING_TOLERANCE))
        )
        along, rush = np.minimum(along, group.acceleration / size), np.minimum(rush, group.jerk / size)
    rushes = np.minimum(np.append(rush, rush[-1]), np.append(rush[0], rush))
    speed = np.minimum(speed, np.cbrt(4.5 * rushes * np.minimum(way, way[-1] - way) ** 2))
    gains = 2.0 * along * steps
    for i in range(1, len(speed)):
        speed[i] = min(speed[i], np.sqrt(speed[i - 1] ** 2 + gains[i - 1]))
    for i in range(len(speed) - 2, -1, -1):
        speed[i] = min(speed[i], np.sqrt(speed[i + 1] ** 2 + gains[i]))
    return np.asarray(speed)
