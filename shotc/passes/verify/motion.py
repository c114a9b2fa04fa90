"""Speed, acceleration, jerk and angles at every instant, by hulls of the derivatives."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import inf, pi, radians

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces, pieces
from shotc.geom.proof import inf_channel, norm, sup_channel, sup_convex
from shotc.ir.drone import SAME_LENS_RAD
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.thrust import lean, thrust_to_weight
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap

HFOV_RANGE_RAD = (radians(1.0), radians(170.0))
"""Range of fields of view of a pinhole camera."""


def motion(flight: JudgedFlight) -> Iterator[Claim]:
    """Yield claims on the limits of drone, gimbal and lens over the whole flight."""
    whole = pieces(flight.track.curve)
    yield from _translation(flight, whole.channels(0, 1, 2))
    yield from _body_yaw(flight, whole.channels(BODY_YAW))
    yield from _gimbal(flight, "pitch", whole.channels(CAM_PITCH))
    yield from _gimbal(flight, "yaw", _against_body(flight, whole))
    yield from _zoom(flight, whole.channels(HFOV))


def _translation(flight: JudgedFlight, position: Pieces) -> Iterator[Claim]:
    limits = flight.drone.limits
    velocity = position.derivative()
    acceleration = velocity.derivative()
    make = partial(_below, flight)
    yield _speed(flight, velocity.channels(0, 1))
    climb = Limit("climb", limits.climb, "m/s", _path(flight, "limits", "climb"))
    yield bounded(flight, climb, sup_channel(velocity, 2, gap(limits.climb)))
    descent = Limit("descent", limits.descent, "m/s", _path(flight, "limits", "descent"))
    falling = sup_convex(velocity, lambda c: -c[..., 2], gap(limits.descent))
    yield bounded(flight, descent, falling)
    yield make("acceleration", acceleration, limits.acceleration, "m/s^2")
    yield make("jerk", acceleration.derivative(), limits.jerk, "m/s^3")
    yield from _thrust(flight, acceleration)


def _speed(flight: JudgedFlight, level: Pieces) -> Claim:
    """Return the claim on ground speed, or on airspeed where the wind is known."""
    limits = flight.drone.limits
    name = "airspeed" if any(limits.wind) else "speed"
    through = Pieces(level.low, level.high, level.ctrl - np.array(limits.wind))
    limit = Limit(name, limits.speed, "m/s", _path(flight, "limits", "speed"))
    return bounded(flight, limit, sup_convex(through, norm, gap(limits.speed)))


def _thrust(flight: JudgedFlight, acceleration: Pieces) -> Iterator[Claim]:
    """Yield claims on tilt and thrust where they are limited; both are functions of the acceleration
    alone.
    """
    limits = flight.drone.limits
    for key, value, limit, unit in (
        ("tilt", lean, limits.tilt, "rad"),
        ("thrust_to_weight", thrust_to_weight, limits.thrust_to_weight, "times the weight"),
    ):
        if limit < inf:
            bound = Limit(key.replace("_", " "), limit, unit, _path(flight, "limits", key))
            yield bounded(flight, bound, sup_convex(acceleration, value, gap(limit)))


def _body_yaw(flight: JudgedFlight, yaw: Pieces) -> Iterator[Claim]:
    limits = flight.drone.limits
    rate = yaw.derivative()
    yield _below(flight, "yaw_rate", rate, limits.yaw_rate, "rad/s")
    yield _below(flight, "yaw_acceleration", rate.derivative(), limits.yaw_acceleration, "rad/s^2")


def _gimbal(flight: JudgedFlight, axis: str, angle: Pieces) -> Iterator[Claim]:
    gimbal = flight.drone.gimbal
    reach = gimbal.pitch if axis == "pitch" else gimbal.yaw
    yield from _range(flight, f"gimbal {axis}", angle, reach, _path(flight, "gimbal", axis))
    rate = angle.derivative()
    for name, order, limit, unit in (
        ("rate", rate, gimbal.rate, "rad/s"),
        ("acceleration", rate.derivative(), gimbal.acceleration, "rad/s^2"),
    ):
        bound = Limit(f"gimbal {axis} {name}", limit, unit, _path(flight, "gimbal", name))
        yield bounded(flight, bound, sup_convex(order, norm, gap(limit)))


def _zoom(flight: JudgedFlight, hfov: Pieces) -> Iterator[Claim]:
    """Yield claims on the lens's range, and on its zoom rate where the mission gives one."""
    lens = flight.drone.lens
    if lens is None:
        yield from _range(flight, "field of view", hfov, HFOV_RANGE_RAD)
        return
    reach = (lens.longest - SAME_LENS_RAD, lens.widest + SAME_LENS_RAD)
    yield from _range(flight, "field of view", hfov, reach, _path(flight, "camera", "zoom"))
    if lens.zooms:
        rate = Limit("zoom rate", lens.rate, "rad/s", _path(flight, "camera", "zoom_rate"))
        yield bounded(flight, rate, sup_convex(hfov.derivative(), norm, gap(lens.rate)))


def _against_body(flight: JudgedFlight, whole: Pieces) -> Pieces:
    # Whole turns are removed at the start; from there on the gimbal has to stay in its range.
    relative: Array = whole.ctrl[:, :, [CAM_YAW]] - whole.ctrl[:, :, [BODY_YAW]]
    low, high = flight.drone.gimbal.yaw
    turns = np.round((relative[0, 0, 0] - 0.5 * (low + high)) / (2 * pi))
    return Pieces(whole.low, whole.high, relative - 2 * pi * turns)


def _range(
    flight: JudgedFlight,
    name: str,
    angle: Pieces,
    reach: tuple[float, float],
    path: tuple[str | int, ...] = (),
) -> Iterator[Claim]:
    low, high = reach
    path = path or _path(flight, "camera")
    least = Limit(f"{name} min", low, "rad", path, upper=False)
    yield bounded(flight, least, inf_channel(angle, 0, gap(low)))
    yield bounded(flight, Limit(f"{name} max", high, "rad", path), sup_channel(angle, 0, gap(high)))


def _below(flight: JudgedFlight, key: str, order: Pieces, limit: float, unit: str) -> Claim:
    name = f"body {key}".replace("_", " ") if key.startswith("yaw") else key
    bound = Limit(name, limit, unit, _path(flight, "limits", key))
    return bounded(flight, bound, sup_convex(order, norm, gap(limit)))


def _path(flight: JudgedFlight, *keys: str) -> tuple[str | int, ...]:
    return (*flight.drone.path, *keys)
