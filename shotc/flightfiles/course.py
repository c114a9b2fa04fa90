"""Rebuilds flights from waypoint files, which have no clock, in all ways that a machine may fly them.

Before the waypoints a machine climbs vertically from its pad and goes straight to the first one. After them
it lands vertically where its file says so. Times are counted at the file's speeds and only identify places on
the path; the true times are unknown.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mavlink.speed import DEFAULTS, Speeds, seconds
from shotc.emit.waypoints import paths
from shotc.emit.waypoints.geo import Geo, GeoPosition, tie
from shotc.emit.waypoints.models import SPLINES
from shotc.geom.bernstein import Array, Piecewise
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.points import FAR, FlightPoint, Pace, Waypoints
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase, PhaseName

FAR_M = 20_000.0
"""Metres from the pad, above which a waypoint cannot belong to a flight from it."""
SAME_M = 1e-3
"""Metres, below which two points are one."""
AT_HOME_M = 1.0
"""Metres from its pad, within which a machine lands at home."""
BRIEFEST_S, LONGEST_S = 1e-3, 1e6
"""Seconds of the shortest and of the longest leg, so that times stay distinct."""
CURVE_SHARE = 0.1
"""Share of a leg's time in which one of its rounded corners is flown."""


class UntimedLeg(NamedTuple):
    """One part of a course.

    start, end : seconds at the file's speeds
    to : the point at its end
    file : the file of that point
    speed : m/s along the path; None if the file states none
    within : whether it leads from one waypoint to the next
    """

    start: float
    end: float
    to: FlightPoint
    file: str
    speed: float | None
    phase: PhaseName
    within: bool


@dataclass(frozen=True, slots=True, eq=False)
class UntimedFlight:
    """A flight from a file without a clock.

    ways : possible curves x, y, z, cubic, with a description of each
    legs : its parts in order, the same for all curves
    landing : metres from the pad to where it lands; None if it stays in the air
    """

    drone: Drone
    files: tuple[str, ...]
    plan: Waypoints
    ways: tuple[tuple[str, Piecewise], ...]
    legs: tuple[UntimedLeg, ...]
    landing: float | None

    @property
    def phases(self) -> tuple[Phase, ...]:
        """Take-off, transit and landing."""
        spans: dict[PhaseName, Phase] = {}
        for leg in self.legs:
            before = spans.get(leg.phase)
            start = leg.start if before is None else before.start
            spans[leg.phase] = Phase(leg.phase, None, start, leg.end)
        return tuple(spans.values())

    def leg_at(self, time: float) -> UntimedLeg:
        """Return the part that is flown at a time."""
        return next((leg for leg in self.legs if time < leg.end), self.legs[-1])


class _PlacedPoint(NamedTuple):
    """A point of a flight, the name of its file, and its place in W, metres."""

    point: FlightPoint
    file: str
    at: Array


class _UntimedLeg(NamedTuple):
    """A leg without a time.

    ctrl : control points (k, 4, 3) of each possible curve
    """

    ctrl: tuple[Array, ...]
    to: tuple[FlightPoint, str]
    seconds: float
    speed: float | None
    phase: PhaseName = "transit"
    within: bool = False


def course_of(
    mission: MissionIR, drone: Drone, plan: Waypoints, files: Sequence[str]
) -> UntimedFlight | tuple[str, Refused]:
    """Return the course of a drone from the points of its files, or the refused file and the reason.

    The mission must have an origin.

    files : file name of each point
    """
    assert mission.origin is not None
    geo = tie(mission.origin, drone.home)
    placed: list[_PlacedPoint] = []
    for point, file in zip(plan.points, files, strict=True):
        at = _place(mission, geo, point, drone)
        if isinstance(at, Refused):
            return file, at
        placed.append(_PlacedPoint(point, file, at))
    landing = None if plan.landing is None else _place(mission, geo, plan.landing, drone)
    if isinstance(landing, Refused):
        return files[-1], landing
    distinct = [placed[0]]
    for point, file, at in placed[1:]:
        if float(np.linalg.norm(at - distinct[-1].at)) < SAME_M:
            stays = distinct.pop().point.stay + point.stay
            distinct.append(_PlacedPoint(point._replace(stay=stays, stops=True), file, at))
        else:
            distinct.append(_PlacedPoint(point, file, at))
    points = np.array([at for _, _, at in distinct])
    models = _models([point for point, _, _ in distinct], points, plan)
    parts = [
        *_approach(drone, plan, distinct[0][:2], (points[0], len(models))),
        *_legs(drone, plan, distinct, [legs for _, legs in models]),
    ]
    off_home = None
    if landing is not None and plan.landing is not None:
        off_home = float(np.linalg.norm(landing[:2] - np.array(drone.home[:2])))
        to = (plan.landing, distinct[-1][1])
        parts += _landing(drone, (points[-1], landing), to, (len(models), off_home))
    curves, legs = _timed(parts)
    names = [name for name, _ in models]
    return UntimedFlight(
        drone, tuple(dict.fromkeys(files)), plan, tuple(zip(names, curves, strict=True)), legs, off_home
    )


def _landing(
    drone: Drone, ends: tuple[Array, Array], to: tuple[FlightPoint, str], of: tuple[int, float]
) -> Iterator[_UntimedLeg]:
    """Yield the leg to above the landing place, and the descent from there."""
    (last, place), (count, off_home) = ends, of
    above = np.array([place[0], place[1], last[2]])
    if np.linalg.norm(above - last) > SAME_M:
        yield _straight((last, above), to, (drone, None), count)
    foot = np.array(drone.home) if off_home <= AT_HOME_M else np.array([place[0], place[1], drone.home[2]])
    yield _straight((above, foot), to, (drone, None), count)._replace(phase="land")


def _place(mission: MissionIR, geo: Geo, point: FlightPoint, drone: Drone) -> Array | Refused:
    """Return a point in W, shape (3,); refuse one that is far from the pad."""
    height = point.height - (geo.home_alt if point.level == "sea" else 0.0)
    place = geo.point(GeoPosition(point.lat, point.lon, height))
    distance = float(np.linalg.norm(place - np.array(drone.home)))
    if distance > FAR_M:
        turned = geo.point(GeoPosition(max(min(point.lon, 89.0), -89.0), point.lat, height))
        near = float(np.linalg.norm(turned - np.array(drone.home))) < FAR_M
        message = f"{point.name} is {distance / 1000:.0f} km from the pad of `{drone.name}`"
        help_ = "its latitude and longitude are exchanged" if near else "see world.origin of the mission"
        return Refused(FAR, message, point.node, help_)
    if point.level == "ground":
        place[2] = mission.ground(float(place[0]), float(place[1])) + point.height
    return place


def _models(points: Sequence[FlightPoint], places: Array, plan: Waypoints) -> list[tuple[str, list[Array]]]:
    """Return the possible curves through the points: a description, and control points (k, 4, 3)
    of each leg.
    """
    stops = np.array([point.stops for point in points])
    if len(points) == 1:
        return [("straight legs", [])]
    models = [("straight legs", _each(paths.cubics(places, stops, paths.straight, cut=True)))]
    bends = plan.family == "dji" and not all(point.straight for point in points)
    bends |= plan.family == "mavlink" and not all(point.straight for point in points[1:])
    if bends:
        for cut in (True, False):
            ends = "" if not stops[1:-1].any() else ", anew at stops" if cut else ", on through stops"
            if cut or ends:
                for name, tangents in SPLINES.items():
                    models.append((f"{name}{ends}", _each(paths.cubics(places, stops, tangents, cut=cut))))
    sizes = _sizes(points, places)
    if sizes.any():
        models.append(("straight legs with rounded corners", list(paths.corners(places, sizes))))
    return models


def _each(ctrl: Array) -> list[Array]:
    return list(ctrl[:, None])


def _sizes(points: Sequence[FlightPoint], places: Array) -> Array:
    """Return the rounding distance of each corner, metres, shape (m,); 0 where the machine stands still."""
    length = np.linalg.norm(np.diff(places, axis=0), axis=1)
    shorter = np.minimum(np.append(length, np.inf), np.insert(length, 0, np.inf))
    sizes = np.array([0.0 if point.stops else point.curve for point in points])
    sizes[0] = sizes[-1] = 0.0
    return np.asarray(np.minimum(sizes, 0.5 * shorter))


def _approach(
    drone: Drone, plan: Waypoints, to: tuple[FlightPoint, str], goal: tuple[Array, int]
) -> Iterator[_UntimedLeg]:
    """Yield the climb from the pad, and the legs to the first point."""
    first, count = goal
    home = np.array(drone.home)
    top = max(float(first[2]), home[2] + plan.climb, home[2] + SAME_M)
    above = np.array([home[0], home[1], top])
    yield _straight((home, above), to, (drone, None), count)._replace(phase="takeoff")
    beside = np.array([first[0], first[1], top])
    for a, b in ((above, beside), (beside, first)):
        if np.linalg.norm(b - a) > SAME_M:
            yield _straight((a, b), to, (drone, None), count)


def _legs(
    drone: Drone,
    plan: Waypoints,
    placed: Sequence[_PlacedPoint],
    models: Sequence[list[Array]],
) -> Iterator[_UntimedLeg]:
    """Yield the legs between points, and the stays at points."""
    count = len(models)
    for i, (point, file, at) in enumerate(placed):
        if point.stay > 0.0:
            stay = _straight((at, at), (point, file), (drone, None), count)
            duration = min(max(point.stay, BRIEFEST_S), LONGEST_S)
            yield stay._replace(seconds=duration, speed=0.0)
        if i + 1 < len(placed):
            to, name, end = placed[i + 1]
            duration, speed = _duration(end - at, _in_force(drone, plan, point.pace))
            speed_limit = None if point.pace is None else speed
            yield _UntimedLeg(
                tuple(legs[i] for legs in models), (to, name), duration, speed_limit, within=True
            )


def _straight(
    ends: tuple[Array, Array], to: tuple[FlightPoint, str], by: tuple[Drone, Pace | None], count: int
) -> _UntimedLeg:
    a, b = ends
    share = np.linspace(0.0, 1.0, 4)[:, None]
    ctrl = (a + share * (b - a))[None]
    duration, _ = _duration(b - a, _in_force(by[0], None, by[1]))
    return _UntimedLeg((ctrl,) * count, to, duration, None)


def _in_force(drone: Drone, plan: Waypoints | None, pace: Pace | None) -> Pace:
    """Return the speeds of a leg: its own, else the autopilot's defaults, else the drone's limits."""
    own = drone.limits
    usual = Speeds(own.speed, own.climb, own.descent)
    if plan is not None and plan.family == "mavlink":
        usual = DEFAULTS[plan.autopilot]
    if pace is None:
        return Pace(usual.ground, usual.climb, usual.descent)
    if isfinite(pace.along):
        return pace
    speeds = zip(pace[:3], (usual.ground, usual.climb, usual.descent), strict=True)
    ground, climb, descent = (a if isfinite(a) else b for a, b in speeds)
    return Pace(ground, climb, descent)


def _duration(step: Array, pace: Pace) -> tuple[float, float]:
    """Return the duration of a straight leg, seconds, and its speed along the path, m/s."""
    length = float(np.linalg.norm(step))
    if isfinite(pace.along):
        duration = length / pace.along
    else:
        duration = seconds(Speeds(*pace[:3]), hypot(step[0], step[1]), float(step[2]))
    duration = min(max(duration, BRIEFEST_S), LONGEST_S)
    return duration, length / duration


def _timed(parts: Sequence[_UntimedLeg]) -> tuple[list[Piecewise], tuple[UntimedLeg, ...]]:
    """Return the curves over the times of their parts, and the legs."""
    ends = np.cumsum([0.0, *(part.seconds for part in parts)])
    spans = list(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))
    legs = tuple(
        UntimedLeg(start, end, part.to[0], part.to[1], part.speed, part.phase, part.within)
        for (start, end), part in zip(spans, parts, strict=True)
    )
    curves = []
    for k in range(len(parts[0].ctrl)):
        breaks: list[NDArray[np.float64]] = [ends[:1]]
        for (start, end), part in zip(spans, parts, strict=True):
            inner = [CURVE_SHARE, 1.0 - CURVE_SHARE, 1.0] if len(part.ctrl[k]) == 3 else [1.0]
            breaks.append(start + (end - start) * np.array(inner))
            breaks[-1][-1] = end
        curves.append(Piecewise(np.concatenate(breaks), np.concatenate([part.ctrl[k] for part in parts])))
    return curves, legs
