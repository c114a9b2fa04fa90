"""What is proved of a flight by waypoints: verification's claims of it, in every way that it may be flown.

Of all ways the worst value counts. Nothing is claimed that takes a clock.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from math import hypot, radians
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Label
from shotc.flightfiles.course import AT_HOME_M, UntimedFlight, UntimedLeg
from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import Pieces, join, pieces
from shotc.geom.proof import inf_distance
from shotc.geom.solids import point
from shotc.geom.ways_apart import nearest
from shotc.importers.notes import label
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.parked import parked
from shotc.ir.path import CHANNELS, HFOV
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, bounded, claim, gap, held
from shotc.passes.verify.pair import from_fleets
from shotc.passes.verify.space import space

NEAR_M = 0.05
"""Metres by which a clearance may be cut: files round places, and our own are written within that."""
FAST_M_S = 0.05
"""m/s by which a speed may be beyond its limit."""
TILTED_RAD = radians(0.1)
"""Radians by which an angle may be, which files round to tenths of a degree."""
TOLERANCES = {"m": NEAR_M, "m/s": FAST_M_S, "rad": TILTED_RAD}
BUILT = ("drift from the vertical", "depth below home")
"""Claims of what was rebuilt upright."""


class FileClaim(NamedTuple):
    """A claim, where in its file the worst value is met, and what is to be said of it."""

    claim: Claim
    where: Label | None
    notes: tuple[str, ...] = ()


def _found(course: UntimedFlight, claim: Claim, way: str = "") -> FileClaim:
    """Return a claim about a course; way : the one on which its worst value is met, if it matters."""
    if claim.time is None:
        return FileClaim(claim, None)
    leg = course.leg_at(claim.time)
    where = label(leg.file, leg.to.node)._replace(text=_on(leg))
    notes = (f"{claim.time:.1f} s from take-off at the file's speeds",)
    return FileClaim(claim, where, (*notes, f"on {way}, which its machine may fly") if way else notes)


def _on(leg: UntimedLeg) -> str:
    words = {"takeoff": "on the climb before", "land": "on the landing at"}.get(leg.phase, "on the way to")
    return f"{words} {leg.to.name}"


def judged(mission: MissionIR, courses: Sequence[UntimedFlight], keyframes: KeyframeIR) -> list[FileClaim]:
    """Return every claim that can be made of flights without a clock, drone by drone.

    mission : with its targets that stand, for where another one is at a time no file says
    """
    standing = mission._replace(targets=tuple(t for t in mission.targets if t.track is None))
    ir_of = keyframes._replace(mission=standing)
    found: list[FileClaim] = []
    for course in courses:
        claims = [*_limits(course), *_paces(course)]
        found += [_found(course, each) for each in claims]
        found += _space(standing, course, ir_of, courses)
    found += [each for pair in combinations(courses, 2) for each in _apart(standing, pair)]
    return [each._replace(claim=to_tolerance(each.claim, TOLERANCES)) for each in found]


def to_tolerance(found: Claim, tolerances: Mapping[str, float]) -> Claim:
    """Return a claim that holds where its value is beyond the limit by what a file leaves open, by units."""
    over = found.worst - found.limit if found.upper else found.limit - found.worst
    return replace(found, holds=found.holds or over <= tolerances.get(found.unit, 0.0))


def _flight(mission: MissionIR, course: UntimedFlight, curve: Piecewise) -> JudgedFlight:
    pose = np.zeros((*curve.ctrl.shape[:2], len(CHANNELS)))
    pose[..., :3], pose[..., HFOV] = curve.ctrl, course.drone.hfov
    track = DroneTrajectory(course.drone.name, Piecewise(curve.breaks, pose), course.phases, (), ())
    return JudgedFlight(mission, course.drone, track)


def _space(
    mission: MissionIR, course: UntimedFlight, keyframes: KeyframeIR, courses: Sequence[UntimedFlight]
) -> Iterator[FileClaim]:
    """Yield what is kept of the mission's world on the worst of all ways, and of drones on their pads."""
    worst: dict[str, FileClaim] = {}
    for way, curve in course.ways:
        flight = _flight(mission, course, curve)
        others = [_first_way(each) for each in courses if each is not course]
        ir = TrajectoryIR(keyframes, (flight.track, *others), (), ())
        claims = [*space(flight), *from_pads(flight, parked(ir)), *from_fleets(ir, [flight])]
        for each in claims:
            if each.constraint in BUILT:
                continue
            before = worst.get(each.constraint)
            if before is None or _less(each, before.claim):
                worst[each.constraint] = _found(course, each, way if len(course.ways) > 1 else "")
    yield from worst.values()


def from_pads(flight: JudgedFlight, standing: Iterable[DroneTrajectory]) -> Iterator[Claim]:
    """Claim the separation from drones that have no file, which stand at home."""
    least = flight.mission.rules.separation
    whole = pieces(flight.track.curve.channels(0, 1, 2))
    for track in standing:
        home = flight.mission.drone(track.drone).home
        limit = Limit(f"separation from {track.drone}", least, "m", ("rules", "separation"), upper=False)
        yield bounded(flight, limit, inf_distance(whole, point(home), gap(least)))


def _first_way(course: UntimedFlight) -> DroneTrajectory:
    """Return the first way of a course as a track, which tells that the drone flies."""
    _, curve = course.ways[0]
    return DroneTrajectory(course.drone.name, curve, course.phases, (), ())


def _less(one: Claim, other: Claim) -> bool:
    """Tell whether a claim leaves less room than another one of the same constraint."""
    return one.worst > other.worst if one.upper else one.worst < other.worst


def _limits(course: UntimedFlight) -> Iterator[Claim]:
    """Claim what the file says of angles, of where it lands, and how long it takes at least."""
    name, drone = course.drone.name, course.drone
    if course.landing is not None:
        limit = Limit("distance from home", AT_HOME_M, "m", (*drone.path, "home"))
        yield held(name, limit, WorstValue(course.landing, course.legs[-1].end, "exact"))
    last = course.legs[-1].end
    limit = Limit("endurance", drone.endurance, "s", (*drone.path, "endurance"))
    yield held(name, limit, WorstValue(last, last, "exact"))
    asked = [(radians(angle), leg.start) for leg in course.legs for angle in leg.to.pitches]
    for which, value, upper in (("min", drone.gimbal.pitch[0], False), ("max", drone.gimbal.pitch[1], True)):
        if asked:
            worst, time = max(asked) if upper else min(asked)
            limit = Limit(
                f"gimbal pitch {which}", value, "rad", (*drone.path, "gimbal", "pitch"), upper=upper
            )
            yield held(name, limit, WorstValue(worst, time, "exact"))


def _paces(course: UntimedFlight) -> Iterator[Claim]:
    """Claim the speeds that the file asks for, each as far as its leg is level, or rises.

    They are those of straight legs: how a machine shares them out over its curves nobody has published.
    """
    asked = []
    for leg in course.legs:
        if leg.speed is not None:
            start, end = course.ways[0][1](np.array([leg.start, leg.end]))
            east, north, up = ((end - start) / (leg.end - leg.start)).tolist()
            asked.append(((hypot(east, north), up, -up), leg.start))
    limits = course.drone.limits
    for k, (name, most) in enumerate(
        (("speed", limits.speed), ("climb", limits.climb), ("descent", limits.descent))
    ):
        if asked:
            worst, time = max((parts[k], time) for parts, time in asked)
            limit = Limit(name, most, "m/s", (*course.drone.path, "limits", name))
            yield held(course.drone.name, limit, WorstValue(max(worst, 0.0), time, "exact"))


def _apart(mission: MissionIR, pair: tuple[UntimedFlight, UntimedFlight]) -> Iterator[FileClaim]:
    one, other = pair
    bag = join([pieces(curve) for _, curve in other.ways])
    yield apart_at_any_time(mission, one, other.drone.name, bag)


def apart_at_any_time(mission: MissionIR, one: UntimedFlight, name: str, other: Pieces) -> FileClaim:
    """Claim the separation of a flight without a clock from another one, whenever each is where it is."""
    least = mission.rules.separation
    found = nearest(join([pieces(curve) for _, curve in one.ways]), other, gap(least))
    limit = Limit(f"separation from {name}", least, "m", ("rules", "separation"), upper=False)
    flight = _flight(mission, one, one.ways[0][1])
    kept = to_tolerance(claim(flight, limit, WorstValue(found.proven, found.one)), TOLERANCES)
    return _found(one, kept)
