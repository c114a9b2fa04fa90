"""When to set out on an unfilmed way, and over which height, so that nothing that moves is met on it.

A drone leaves as late as it can and still be in time, or, where nobody waits for it, at once. Where that
way meets a target or another drone, it sets out at another time, or goes over the top.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.convex import distances
from shotc.geom.pieces import Mask
from shotc.ir.mission import Drone, MissionIR
from shotc.ir.path import Leg
from shotc.passes.parameterize_time.estimate import leg_motion
from shotc.passes.timed_route.moving import Moving
from shotc.passes.timed_route.shot import Around
from shotc.passes.timed_route.sights import seen_on

STEP = 0.05  # seconds between the places that are compared
COMFORT = 0.5  # metres beyond a clearance: twice what two drones or a target come nearer within a step
EARLY = 1.0  # seconds by which a drone is in place where it has the time
DELAYS = (0.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0)  # seconds that it may wait
SHARES = (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)  # of the time it has to spare that it waits
LIFTS = (0.0, 4.0, 10.0, 20.0)  # metres over the higher end of the way

Ways = Callable[[float], list[Leg] | None]


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """Unfilmed legs, the first of which waits for its time.

    end : mission time at which the last one ends
    room : least distance on it beyond a clearance, metres; unseen : least distance out of a picture
    """

    legs: tuple[Leg, ...]
    end: float
    room: float = inf
    unseen: float = inf

    @property
    def clear(self) -> bool:
        """Whether nothing is met on it."""
        return self.room >= COMFORT


@dataclass(frozen=True, slots=True, eq=False)
class Then:
    """A leg that is flown after a way, from mission time ``ready`` on at the earliest."""

    leg: Leg
    ready: float


def choose(
    mission: MissionIR,
    drone: Drone,
    around: Around,
    ways: Ways,
    span: tuple[float, float | None],
    then: Then | None = None,
) -> Way | None:
    """Return the first way in time on which nothing is met, else the roomiest; None where there is none.

    ways : the legs that go over a height by so many metres more than they need, if there are any
    span : mission times from which the drone may leave, and by which it has to be there, if it has to
    then : what it flies next, which is not to meet anything either
    """
    tried: list[Way] = []
    for legs in (found for lift in LIFTS if (found := ways(lift)) is not None):
        for way in _tries(mission, drone, around, legs, span, then):
            in_time = span[1] is None or way.end <= span[1]
            if way.clear and way.unseen >= 0.0 and (in_time or not tried):
                return way
            tried.append(way)
        if not around.moving:
            break
    due = inf if span[1] is None else span[1]
    return max(tried, key=lambda way: (way.end <= due, min(way.room, COMFORT), way.unseen), default=None)


def _tries(
    mission: MissionIR,
    drone: Drone,
    around: Around,
    legs: list[Leg],
    span: tuple[float, float | None],
    then: Then | None,
) -> Iterator[Way]:
    begin, due = span
    curves = [motion.curve for leg in legs if (motion := leg_motion(mission, drone, leg)) is not None]
    lasts = sum(float(curve.end) for curve in curves)
    next_motion = None if then is None else leg_motion(mission, drone, then.leg)
    spare = 0.0 if due is None else max(0.0, due - EARLY - begin - lasts)
    delays = DELAYS if due is None else tuple(dict.fromkeys(share * spare for share in SHARES))
    for delay in delays:
        leaves = begin + delay
        started = [replace(leg, start=leaves) if i == 0 else leg for i, leg in enumerate(legs)]
        if not around.moving:
            yield Way(tuple(started), leaves + lasts)
            return
        until = max(leaves + lasts, due or 0.0, 0.0 if then is None else then.ready)
        film = [] if next_motion is None else [next_motion.curve.channels(0, 1, 2)]
        times = np.arange(begin, until + sum(float(c.end) for c in film) + STEP, STEP)
        places = _places(legs, [c.channels(0, 1, 2) for c in curves], times - leaves)
        for curve in film:
            inside = times >= until
            places[inside] = curve(np.minimum(times[inside] - until, float(curve.end)))
        upright = _upright(legs, [float(c.end) for c in curves], times - leaves)
        room = _room(around.moving, times, places, upright)
        unseen = seen_on(drone, around.sights, times, places)
        yield Way(tuple(started), leaves + lasts, room, unseen)


def _places(legs: list[Leg], curves: Sequence[Piecewise], clock: Array) -> Array:
    """Return where the drone is at times since it left, standing before and after."""
    places = np.tile(np.array(legs[0].pose[:3]), (len(clock), 1))
    begin = 0.0
    for curve in curves:
        end = begin + float(curve.end)
        inside = clock >= begin
        places[inside] = curve(np.minimum(clock[inside] - begin, float(curve.end)))
        begin = end
    return places


def _upright(legs: list[Leg], lasts: list[float], clock: Array) -> Mask:
    """Tell at which times the drone rises from its pad or sinks to it, where targets need no clearance."""
    found = np.zeros(len(clock), dtype=bool)
    begin = 0.0
    for leg, last in zip(legs, lasts, strict=False):
        if leg.phase == "takeoff":
            found |= clock <= begin + last
        if leg.phase == "land":
            found |= clock >= begin
        begin += last
    return found


def _room(moving: Sequence[Moving], times: Array, places: Array, upright: Mask) -> float:
    """Return the least distance from what moves beyond the clearance from it, metres."""
    least = inf
    for what in moving:
        counts = np.ones(len(times), dtype=bool) if what.always else ~upright
        away = distances(what.part, places[counts] - what.at(times[counts]))
        least = min(least, float(away.min(initial=inf)) - what.clearance)
    return least
