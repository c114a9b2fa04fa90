"""Claims on the motion of flights with a clock, from the rebuilt curves or directly from rows.

Between two rows the largest acceleration is at least the mean that their velocities give; the same holds for
the derivatives of angles. If that mean exceeds a limit, every flight through these rows breaks it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.flightfiles.clocked import ClockedFlight, quantum
from shotc.geom.bernstein import Array, bernstein_basis
from shotc.geom.pieces import Pieces, join, pieces
from shotc.geom.proof import norm, sup_convex
from shotc.importers.flights.rows import ACCELERATION, BODY, DroneRows
from shotc.ir.drone import SAME_LENS_RAD, Drone
from shotc.ir.limits import Limits
from shotc.ir.origin import KeyPath
from shotc.passes.verify.claims import Limit, WorstValue, gap

STEEP_STEP_S = 0.02
"""Least duration of a show's piece, seconds; on shorter ones rounding would dominate the acceleration."""


class FlightPieces(NamedTuple):
    """Pieces of many flights, and the index of the flight of each."""

    pieces: Pieces
    owner: Array


class LimitFinding(NamedTuple):
    """A worst value with its limit, the file's uncertainty, and the index of its flight."""

    limit: Limit
    worst: WorstValue
    leeway: float
    owner: int


def bagged(parts: Sequence[Pieces]) -> FlightPieces:
    """Return the pieces of several flights as one collection."""
    return FlightPieces(join(parts), np.repeat(np.arange(len(parts)), [len(part) for part in parts]))


def bag_of(flights: Sequence[ClockedFlight]) -> FlightPieces:
    """Return the pieces of all flights."""
    return bagged([pieces(flight.curve) for flight in flights])


def speeds(
    flights: Sequence[ClockedFlight], bag: FlightPieces, limits: Limits, path: KeyPath
) -> Iterator[LimitFinding]:
    """Yield the speeds of flights with the same limits, proved at every instant."""
    velocity = bag.pieces.derivative()
    wind = np.array([*limits.wind, 0.0])
    name = "airspeed" if any(limits.wind) else "speed"
    leeway = max(flight.leeway.speed for flight in flights)
    for what, key, most, value in (
        (name, "speed", limits.speed, lambda v: norm((v - wind)[..., :2])),
        ("climb", "climb", limits.climb, lambda v: np.asarray(v[..., 2])),
        ("descent", "descent", limits.descent, lambda v: np.asarray(-v[..., 2])),
    ):
        bound = sup_convex(velocity, value, gap(most))
        owner = who(FlightPieces(velocity, bag.owner), bound.at, value, upper=True)
        yield LimitFinding(
            Limit(what, most, "m/s", (*path, "limits", key)),
            WorstValue(bound.proven, bound.at),
            leeway,
            owner,
        )


def who(bag: FlightPieces, at: float, value: object, *, upper: bool) -> int:
    """Return the index of the flight with the worst value at a time.

    value : the function that was bounded
    """
    assert callable(value)
    inside = (bag.pieces.low <= at + 1e-9) & (bag.pieces.high >= at - 1e-9)
    some = bag.pieces.pick(inside)
    share = np.clip((at - some.low) / np.maximum(some.high - some.low, 1e-12), 0.0, 1.0)
    values = value(np.einsum("mk,mkd->md", bernstein_basis(some.ctrl.shape[1] - 1, share), some.ctrl))
    return int(bag.owner[inside][int(np.argmax(values) if upper else np.argmin(values))])


def accelerations(flights: Sequence[ClockedFlight], limits: Limits, path: KeyPath) -> Iterator[LimitFinding]:
    """Yield the acceleration, and the jerk if a table has accelerations."""
    for name, most, unit, of in (
        ("acceleration", limits.acceleration, "m/s^2", _acceleration),
        ("jerk", limits.jerk, "m/s^3", _jerk),
    ):
        extremes = [(each, i) for i, flight in enumerate(flights) if (each := of(flight)) is not None]
        if extremes:
            peak, owner = max(extremes, key=lambda one: one[0].value - one[0].leeway)
            limit = Limit(name, most, unit, (*path, "limits", name))
            yield LimitFinding(limit, WorstValue(peak.value, peak.time, "bounded"), peak.leeway, owner)


class LargestSample(NamedTuple):
    """The largest value in excess of the uncertainty: the value, its time in seconds, and the uncertainty."""

    value: float
    time: float
    leeway: float


def _acceleration(flight: ClockedFlight) -> LargestSample | None:
    rows = flight.rows
    if rows is None:
        whole = pieces(flight.curve)
        size = norm(whole.derivative().derivative().ctrl).max(axis=1)
        step = np.maximum(whole.high - whole.low, STEEP_STEP_S)
        return _peak(size, whole.low, 24 * flight.leeway.place / step**2)
    if rows.velocity is None:
        return None
    peak = _mean(rows.velocity, rows.time, _rounding(rows, "vx_m_s", "vy_m_s", "vz_m_s"))
    measured = rows.values(*ACCELERATION)
    if measured is not None:
        size = norm(measured)
        own = _peak(size, rows.time, np.zeros(len(size)))
        peak = own if peak is None or own.value > peak.value else peak
    return peak


def _jerk(flight: ClockedFlight) -> LargestSample | None:
    rows = flight.rows
    measured = None if rows is None else rows.values(*ACCELERATION)
    if rows is None or measured is None:
        return None
    return _mean(measured, rows.time, _rounding(rows, *ACCELERATION))


def _rounding(rows: DroneRows, *columns: str) -> float:
    return quantum([rows.texts(column) or [] for column in columns])


def _mean(values: Array, time: Array, rounding: float) -> LargestSample | None:
    """Return the largest rate of change between two rows of values (N, k)."""
    if len(time) < 2:
        return None
    step = np.diff(time)
    return _peak(norm(np.diff(values, axis=0)) / step, time[1:], 4 * rounding / step)


def _peak(size: Array, time: Array, leeway: Array) -> LargestSample:
    k = int(np.argmax(size - leeway))
    return LargestSample(float(size[k]), float(time[k]), float(leeway[k]))


def turns(flight: ClockedFlight, drone: Drone) -> Iterator[LimitFinding]:
    """Yield angles, rates and accelerations of body and gimbal, if a table has the columns."""
    rows = flight.rows
    if rows is None:
        return
    body, camera = rows.values(*BODY), rows.values("cam_yaw_rad", "cam_pitch_rad")
    limits, gimbal = drone.limits, drone.gimbal
    if body is not None:
        yaw = np.unwrap(body[:, 0])
        most = (limits.yaw_rate, limits.yaw_acceleration)
        keys = (("limits", "yaw_rate"), ("limits", "yaw_acceleration"))
        yield from _rates(rows, _Angle("body yaw", yaw, BODY), most, [(*drone.path, *key) for key in keys])
    for name, reach in (("pitch", gimbal.pitch), ("yaw", gimbal.yaw)):
        if camera is None or (name == "yaw" and body is None):
            continue
        angle = camera[:, 1]
        columns: tuple[str, ...] = ("cam_pitch_rad",)
        if name == "yaw" and body is not None:
            angle = np.unwrap(camera[:, 0]) - np.unwrap(body[:, 0])
            angle -= 2 * np.pi * np.round((angle[0] - 0.5 * sum(reach)) / (2 * np.pi))
            columns = ("cam_yaw_rad", *BODY)
        rounding = 2 * _rounding(rows, *columns)
        for side, value, upper in (("min", reach[0], False), ("max", reach[1], True)):
            k = int(np.argmax(angle) if upper else np.argmin(angle))
            limit = Limit(f"gimbal {name} {side}", value, "rad", (*drone.path, "gimbal", name), upper=upper)
            yield LimitFinding(limit, WorstValue(float(angle[k]), float(rows.time[k])), rounding, 0)
        keys = (("gimbal", "rate"), ("gimbal", "acceleration"))
        most = (gimbal.rate, gimbal.acceleration)
        yield from _rates(
            rows, _Angle(f"gimbal {name}", angle, columns), most, [(*drone.path, *key) for key in keys]
        )


def zooms(flight: ClockedFlight, drone: Drone) -> Iterator[LimitFinding]:
    """Yield fields of view and their rates, if a table has them and the mission describes the lens."""
    lens = drone.lens
    hfov = None if flight.rows is None else flight.rows.values("hfov_rad")
    if lens is None or hfov is None or flight.rows is None:
        return
    angle, time = hfov[:, 0], flight.rows.time
    path = (*drone.path, "camera", "zoom")
    for side, value, upper in (("min", lens.longest, False), ("max", lens.widest, True)):
        k = int(np.argmax(angle) if upper else np.argmin(angle))
        limit = Limit(f"field of view {side}", value, "rad", path, upper=upper)
        yield LimitFinding(limit, WorstValue(float(angle[k]), float(time[k])), SAME_LENS_RAD, 0)
    if lens.zooms:
        peak = _mean(hfov, time, _rounding(flight.rows, "hfov_rad"))
        if peak is not None:
            rate = Limit("zoom rate", lens.rate, "rad/s", (*drone.path, "camera", "zoom_rate"))
            yield LimitFinding(rate, WorstValue(peak.value, peak.time), peak.leeway, 0)


class _Angle(NamedTuple):
    """An angle in the rows of a table, rad, (N,); columns : those from which it is computed."""

    name: str
    values: Array
    columns: Sequence[str]


def _rates(
    rows: DroneRows, angle: _Angle, most: tuple[float, float], paths: Sequence[KeyPath]
) -> Iterator[LimitFinding]:
    """Yield lower bounds of an angle's rate and acceleration: means over one and over two intervals."""
    rounding = 2 * _rounding(rows, *angle.columns)
    step = np.diff(rows.time)
    rate = np.diff(angle.values) / step
    peak = _peak(np.abs(rate), rows.time[1:], 2 * rounding / step)
    yield LimitFinding(
        Limit(f"{angle.name} rate", most[0], "rad/s", paths[0]),
        WorstValue(peak.value, peak.time),
        peak.leeway,
        0,
    )
    if len(rate) > 1:
        # The mean rate of an interval is reached somewhere in it. These instants of two neighbouring
        # intervals are at most the sum of both apart.
        wide = step[:-1] + step[1:]
        peak = _peak(
            np.abs(np.diff(rate)) / wide,
            rows.time[2:],
            4 * rounding / np.minimum(step[:-1], step[1:]) / wide,
        )
        yield LimitFinding(
            Limit(f"{angle.name} acceleration", most[1], "rad/s^2", paths[1]),
            WorstValue(peak.value, peak.time),
            peak.leeway,
            0,
        )


def beyond(move: LimitFinding) -> bool:
    """Return whether a value exceeds its limit by more than the file's uncertainty."""
    over = move.worst.value - move.limit.value if move.limit.upper else move.limit.value - move.worst.value
    return over > move.leeway and move.limit.value not in (inf, -inf)
