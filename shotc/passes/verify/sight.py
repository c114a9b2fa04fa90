"""Check that drones stay out of each other's pictures: each shot against every other drone in all its phases.

A drone on its pad, before take-off and after landing, counts as one that flies; so does one hidden by a zone
or a target. The distance of a body from the picture is sampled at the output rate. The time between samples
is halved until bounds on its rate exclude anything worse.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import cut
from shotc.geom.proof import ProvedExtreme, norm, sup_convex
from shotc.geom.sight import WITHIN_RAD, off_axis, outside
from shotc.ir.drone import Drone
from shotc.ir.measures import OUT_OF_PICTURE
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.sampling import cameras, ticks
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim, slack

PATH = ("rules", "mutual_visibility")

NARROW_SHARE = 1e-3
"""Share of the distance from the limit to which the worst value is bounded."""

MOST_HALVINGS = 40
"""Most halvings of the time between two samples."""

OPEN_INTERVALS_LIMIT = 200_000
"""Most intervals that are halved at once; beyond it the worst value is the sampled one."""


def sights(flights: list[JudgedFlight]) -> Iterator[Claim]:
    """Yield the claims that no other drone is in a shot's picture."""
    for flight in flights:
        rules = flight.mission.rules
        if rules.visibility == "off":
            continue
        for phase in flight.track.phases:
            if phase.shot is None:
                continue
            for other in flights:
                if other is not flight:
                    yield _claim(flight, other, phase)


def _claim(flight: JudgedFlight, other: JudgedFlight, phase: Phase) -> Claim:
    rules = flight.mission.rules
    cone = rules.half_angle is not None
    limit = Limit(
        f"{other.drone.name}{OUT_OF_PICTURE}",
        rules.half_angle or 0.0,
        "rad" if cone else "m",
        (*PATH, "half_angle") if cone else PATH,
        upper=False,
        hard=rules.visibility == "require",
        shot=phase.shot,
    )
    sight = CameraAndBody(flight.mission, flight.track, other.track)
    times = ticks(flight.mission.rate, phase.start, phase.end)
    return claim(flight, limit, _worst(sight, times, limit.value))


@dataclass(frozen=True, slots=True, eq=False)
class CameraAndBody:
    """One drone's camera and another drone's body."""

    mission: MissionIR
    film: DroneTrajectory
    other: DroneTrajectory

    @property
    def body(self) -> Drone:
        """The drone that may be seen."""
        return self.mission.drone(self.other.drone)

    def out(self, t: Array) -> Array:
        """Return how far the other drone is out of the picture at times (M,), shape (M,): metres, or rad from
        the axis for a cone.
        """
        return self.out_at(t, self.other.curve(t)[:, :3])

    def out_at(self, t: Array, places: Array) -> Array:
        """Return the same for a body at given places, (M, 3)."""
        eyes = cameras(self.mission, self.film, t)
        measured = outside if self.mission.rules.half_angle is None else off_axis
        return measured(eyes, places, self.body.radius)


def _worst(sight: CameraAndBody, times: Array, limit: float) -> WorstValue:
    """Return the least value between the first and the last time: proved, or sampled where no proof
    succeeds.
    """
    landed = sight.other.curve.end
    if times[0] < landed < times[-1]:
        times = np.union1d(times, [landed])
    bound = infimum(sight, times, limit)
    closed = bound.proven >= bound.attained - _gap(bound.attained, limit)
    if closed or bound.proven >= limit - slack(limit):
        return WorstValue(bound.proven, bound.at, "bounded")
    return WorstValue(bound.attained, bound.at, "sampled")


def infimum(sight: CameraAndBody, times: Array, limit: float) -> ProvedExtreme:
    """Return bounds of the least value over the time that samples at times (M,) span."""
    if times[-1] <= times[0]:
        least = float(sight.out(times[:1])[0])
        return ProvedExtreme(least, least, float(times[0]))
    fastest = _fastest(sight, float(times[0]), float(times[-1]))
    rows = _sampled(sight, times)
    k = int(np.argmin(rows[:, 0]))
    best, at, closed = float(rows[k, 0]), float(times[k]), inf
    low, high, a, b = times[:-1], times[1:], rows[:-1], rows[1:]
    for _ in range(MOST_HALVINGS):
        lower = np.minimum(_lower(sight, fastest, a, b, high - low), np.minimum(a[:, 0], b[:, 0]))
        is_open = lower < best - _gap(best, limit)
        closed = min(closed, float(lower[~is_open].min(initial=inf)))
        rest = float(lower[is_open].min(initial=inf))
        if not is_open.any() or is_open.sum() > OPEN_INTERVALS_LIMIT:
            break
        low, high, a, b = low[is_open], high[is_open], a[is_open], b[is_open]
        middle = 0.5 * (low + high)
        m = _sampled(sight, middle)
        k = int(np.argmin(m[:, 0]))
        if m[k, 0] < best:
            best, at = float(m[k, 0]), float(middle[k])
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        a, b = np.concatenate([a, m]), np.concatenate([m, b])
    return ProvedExtreme(min(closed, best, rest), best, at)


def _gap(best: float, limit: float) -> float:
    return max(0.5 * slack(limit), NARROW_SHARE * abs(best - limit))


@dataclass(frozen=True, slots=True)
class _Fastest:
    """Bounds over a shot on the rates of change of sampled rates: m/s^2, rad/s^2."""

    speed: float
    turn: float
    zoom: float


def _fastest(sight: CameraAndBody, start: float, end: float) -> _Fastest:
    film, other = sight.film.curve, sight.other.curve

    def most(curve: Piecewise, *channels: int) -> float:
        bend = cut(curve.channels(*channels), start, end).derivative().derivative()
        return max(0.0, sup_convex(bend, norm, lambda best: max(1e-3, 0.05 * abs(best))).proven)

    return _Fastest(
        most(film, 0, 1, 2) + most(other, 0, 1, 2),
        most(film, CAM_YAW) + most(film, CAM_PITCH),
        most(film, HFOV),
    )


def _sampled(sight: CameraAndBody, t: Array) -> Array:
    """Return the value, relative speed, turn of the camera, zoom, and distance at times, shape (M, 5)."""
    film, other = sight.film.curve, sight.other.curve
    rate = film.derivative()(t)
    # After landing it stands.
    flying = np.where(t < other.end, 1.0, 0.0)[:, None]
    speed = norm(rate[:, :3] - flying * other.derivative()(t)[:, :3])
    turn = np.abs(rate[:, CAM_YAW]) + np.abs(rate[:, CAM_PITCH])
    far = norm(film(t)[:, :3] - other(t)[:, :3])
    return np.column_stack([sight.out(t), speed, turn, np.abs(rate[:, HFOV]), far])


def _lower(sight: CameraAndBody, fastest: _Fastest, a: Array, b: Array, dt: Array) -> Array:
    """Return lower bounds within intervals.

    An edge of the frame is a plane through the camera with unit normal n; a body at p from the camera is -n.p
    - r beyond it. That changes by at most |p'| + |p| |n'|, and n turns no faster than the camera plus the
    edge's half angle (``geom.framing.margin_rate``). The largest of several changes no faster than the
    fastest. The angle from the axis minus asin(r / d) changes by at most |p'| / sqrt(d^2 - r^2) and the turn.
    """
    speed = 0.5 * (a[:, 1] + b[:, 1] + fastest.speed * dt)
    turn = 0.5 * (a[:, 2] + b[:, 2] + fastest.turn * dt)
    middle, drift = 0.5 * (a[:, 4] + b[:, 4]), 0.5 * speed * dt
    if sight.mission.rules.half_angle is None:
        aspect = sight.mission.drone(sight.film.drone).aspect
        zoom = 0.5 * (a[:, 3] + b[:, 3] + fastest.zoom * dt)
        rate = speed + (middle + drift) * (turn + 0.5 * zoom * max(aspect, 1.0 / aspect))
        return np.asarray(0.5 * (a[:, 0] + b[:, 0] - rate * dt))
    near, radius = middle - drift, sight.body.radius
    apart = near > radius
    reach = np.sqrt(np.where(apart, near**2 - radius**2, 1.0))
    angle = 0.5 * (a[:, 0] + b[:, 0] - (turn + speed / reach) * dt)
    return np.where(apart, np.maximum(angle, WITHIN_RAD), WITHIN_RAD)
