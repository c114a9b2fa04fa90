"""Claims on waypoint flights: those of verification, on all curves that may be flown.

The worst value of all curves counts. There are no claims that need a clock.
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
"""Metres of tolerance on a clearance, because files round positions; shotc's own files keep within it."""
FAST_M_S = 0.05
"""m/s of tolerance on a speed."""
TILTED_RAD = radians(0.1)
"""Radians of tolerance on an angle; files round to tenths of a degree."""
TOLERANCES = {"m": NEAR_M, "m/s": FAST_M_S, "rad": TILTED_RAD}
BUILT = ("drift from the vertical", "depth below home")
"""Claims on the vertical parts, which were built here."""


class FileClaim(NamedTuple):
    """A claim, the place of its worst value in the file, and notes."""

    claim: Claim
    where: Label | None
    notes: tuple[str, ...] = ()


def _file_claim(course: UntimedFlight, claim: Claim, curve_name: str = "") -> FileClaim:
    """Return a claim about a course.

    curve_name : description of the curve with the worst value, if it matters
    """
    if claim.time is None:
        return FileClaim(claim, None)
    leg = course.leg_at(claim.time)
    where = label(leg.file, leg.to.node)._replace(text=_on(leg))
    notes = (f"{claim.time:.1f} s from take-off at the file's speeds",)
    return FileClaim(
        claim, where, (*notes, f"on {curve_name}, which its machine may fly") if curve_name else notes
    )


def _on(leg: UntimedLeg) -> str:
    words = {"takeoff": "on the climb before", "land": "on the landing at"}.get(leg.phase, "on the way to")
    return f"{words} {leg.to.name}"


def judged(mission: MissionIR, courses: Sequence[UntimedFlight], keyframes: KeyframeIR) -> list[FileClaim]:
    """Return all possible claims on flights without a clock, drone by drone.

    mission : only its standing targets are used, because no file states when a drone is near a moving one
    """
    standing = mission._replace(targets=tuple(t for t in mission.targets if t.track is None))
    ir_of = keyframes._replace(mission=standing)
    stated: list[FileClaim] = []
    for course in courses:
        claims = [*_limits(course), *_paces(course)]
        stated += [_file_claim(course, each) for each in claims]
        stated += _space(standing, course, ir_of, courses)
    stated += [each for pair in combinations(courses, 2) for each in _apart(standing, pair)]
    return [each._replace(claim=to_tolerance(each.claim, TOLERANCES)) for each in stated]


def to_tolerance(stated: Claim, tolerances: Mapping[str, float]) -> Claim:
    """Return a claim that also holds if its value exceeds the limit by at most the tolerance.

    tolerances : by unit
    """
    over = stated.worst - stated.limit if stated.upper else stated.limit - stated.worst
    return replace(stated, holds=stated.holds or over <= tolerances.get(stated.unit, 0.0))


def _flight(mission: MissionIR, course: UntimedFlight, curve: Piecewise) -> JudgedFlight:
    pose = np.zeros((*curve.ctrl.shape[:2], len(CHANNELS)))
    pose[..., :3], pose[..., HFOV] = curve.ctrl, course.drone.hfov
    track = DroneTrajectory(course.drone.name, Piecewise(curve.breaks, pose), course.phases, (), ())
    return JudgedFlight(mission, course.drone, track)


def _space(
    mission: MissionIR, course: UntimedFlight, keyframes: KeyframeIR, courses: Sequence[UntimedFlight]
) -> Iterator[FileClaim]:
    """Yield the claims on the mission's world on the worst of all curves, and on drones on their pads."""
    worst: dict[str, FileClaim] = {}
    for name, curve in course.ways:
        flight = _flight(mission, course, curve)
        others = [_first_way(each) for each in courses if each is not course]
        ir = TrajectoryIR(keyframes, (flight.track, *others), (), ())
        claims = [*space(flight), *from_pads(flight, parked(ir)), *from_fleets(ir, [flight])]
        for each in claims:
            if each.constraint in BUILT:
                continue
            before = worst.get(each.constraint)
            if before is None or _less(each, before.claim):
                worst[each.constraint] = _file_claim(course, each, name if len(course.ways) > 1 else "")
    yield from worst.values()


def from_pads(flight: JudgedFlight, standing: Iterable[DroneTrajectory]) -> Iterator[Claim]:
    """Yield the claims on the separation from drones without a file, which stand at home."""
    least = flight.mission.rules.separation
    whole = pieces(flight.track.curve.channels(0, 1, 2))
    for track in standing:
        home = flight.mission.drone(track.drone).home
        limit = Limit(f"separation from {track.drone}", least, "m", ("rules", "separation"), upper=False)
        yield bounded(flight, limit, inf_distance(whole, point(home), gap(least)))


def _first_way(course: UntimedFlight) -> DroneTrajectory:
    """Return the first curve of a course as a track, which shows that the drone flies."""
    _, curve = course.ways[0]
    return DroneTrajectory(course.drone.name, curve, course.phases, (), ())


def _less(one: Claim, other: Claim) -> bool:
    """Return whether a claim is worse than another one of the same constraint."""
    return one.worst > other.worst if one.upper else one.worst < other.worst


def _limits(course: UntimedFlight) -> Iterator[Claim]:
    """Yield the claims on the file's angles, on its landing place, and on its least duration."""
    name, drone = course.drone.name, course.drone
    if course.landing is not None:
        limit = Limit("distance from home", AT_HOME_M, "m", (*drone.path, "home"))
        yield held(name, limit, WorstValue(course.landing, course.legs[-1].end, "exact"))
    last = course.legs[-1].end
    limit = Limit("endurance", drone.endurance, "s", (*drone.path, "endurance"))
    yield held(name, limit, WorstValue(last, last, "exact"))
    pitches = [(radians(angle), leg.start) for leg in course.legs for angle in leg.to.pitches]
    for which, value, upper in (("min", drone.gimbal.pitch[0], False), ("max", drone.gimbal.pitch[1], True)):
        if pitches:
            worst, time = max(pitches) if upper else min(pitches)
            limit = Limit(
                f"gimbal pitch {which}", value, "rad", (*drone.path, "gimbal", "pitch"), upper=upper
            )
            yield held(name, limit, WorstValue(worst, time, "exact"))


def _paces(course: UntimedFlight) -> Iterator[Claim]:
    """Yield the claims on the file's speeds, divided into horizontal and vertical speed on each leg.

    The speeds are those on straight legs, because the speeds on a machine's curves are not published.
    """
    paces = []
    for leg in course.legs:
        if leg.speed is not None:
            start, end = course.ways[0][1](np.array([leg.start, leg.end]))
            east, north, up = ((end - start) / (leg.end - leg.start)).tolist()
            paces.append(((hypot(east, north), up, -up), leg.start))
    limits = course.drone.limits
    for k, (name, most) in enumerate(
        (("speed", limits.speed), ("climb", limits.climb), ("descent", limits.descent))
    ):
        if paces:
            worst, time = max((parts[k], time) for parts, time in paces)
            limit = Limit(name, most, "m/s", (*course.drone.path, "limits", name))
            yield held(course.drone.name, limit, WorstValue(max(worst, 0.0), time, "exact"))


def _apart(mission: MissionIR, pair: tuple[UntimedFlight, UntimedFlight]) -> Iterator[FileClaim]:
    one, other = pair
    bag = join([pieces(curve) for _, curve in other.ways])
    yield apart_at_any_time(mission, one, other.drone.name, bag)


def apart_at_any_time(mission: MissionIR, one: UntimedFlight, name: str, other: Pieces) -> FileClaim:
    """Return the claim on the separation of a flight without a clock from another one, at any
    pair of times.
    """
    least = mission.rules.separation
    meeting = nearest(join([pieces(curve) for _, curve in one.ways]), other, gap(least))
    limit = Limit(f"separation from {name}", least, "m", ("rules", "separation"), upper=False)
    flight = _flight(mission, one, one.ways[0][1])
    separation = to_tolerance(claim(flight, limit, WorstValue(meeting.proven, meeting.one)), TOLERANCES)
    return _file_claim(one, separation)
