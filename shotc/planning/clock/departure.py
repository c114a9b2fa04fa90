"""When to set out on an unfilmed way, and over which height, so that nothing that moves is met on it.

A drone leaves as late as it can and still be in time, or, where nobody waits for it, at once. Where that
way meets a target or another drone, it sets out at another time, or goes round or over the top. On its pad,
on the way up from it and down to it the drone's body alone counts, as in the proof: a target that comes over
the pad finds the drone gone before it, or not there yet. A way that comes too near to a target would be
refused by the proof: it is chosen only where there is no other, not even a late one. So is one that breaks a
clearance of ways between shots that the mission writes down; where it is silent the clearances are kept by
ways that are in time, and nothing waits long for them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import distances
from shotc.geom.taper import SLOPE, Taper
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner
from shotc.ir.path import MovingLeg, PathLeg
from shotc.ir.phases import PhaseName
from shotc.ir.preference import LONGEST_WAIT
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.shot import OtherVehicles
from shotc.planning.clock.visibility import seen_on
from shotc.planning.timing.estimate import leg_motion

STEP_S = 0.05  # seconds between the places that are compared
COMFORT_M = 0.5  # metres beyond a clearance: twice what two drones or a target come nearer within a step
EARLY_S = 1.0  # seconds by which a drone is in place where it has the time
HASTE_SHARE = 0.9  # of those that are given up where something passes its place until then
DELAYS_S = (0.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0)  # seconds that it may wait
WAIT_SHARES = (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)  # of the time it has to spare that it waits
CLOSER, ZOOMS = 20, 2  # parts into which a step is cut where it is nearest to a target, and how often
LEAVES_S = 3.0  # seconds after a shot, in which a drone has to get away from where it ends
PROVED_M = 1e-6  # metres
WAITED_M = 1e3  # metres that a clearance counts as broken by, where what follows would wait too long for it

Course = Callable[[Array], Array]
"""Places (M, 3) at mission times (M,)."""


@dataclass(frozen=True, slots=True)
class Meeting:
    """A target that a way comes too near to: when, and by how many metres.

    phase : "takeoff" or "land" where that is at the pad, "transit" elsewhere
    """

    owner: Owner
    time: float
    lack: float
    phase: PhaseName = "transit"


@dataclass(frozen=True, slots=True, eq=False)
class Transfer:
    """Unfilmed legs, the first of which waits for its time.

    end : mission time at which the last one ends
    slack : least distance on it beyond a clearance, metres; unseen : least distance out of a picture
    met : the target that it comes too near to, if there is one
    kept : least distance on it beyond the clearances of ways between shots, metres; required : the same of
        those that the mission writes down
    """

    legs: tuple[MovingLeg, ...]
    end: float
    slack: float = inf
    unseen: float = inf
    met: Meeting | None = None
    kept: float = inf
    required: float = inf

    @property
    def clear(self) -> bool:
        """Whether nothing is met on it."""
        return self.slack >= COMFORT_M and self.required >= -PROVED_M


@dataclass(frozen=True, slots=True, eq=False)
class NextLeg:
    """A leg that is flown after a way, from mission time ``ready`` on at the earliest."""

    leg: PathLeg
    ready: float


@dataclass(frozen=True, slots=True)
class When:
    """When a way is flown, mission times in seconds.

    ready : from when on the drone may leave; due : by when it has to be there, if it has to
    stays : until when it stands where the way ends, at least
    """

    ready: float
    due: float | None = None
    stays: float = 0.0


def choose(
    mission: MissionIR,
    drone: Drone,
    others: OtherVehicles,
    ways: Iterable[list[MovingLeg]],
    when: When,
    then: NextLeg | None = None,
) -> Transfer | None:
    """Return the first way in time on which nothing is met, else the best; None where there is none.

    The best meets no target, then no drone, is the least late, keeps the clearances of ways between shots,
    and has the most slack, in this order: what is met is refused by the proof, and a shot that is late can be
    put off, or is told when it could begin.

    ways : legs that lead there, those to be preferred first
    then : what it flies next, which is not to meet anything either
    """
    tried: list[Transfer] = []

    def waits(way: Transfer) -> float:
        """Return for how many seconds what follows waits for a way, beside the first."""
        ready = 0.0 if then is None else then.ready
        return 0.0 if when.due is not None else max(way.end, ready) - max(tried[0].end, ready)

    for legs in ways:
        for way in _tries(mission, drone, others, legs, when, then):
            in_time = when.due is None or way.end <= when.due
            tried.append(way)
            fine = _unseen(others, way, waits(way)) >= 0.0 and _kept(way, waits(way)) >= -PROVED_M
            if way.clear and fine and (in_time or len(tried) == 1):
                return way
        if not others.moving:
            break
    due = inf if when.due is None else when.due

    def worth(way: Transfer) -> tuple[bool, bool, float, float, float, float, float]:
        late = max(0.0, way.end - due)
        kept = min(_kept(way, waits(way)), 0.0)
        unseen = _unseen(others, way, waits(way))
        required = min(way.required, 0.0)
        return way.met is None, way.slack >= 0.0, required, -late, kept, min(way.slack, COMFORT_M), unseen

    return max(tried, key=worth, default=None)


def _kept(way: Transfer, waits: float) -> float:
    """Return how far a way keeps the clearances of ways between shots, metres.

    It is worth little where what follows would wait longer for it than a preference may cost.
    """
    return way.kept if waits <= LONGEST_WAIT else min(way.kept, 0.0) - WAITED_M


def _unseen(others: OtherVehicles, way: Transfer, waits: float) -> float:
    """Return how far a way is out of pictures, metres, where that counts; waits : as in ``_kept``.

    A preference that is not met counts for nothing, nor one that is for which what follows waits too long.
    """
    if not others.visibility.preferred:
        return way.unseen
    return 0.0 if way.unseen >= 0.0 and waits <= LONGEST_WAIT else -inf


def _tries(
    mission: MissionIR,
    drone: Drone,
    others: OtherVehicles,
    legs: list[MovingLeg],
    when: When,
    then: NextLeg | None,
) -> Iterator[Transfer]:
    begin, due = when.ready, when.due
    curves = [motion.curve for leg in legs if (motion := leg_motion(drone, leg)) is not None]
    lasts = sum(float(curve.end) for curve in curves)
    next_motion = None if then is None else leg_motion(drone, then.leg)
    film = None if next_motion is None else next_motion.curve.channels(0, 1, 2)
    spare = 0.0 if due is None else max(0.0, due - EARLY_S - begin - lasts)
    shares = (
        *(share * spare for share in WAIT_SHARES),
        *((spare + HASTE_SHARE * EARLY_S,) if spare > 0.0 else ()),
    )
    delays = DELAYS_S if due is None else tuple(dict.fromkeys(shares))
    for delay in delays:
        leaves = begin + delay
        started = [replace(leg, start=leaves) if i == 0 else leg for i, leg in enumerate(legs)]
        if not others.moving:
            yield Transfer(tuple(started), leaves + lasts)
            return
        until = max(leaves + lasts, when.stays, due or 0.0, 0.0 if then is None else then.ready)
        course = _Course(legs, [c.channels(0, 1, 2) for c in curves], leaves, film, until)
        times = np.arange(
            begin, until + (0.0 if film is None else float(film.end) + LEAVES_S) + STEP_S, STEP_S
        )
        places, upright = course.at(times), course.upright(times)
        slack = min(_slack(what, drone.radius, times, places, upright) for what in others.moving)
        unseen = seen_on(drone, others.visibility, times, places)
        until_then = times <= until
        met = _met(others.moving, drone.radius, course, times[until_then])
        between = until_then & ~upright
        apart = [(what, _apart(what, times[between], places[between])) for what in others.moving]
        kept = min((lack for _, lack in apart), default=inf)
        required = min((lack for what, lack in apart if what.required), default=inf)
        yield Transfer(tuple(started), leaves + lasts, slack, unseen, met, kept, required)


@dataclass(frozen=True, slots=True, eq=False)
class _Course:
    """Where a drone is on a way, before and after it.

    curves : places over the time of each leg that takes any; leaves : mission time
    film : places of the shot that it flies from mission time ``until`` on, if there is one on a path
    """

    legs: list[MovingLeg]
    curves: Sequence[Piecewise]
    leaves: float
    film: Piecewise | None
    until: float

    def at(self, times: Array) -> Array:
        """Return places (M, 3) at mission times (M,); it stands before and after."""
        places = np.tile(np.array(self.legs[0].pose[:3]), (len(times), 1))
        begin = self.leaves
        for curve in self.curves:
            _from(places, times, begin, curve)
            begin += float(curve.end)
        if self.film is not None:
            _from(places, times, self.until, self.film)
        return places

    def upright(self, times: Array) -> Mask:
        """Tell at which times it is on its pad, rises from it or sinks to it: its body alone counts."""
        takes_off, lands = self._lifts()
        return np.asarray((times <= takes_off) | (times >= lands))

    def phase(self, t: float) -> PhaseName:
        """Return what it does at a mission time; all but take-off and landing is a transit."""
        takes_off, lands = self._lifts()
        return "takeoff" if t <= takes_off else "land" if t >= lands else "transit"

    def _lifts(self) -> tuple[float, float]:
        """Return the mission times at which take-off ends and landing begins; infinite without one."""
        takes_off, lands, begin = -inf, inf, self.leaves
        for leg, curve in zip(self.legs, self.curves, strict=False):
            end = begin + float(curve.end)
            takes_off = end if leg.phase == "takeoff" else takes_off
            lands = begin if leg.phase == "land" else lands
            begin = end
        return takes_off, lands


def _from(places: Array, times: Array, begin: float, curve: Piecewise) -> None:
    """Put the places of a curve in from a time on."""
    inside = times >= begin
    places[inside] = curve(np.minimum(times[inside] - begin, float(curve.end)))


def _slack(what: Moving, radius: float, times: Array, places: Array, upright: Mask) -> float:
    """Return the least distance from something that moves beyond the clearance from it, metres.

    radius : of the body, which is all that counts at the pad
    """
    needs = _needs(what, radius, upright)
    return float((distances(what.part, places - what.at(times)) - needs).min(initial=inf))


def _apart(what: Moving, times: Array, places: Array) -> float:
    """Return the least distance from something that moves beyond what is needed between shots, metres."""
    if what.apart <= what.clearance or not len(times):
        return inf
    beside = places - what.at(times)
    ends = beside[[0, -1]]
    taper = Taper(what.apart, SLOPE, ends, distances(what.part, ends))
    return float((distances(what.part, beside) - taper.needs(beside)).min())


def _needs(what: Moving, radius: float, upright: Mask) -> Array:
    """Return the metres that are kept from something that moves, shape (M,)."""
    return np.where(upright & (not what.always), radius, what.clearance)


def _met(moving: Sequence[Moving], radius: float, course: _Course, times: Array) -> Meeting | None:
    """Return the target that a course comes nearest to, if that is too near."""
    nearest = [_nearest(what, radius, course, times) for what in moving if not what.always]
    worst = max(nearest, key=lambda met: met.lack, default=None)
    return worst if worst is not None and worst.lack > PROVED_M else None


def _nearest(what: Moving, radius: float, course: _Course, times: Array) -> Meeting:
    """Return where a course is nearest to a target, looked at ever more closely: it is to stand the proof."""
    step, most, when = STEP_S, -inf, float(times[0])
    for _ in range(1 + ZOOMS):
        lack = _needs(what, radius, course.upright(times)) - distances(
            what.part, course.at(times) - what.at(times)
        )
        most, when = float(lack.max()), float(times[int(lack.argmax())])
        inside = np.linspace(max(when - step, times[0]), min(when + step, times[-1]), 2 * CLOSER + 1)
        step, times = step / CLOSER, inside
    return Meeting(what.owner, when, most, course.phase(when))
