"""Targets that pass over a pad while its drone has to be there; found by arithmetic, without a plan.

A drone may take off at the start of the mission and wait in the air, so a target that passes later finds the
pad empty. Two cases are faults: the target comes before any take-off could be over, or it comes to stand
there while the drone still films.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import cos, dist, hypot, inf, radians, sin
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.solids import closest_on_segment, distance
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.begins import first_start
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.passes.resolve.checks.home import BEARINGS_DEG, stands_free
from shotc.passes.resolve.lower.names import AUTO
from shotc.planning.clearances import move, outward
from shotc.rounding import at_least

ROUNDING_TOLERANCE = 1e-6  # metres or seconds
TRACK_HALVINGS = 40  # bisection steps for the first and last contact
TAKEOFF_SAMPLES = 50  # samples of a take-off
FAR_M = 1e3  # metres beyond a pad
BESIDE_M = 0.1  # metres kept beyond the reach of what passes, in a remedy
RINGS = (1.0, 1.5, 2.0, 3.0, 5.0, 8.0)  # factors of that reach, at which another pad is searched


class UniformMotion(NamedTuple):
    """Uniform motion of a target between two mission times, seconds; the last one of a track has no end."""

    begin: float
    end: float


class Touch(NamedTuple):
    """The time in which a target touches the body of a drone on its pad, seconds."""

    first: float
    last: float


def passers_of(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the targets that pass over a pad while the drone is there in any plan."""
    for drone in mission.drones:
        for target in mission.targets:
            if target.track is None:
                continue
            touches = list(_touches(drone, target, target.track))
            yield from _diagnostics(mission, drone, target, touches)


def _diagnostics(
    mission: MissionIR, drone: Drone, target: Target, touches: list[Touch]
) -> Iterator[Diagnostic]:
    ends = [(s.drone, first_start(mission, s) + (s.timing.duration or 0.0)) for s in mission.shots]
    filmed = [end for name, end in ends if name in (drone.name, AUTO)]
    if not filmed:
        last = max((end for _, end in ends), default=0.0)
        parked = [t for t in touches if t.first < last - ROUNDING_TOLERANCE]
        if parked:
            yield _fault(
                mission, drone, target, parked[0].first, f"`{drone.name}` films nothing and stands there"
            )
        return
    caught = next((t for touch in touches if (t := _caught(drone, target, touch)) is not None), None)
    if caught is not None:
        risen = f"by then the drone can be {at_least(_risen(drone, caught))} m above its pad at most"
        yield _fault(mission, drone, target, caught, risen)
    elif touches and touches[-1].last == inf and touches[-1].first < max(filmed) - ROUNDING_TOLERANCE:
        first = f"it stays there, and the drone films until {max(filmed):.1f} s at least"
        yield _fault(mission, drone, target, touches[-1].first, first)


def _fault(mission: MissionIR, drone: Drone, target: Target, when: float, why: str) -> Diagnostic:
    labels = (
        mission.origins.value((*drone.path, "home")),
        mission.origins.value((*target.path, "track"), "comes over the pad"),
    )
    notes = (
        f"its body touches the drone's on the pad at t = {when:.1f} s; {why}",
        *filter(None, (target.counts_from,)),
    )
    remedy = beside_tracks(mission, drone, target)
    help_ = f"{remedy}, or have `{target.name}` pass at another time"
    message = f"target `{target.name}` comes over the pad of `{drone.name}` while the drone is on it"
    return Diagnostic("M012", message, labels, notes, help_)


def beside_tracks(mission: MissionIR, drone: Drone, target: Target) -> str:
    """Return the move of a home to a near place over which no target passes, in words."""
    wide = mission.rules.beside_target(drone.radius)
    reach = target.radius + wide + BESIDE_M
    x, y, z = drone.home
    for rings in RINGS:
        for turn in BEARINGS_DEG:
            angle = radians(turn)
            place = (x + rings * reach * cos(angle), y + rings * reach * sin(angle), z)
            there = drone._replace(home=outward(drone.home, place))
            wider = there._replace(radius=wide)
            if stands_free(mission, there) and not any(_passes_over(wider, t) for t in mission.targets):
                return move(drone.home, there.home).replace("move it", "move `home`", 1)
    return f"move `home` {at_least(reach)} m or more aside from the track of `{target.name}`"


def _passes_over(drone: Drone, target: Target) -> bool:
    """Return whether a target ever passes over a pad."""
    return target.track is not None and any(_touches(drone, target, target.track))


def _caught(drone: Drone, target: Target, touch: Touch) -> float | None:
    """Return when a target touches a drone that takes off at once and as fast as it can; None if never."""
    if touch.first == 0.0:
        return 0.0
    last = min(touch.last, touch.first + 10.0)
    for i in range(TAKEOFF_SAMPLES + 1):
        t = touch.first + (last - touch.first) * i / TAKEOFF_SAMPLES
        x, y, z = drone.home
        if _gap(drone, target, (x, y, z + _risen(drone, t)), t) < -ROUNDING_TOLERANCE:
            return t
    return None


def _risen(drone: Drone, t: float) -> float:
    """Return the largest height that a drone can have gained by a mission time, metres; it need not stop."""
    limits = drone.limits
    return min(limits.climb * t, 0.5 * limits.acceleration * t**2, limits.jerk * t**3 / 6.0)


def _gap(drone: Drone, target: Target, place: Vec3, t: float) -> float:
    """Return the distance between a drone's body at a place and a target's, metres; negative if they
    touch.
    """
    return distance(target.kept_clear_at(t), place) - drone.radius


def _touches(drone: Drone, target: Target, track: Track) -> Iterator[Touch]:
    """Yield the times in which a target touches a drone on its pad, merged over the parts of its track."""
    open_: Touch | None = None
    for stretch in _stretches(drone, track):
        touch = _touch(drone, target, stretch)
        if touch is None:
            continue
        if open_ is not None and touch.first <= open_.last + ROUNDING_TOLERANCE:
            open_ = Touch(open_.first, touch.last)
            continue
        if open_ is not None:
            yield open_
        open_ = touch
    if open_ is not None:
        yield open_


def _stretches(drone: Drone, track: Track) -> Iterator[UniformMotion]:
    """Yield the uniform parts of a track from mission time 0 on, the last one until it is far from a pad."""
    if track.times[0] > 0.0:
        yield UniformMotion(0.0, track.times[0])
    for a, b in pairwise(track.times):
        if b > 0.0:
            yield UniformMotion(max(a, 0.0), b)
    begin = max(0.0, track.times[-1])
    speed = hypot(*track.after)
    if speed < ROUNDING_TOLERANCE:
        yield UniformMotion(begin, inf)
        return
    yield UniformMotion(begin, begin + (dist(track.at(begin), drone.home) + FAR_M) / speed)


def _touch(drone: Drone, target: Target, stretch: UniformMotion) -> Touch | None:
    """Return when a target touches a drone on its pad in one part; once, as the distance is convex."""
    begin, end = stretch
    if end == inf:
        return Touch(begin, inf) if _gap(drone, target, drone.home, begin) < -ROUNDING_TOLERANCE else None
    (ax, ay, _), (bx, by, _) = target.at(begin), target.at(end)
    x, y, _ = drone.home
    near = closest_on_segment((ax, ay), (bx, by), (x, y))
    if hypot(near[0] - x, near[1] - y) >= target.radius + drone.radius:
        return None
    length = hypot(bx - ax, by - ay)
    share = hypot(near[0] - ax, near[1] - ay) / length if length > ROUNDING_TOLERANCE else 0.0
    nearest = begin + share * (end - begin)
    if _gap(drone, target, drone.home, nearest) >= -ROUNDING_TOLERANCE:
        return None
    return Touch(_edge(drone, target, nearest, begin), _edge(drone, target, nearest, end))


def _edge(drone: Drone, target: Target, inside: float, outside: float) -> float:
    """Return the end, towards ``outside``, of the time in which a target touches a drone on its pad."""
    if _gap(drone, target, drone.home, outside) < -ROUNDING_TOLERANCE:
        return outside
    for _ in range(TRACK_HALVINGS):
        middle = 0.5 * (inside + outside)
        if _gap(drone, target, drone.home, middle) < -ROUNDING_TOLERANCE:
            inside = middle
        else:
            outside = middle
    return inside
